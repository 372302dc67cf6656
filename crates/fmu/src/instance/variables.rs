//! Reading and setting variables.

use std::mem::MaybeUninit;

use super::Instance;
use crate::{
    interface::{InterfaceType, Name, Role, Roles, memory, reference::PRELOAD},
    mode::Mode,
    refusal::Refusal,
    version::Abi,
};

/// Roles whose values are calculated only when somebody asks.
pub(super) const CALCULATED: Roles = Roles::of(&[
    Role::Output,
    Role::Derivative,
    Role::InnerState,
    Role::Indicator,
]);

/// Roles whose values follow from the parameters, and are calculated whenever somebody asks.
pub(super) const CALCULATED_PARAMETERS: Roles = Roles::of(&[Role::CalculatedParameter]);

/// The same, and states that may not have been told.
const CARRIED_OR_CALCULATED: Roles = CALCULATED.with(Roles::CARRIED);

/// Roles whose values are always there, but for states that are carried.
const AT_HAND: Roles = Roles::of(&[Role::Independent, Role::Parameter, Role::Input, Role::State]);

/// What may be set in every Step Mode, to every number.
const INPUTS: Roles = Roles::of(&[Role::Input]);

/// Parameters, after a change of which the model has to be prepared again.
const PARAMETERS: Roles = Roles::of(&[Role::Parameter]);

/// Modes in which an importer of FMI 2.0 can read variables.
const READABLE: &[Mode] = &[
    Mode::Initialization,
    Mode::Step,
    Mode::Event,
    Mode::ContinuousTime,
    Mode::Terminated,
];

impl Instance {
    /// Reads the variables with these value references; `values` has the same length.
    pub(crate) fn get(
        &mut self,
        references: &[u32],
        values: &mut [MaybeUninit<f64>],
    ) -> Result<(), Refusal> {
        if self.mode == Mode::IntermediateUpdate {
            self.check_readable(references)?;
        }
        for (&reference, value) in references.iter().zip(values) {
            let (index, roles) = self.known(reference)?;
            if roles.intersects(CARRIED_OR_CALCULATED) {
                if roles.intersects(Roles::CARRIED) {
                    self.model.settle(&mut self.values);
                } else {
                    self.calculate(roles);
                }
                if !self.values[index].is_finite() {
                    return Err(self.overflow(index));
                }
            }
            if roles.intersects(CALCULATED_PARAMETERS) {
                self.model.calculate_parameters(&mut self.values);
            }
            value.write(self.values[index]);
        }
        Ok(())
    }

    /// Refuses to read variables before initialisation, as FMI 2.0 has it.
    pub(crate) fn require_readable(&self) -> Result<(), Refusal> {
        match self.identity.abi {
            Abi::Fmi2 => self.require(READABLE),
            Abi::Fmi3 => Ok(()),
        }
    }

    /// Reads variables between communication steps, if none has to be calculated; tells whether all were such.
    #[inline]
    pub(crate) fn get_between_steps(
        &self,
        references: &[u32],
        values: &mut [MaybeUninit<f64>],
    ) -> bool {
        if self.mode != Mode::Step {
            return false;
        }
        for (&reference, value) in references.iter().zip(values) {
            let index = reference as usize;
            match self.roles.get(index) {
                Some(roles) if roles.intersects(AT_HAND) && !roles.intersects(Roles::CARRIED) => {
                    value.write(self.values[index])
                }
                _ => return false,
            };
        }
        true
    }

    /// Sets the variables with these value references, all or none; `values` has the same length.
    pub(crate) fn set(&mut self, references: &[u32], values: &[f64]) -> Result<(), Refusal> {
        let settable = self.mode.settable(self.identity.abi, self.event_mode_used);
        let settable = match self.interface_type() {
            InterfaceType::ModelExchange => settable,
            InterfaceType::CoSimulation => settable.without(Roles::of(&[Role::InnerState])),
        };
        for (&reference, &value) in references.iter().zip(values) {
            let (index, roles) = self.known(reference)?;
            if !roles.intersects(settable) {
                return Err(self.not_settable(index));
            }
            if !value.is_finite() {
                return Err(Refusal::ValueNotFinite {
                    name: self.name(index),
                    value,
                });
            }
            if roles.intersects(Roles::LIMITED) {
                self.model.check_input(index, value)?;
            }
        }
        if self.mode == Mode::IntermediateUpdate {
            self.check_settable(references)?;
        }
        for (&reference, &value) in references.iter().zip(values) {
            let (index, roles) = self.known(reference)?;
            if roles.intersects(Roles::CARRIED) {
                // those that are not set stay what they are
                self.model.settle(&mut self.values);
                if self.values[index].to_bits() != value.to_bits() {
                    self.values.underway_mut().end();
                }
            }
            // importers that set every parameter before every step pay only for those that change
            self.parameters_changed |=
                roles.intersects(PARAMETERS) && self.values[index].to_bits() != value.to_bits();
            self.values[index] = value;
        }
        if self.inputs.is_past() {
            self.forget_inputs(references);
        }
        self.outputs_stale = true;
        Ok(())
    }

    /// Sets variables between communication steps, if they are inputs that are held and nothing is wrong; tells whether it
    /// was so, otherwise nothing is set.
    #[inline]
    pub(crate) fn set_between_steps(&mut self, references: &[u32], values: &[f64]) -> bool {
        if self.mode != Mode::Step || self.inputs.is_past() {
            return false;
        }
        for (&reference, value) in references.iter().zip(values) {
            let roles = self.roles.get(reference as usize);
            // an input that is limited has more than this role
            let is_free_input = roles.is_some_and(|roles| roles.is(INPUTS));
            if !(is_free_input && value.is_finite()) {
                return false;
            }
        }
        for (&reference, &value) in references.iter().zip(values) {
            if let Some(input) = self.values.get_mut(reference as usize) {
                *input = value;
            }
        }
        self.outputs_stale = true;
        true
    }

    /// Refuses access to variables under another type than their own.
    pub(crate) fn refuse_type(
        &self,
        references: &[u32],
        asked: &'static str,
    ) -> Result<(), Refusal> {
        match references.first() {
            None => Ok(()),
            Some(&reference) => {
                let (index, _) = self.known(reference)?;
                Err(Refusal::NotOfType {
                    name: self.name(index),
                    own: self.words().real,
                    asked,
                })
            }
        }
    }

    /// Index and role of a value reference that this FMU has.
    #[inline]
    pub(super) fn known(&self, reference: u32) -> Result<(usize, Roles), Refusal> {
        let index = reference as usize;
        match self.roles.get(index) {
            Some(&roles) if roles != Roles::NONE => Ok((index, roles)),
            _ => Err(Refusal::UnknownReference { reference }),
        }
    }

    /// Brings outputs and derivatives up to date.
    #[inline]
    pub(super) fn calculate_outputs(&mut self) {
        if self.outputs_stale | self.energies_stale {
            if self.begins() {
                self.model.begin(&mut self.values);
            }
            self.model.settle(&mut self.values);
            self.values[memory::PRELOAD_RATE] = self.preload_rate();
            self.model.calculate_outputs(&mut self.values);
            // it follows from the inputs' course, and is nothing to remember
            self.values[memory::PRELOAD_RATE] = 0.0;
            self.outputs_stale = false;
            self.energies_stale = false;
        }
    }

    /// Brings up to date an output of these roles, and what comes with it.
    #[inline]
    fn calculate(&mut self, roles: Roles) {
        if !self.has_some_apart || roles.intersects(Roles::APART) {
            self.calculate_outputs();
        } else if self.outputs_stale {
            self.calculate_loads();
        }
    }

    /// Brings outputs up to date but for energies and powers, where these are not easily had.
    fn calculate_loads(&mut self) {
        if self.begins() {
            self.calculate_outputs();
            return;
        }
        let is_prepared = !self.parameters_changed;
        self.values[memory::PRELOAD_RATE] = self.preload_rate();
        self.energies_stale = !self.model.calculate_loads(&mut self.values, is_prepared);
        self.values[memory::PRELOAD_RATE] = 0.0;
        self.outputs_stale = false;
    }

    /// Whether the simulation has not begun, so that all follows from parameters and start values.
    pub(super) fn begins(&self) -> bool {
        matches!(self.mode, Mode::Instantiated | Mode::Initialization)
    }

    /// Rate of the preload (N·m/s), as far as the importer has told it; zero where the preload is held.
    #[inline]
    pub(super) fn preload_rate(&self) -> f64 {
        if self.inputs.is_none() {
            return 0.0;
        }
        self.inputs.rate(PRELOAD).unwrap_or(0.0)
    }

    /// A calculated variable that is not finite.
    #[cold]
    pub(super) fn overflow(&self, index: usize) -> Refusal {
        let variable = self.identity.variables.get(index);
        Refusal::OutputNotFinite {
            name: self.name(index),
            unit: variable.map_or(Name::Borrowed(""), |variable| variable.unit.clone()),
            time_s: self.time_s(),
        }
    }

    #[cold]
    fn not_settable(&self, index: usize) -> Refusal {
        Refusal::NotSettable {
            name: self.name(index),
            role: self.role(index),
            mode: self.mode,
        }
    }

    /// Role of the variable with this index.
    pub(super) fn role(&self, index: usize) -> Role {
        let variable = self.identity.variables.get(index);
        variable.map_or(Role::Output, |variable| variable.role)
    }

    /// Name of the variable with this index.
    pub(super) fn name(&self, index: usize) -> Name {
        self.identity.variables.name(index)
    }
}
