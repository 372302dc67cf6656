//! Derivatives with respect to time: those that the importer gives for inputs, and those of outputs.

use std::mem::MaybeUninit;

use super::Instance;
use crate::{
    input_course::ORDER_MAX,
    interface::{InterfaceType, Name, Role, Roles, Values, memory, reference::PRELOAD},
    mode::Mode,
    refusal::Refusal,
};

/// Highest order of an output's derivative, `maxOutputDerivativeOrder` of the model descriptions.
const OUTPUT_ORDER_MAX: usize = 1;

impl Instance {
    /// Gives derivatives of inputs for the communication step that comes next, all or none; the three slices have the
    /// same length. Orders are 1 to 3.
    pub(crate) fn set_input_derivatives(
        &mut self,
        references: &[u32],
        orders: &[i32],
        values: &[f64],
    ) -> Result<(), Refusal> {
        self.require_type(InterfaceType::CoSimulation)?;
        self.require(&[
            Mode::Instantiated,
            Mode::SetUp,
            Mode::Initialization,
            Mode::Step,
        ])?;
        let mut inputs = self.inputs.clone();
        for ((&reference, &order), &value) in references.iter().zip(orders).zip(values) {
            let (index, roles) = self.known(reference)?;
            let name = self.name(index);
            if !roles.intersects(Roles::of(&[Role::Input])) {
                let role = self.role(index);
                return Err(Refusal::NoInputDerivative { name, role });
            }
            let order = checked_order(name, order, ORDER_MAX)?;
            if !value.is_finite() {
                let name = self.name(index);
                return Err(Refusal::ValueNotFinite { name, value });
            }
            inputs.give(index, order, value);
        }
        self.inputs = inputs;
        // the power of the changing preload follows from its rate
        self.outputs_stale = true;
        Ok(())
    }

    /// Reads derivatives of outputs at the present time; the three slices have the same length. The order is 1.
    pub(crate) fn output_derivatives(
        &self,
        references: &[u32],
        orders: &[i32],
        values: &mut [MaybeUninit<f64>],
    ) -> Result<(), Refusal> {
        self.require_type(InterfaceType::CoSimulation)?;
        self.require(&[Mode::Step, Mode::IntermediateUpdate, Mode::Terminated])?;
        if self.mode == Mode::IntermediateUpdate {
            self.check_readable(references)?;
        }
        for (&reference, &order) in references.iter().zip(orders) {
            let (index, roles) = self.known(reference)?;
            let name = self.name(index);
            if !roles.intersects(Roles::of(&[Role::State, Role::InnerState, Role::Output])) {
                let role = self.role(index);
                return Err(Refusal::NoOutputDerivative { name, role });
            }
            checked_order(name, order, OUTPUT_ORDER_MAX)?;
        }
        let rates = self.rates();
        for (&reference, value) in references.iter().zip(values) {
            let (index, _) = self.known(reference)?;
            let rate = rates[index];
            if !rate.is_finite() {
                return Err(self.overflow(index));
            }
            value.write(rate);
        }
        Ok(())
    }

    /// Derivatives of inputs, states and outputs with respect to time.
    fn rates(&self) -> Values {
        let mut values = self.values.clone();
        self.model.settle(&mut values);
        values[memory::PRELOAD_RATE] = self.preload_rate();
        if self.outputs_stale || self.energies_stale {
            self.model.calculate_outputs(&mut values);
        }
        // ẏ = ∂y/∂x ẋ + ∂y/∂u u̇
        let mut rates = values.change();
        self.model.rates(&values, &self.inputs, &mut rates);
        rates[PRELOAD] = self.preload_rate();
        rates[memory::PRELOAD_RATE] = self.inputs.acceleration(PRELOAD);
        self.model.differentiate_outputs(&values, &mut rates);
        rates
    }

    /// Inputs that are set after a step no longer do what they did in it.
    #[cold]
    pub(super) fn forget_inputs(&mut self, references: &[u32]) {
        for &reference in references {
            self.inputs.forget(reference as usize);
        }
    }
}

/// The order as an index, if it is offered.
fn checked_order(name: Name, found: i32, highest: usize) -> Result<usize, Refusal> {
    usize::try_from(found)
        .ok()
        .filter(|order| (1..=highest).contains(order))
        .ok_or(Refusal::DerivativeOrder {
            name,
            found,
            highest,
        })
}
