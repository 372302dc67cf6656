//! Partial derivatives at the present point: of outputs with respect to inputs, states and parameters.

use std::mem::MaybeUninit;

use super::{Instance, variables::CALCULATED_PARAMETERS};
use crate::{
    interface::{Name, Role, Roles, Values, memory},
    refusal::Refusal,
    values::Inner,
};

impl Instance {
    /// Change of the unknowns when the knowns change along `seed`; one seed for each known, one result for each unknown.
    pub(crate) fn directional_derivative(
        &self,
        [unknowns, knowns]: [&[u32]; 2],
        seed: &[f64],
        sensitivity: &mut [MaybeUninit<f64>],
    ) -> Result<(), Refusal> {
        self.check_derivative(unknowns, knowns)?;
        let mut change = self.values.change();
        for (&known, &seed) in knowns.iter().zip(seed) {
            let (index, _) = self.known(known)?;
            self.check_seed(index, seed)?;
            // a known that is listed twice counts twice
            change[index] += seed;
        }
        self.differentiate(&self.present(), unknowns, &mut change)?;
        for (&unknown, sensitivity) in unknowns.iter().zip(sensitivity) {
            let (index, _) = self.known(unknown)?;
            sensitivity.write(self.finite(index, change[index])?);
        }
        Ok(())
    }

    /// For each known, the sum over the unknowns of seed times partial derivative: the transposed product.
    pub(crate) fn adjoint_derivative(
        &self,
        [unknowns, knowns]: [&[u32]; 2],
        seed: &[f64],
        sensitivity: &mut [MaybeUninit<f64>],
    ) -> Result<(), Refusal> {
        self.check_derivative(unknowns, knowns)?;
        for (&unknown, &seed) in unknowns.iter().zip(seed) {
            let (index, _) = self.known(unknown)?;
            self.check_seed(index, seed)?;
        }
        let values = self.present();
        for (&known, sensitivity) in knowns.iter().zip(sensitivity) {
            let (known, _) = self.known(known)?;
            // one column of the Jacobian
            let mut column = values.change();
            column[known] = 1.0;
            self.differentiate(&values, unknowns, &mut column)?;
            let mut sum = 0.0;
            for (&unknown, &seed) in unknowns.iter().zip(seed) {
                let (unknown, _) = self.known(unknown)?;
                sum += seed * column[unknown];
            }
            sensitivity.write(self.finite(known, sum)?);
        }
        Ok(())
    }

    /// The present point, with the rate of the preload.
    fn present(&self) -> Values {
        let mut values = self.values.clone();
        self.model.settle(&mut values);
        values[memory::PRELOAD_RATE] = self.preload_rate();
        let remembers_from_start = values.are_integrated() || !values.listed().is_empty();
        if self.begins() && remembers_from_start {
            values.set_inner(Inner::Starting);
        }
        values
    }

    /// Turns a direction from the point `values` into the change of all that is calculated; of calculated parameters only
    /// where they are asked for.
    fn differentiate(
        &self,
        values: &Values,
        unknowns: &[u32],
        change: &mut Values,
    ) -> Result<(), Refusal> {
        self.model.differentiate_outputs(values, change);
        if self.begins() {
            self.model.hold_at_start(change);
        }
        for &unknown in unknowns {
            let (_, roles) = self.known(unknown)?;
            if roles.intersects(CALCULATED_PARAMETERS) {
                self.model.differentiate_parameters(values, change);
                break;
            }
        }
        Ok(())
    }

    /// Whether there are derivatives now, of these unknowns and by these knowns.
    fn check_derivative(&self, unknowns: &[u32], knowns: &[u32]) -> Result<(), Refusal> {
        let mode = self.mode;
        let (differentiable, independent) = mode
            .unknowns_and_knowns()
            .ok_or(Refusal::NoDerivatives { mode })?;
        self.check_roles(unknowns, differentiable, |name, role| Refusal::NotUnknown {
            name,
            role,
            mode,
        })?;
        self.check_roles(knowns, independent, |name, role| Refusal::NotKnown {
            name,
            role,
        })
    }

    fn check_roles(
        &self,
        references: &[u32],
        allowed: Roles,
        refusal: impl Fn(Name, Role) -> Refusal,
    ) -> Result<(), Refusal> {
        for &reference in references {
            let (index, roles) = self.known(reference)?;
            if !roles.intersects(allowed) {
                return Err(refusal(self.name(index), self.role(index)));
            }
        }
        Ok(())
    }

    fn check_seed(&self, index: usize, seed: f64) -> Result<(), Refusal> {
        if seed.is_finite() {
            Ok(())
        } else {
            let name = self.name(index);
            Err(Refusal::SeedNotFinite { name, seed })
        }
    }

    fn finite(&self, index: usize, derivative: f64) -> Result<f64, Refusal> {
        if derivative.is_finite() {
            Ok(derivative)
        } else {
            Err(Refusal::DerivativeNotFinite {
                name: self.name(index),
                time_s: self.time_s(),
            })
        }
    }
}
