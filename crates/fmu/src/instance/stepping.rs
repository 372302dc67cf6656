//! Communication steps of Co-Simulation that are taken in one go.

use super::Instance;
use crate::{
    interface::{InterfaceType, Values, reference::TIME},
    mode::Mode,
    models::Step,
    refusal::{Reached, Refusal, Warning},
};

impl Instance {
    /// Advances from `current_s` by `interval_s`, with the inputs held or along the derivatives that were given.
    pub(crate) fn step(
        &mut self,
        current_s: f64,
        interval_s: f64,
    ) -> Result<Option<Warning>, Refusal> {
        let end_s = self.end_of_step(current_s, interval_s)?;
        let active = if self.parameters_changed {
            self.prepare_model()?
        } else {
            None
        };
        let pace = self.pace.followed_by(interval_s);
        let reached = self.advance(Step {
            time_s: current_s,
            interval_s,
            is_steady: pace.is_steady(),
        })?;
        if !self.inputs.is_none() {
            self.inputs.end();
        }
        self.pace = pace;
        // only now, so that a warning reaches the importer even if this step is refused and the next one is not
        self.parameters_changed = false;
        self.values[TIME] = end_s;
        Ok(Warning::of(active, reached))
    }

    /// Takes the step in the most common case: one of many equal ones, with the inputs held and nothing wrong. Tells
    /// whether it was that; otherwise nothing has moved.
    #[inline]
    pub(crate) fn step_steadily(&mut self, current_s: f64, interval_s: f64) -> bool {
        if self.mode != Mode::Step
            || !self.pace.is_kept_by(interval_s)
            || self.parameters_changed
            || !self.inputs.is_none()
        {
            return false;
        }
        // closer limits than those of `end_of_step`
        let expected_s = self.time_s();
        let end_s = current_s + interval_s;
        let is_in_time = (current_s - expected_s).abs() <= 1e-6 * interval_s
            && end_s > expected_s
            && end_s <= self.stop_s.unwrap_or(f64::MAX);
        if !is_in_time
            || !self
                .model
                .advance_steadily(&mut self.values, current_s, interval_s)
        {
            return false;
        }
        self.values[TIME] = end_s;
        self.outputs_stale = true;
        true
    }

    /// Advances states and inputs, but not the time; on refusal nothing moves.
    #[inline]
    pub(super) fn advance(&mut self, step: Step) -> Result<Option<Reached>, Refusal> {
        let reached = if self.inputs.is_held() {
            self.model.advance(&mut self.values, step, &self.inputs)?
        } else {
            self.advance_along(step)?
        };
        self.outputs_stale = true;
        Ok(reached)
    }

    #[cold]
    fn advance_along(&mut self, step: Step) -> Result<Option<Reached>, Refusal> {
        let end = self.inputs_after(step)?;
        let reached = self.model.advance(&mut self.values, step, &self.inputs)?;
        self.set_inputs(&end);
        self.inputs.go_on(step.interval_s);
        Ok(reached)
    }

    /// The inputs at the end of the step.
    fn inputs_after(&self, step: Step) -> Result<Values, Refusal> {
        let mut values = self.values.clone();
        for (index, variable) in self.identity.variables.iter() {
            if variable.role.is_input() {
                let value = self.inputs.value(index, values[index], step.interval_s);
                if !value.is_finite() {
                    return Err(Refusal::InputNotFinite {
                        name: variable.name.clone(),
                        time_s: step.time_s + step.interval_s,
                    });
                }
                values[index] = value;
            }
        }
        Ok(values)
    }

    /// Takes the inputs over from `values`.
    pub(super) fn set_inputs(&mut self, values: &Values) {
        for (index, variable) in self.identity.variables.iter() {
            if variable.role.is_input() {
                self.values[index] = values[index];
            }
        }
    }

    /// End of the step, if there can be one now, and the importer's and the FMU's times agree but for rounding.
    #[inline]
    pub(super) fn end_of_step(&self, current_s: f64, interval_s: f64) -> Result<f64, Refusal> {
        if self.mode != Mode::Step {
            self.require_type(InterfaceType::CoSimulation)?;
            self.require(&[Mode::Step])?;
        }
        if !(interval_s.is_finite() && interval_s > 0.0) {
            return Err(Refusal::StepSize {
                found_s: interval_s,
            });
        }
        // An importer computes its n-th point as t0 + n·h, or by adding h n times: both differ by rounding only.
        let expected_s = self.time_s();
        let agrees = (current_s - expected_s).abs() <= rounding_s(expected_s, interval_s);
        if !agrees {
            return Err(Refusal::CommunicationPoint {
                found_s: current_s,
                expected_s,
            });
        }
        let end_s = current_s + interval_s;
        if !(end_s > expected_s && end_s.is_finite()) {
            return Err(Refusal::StepVanishes {
                current_s,
                interval_s,
            });
        }
        if let Some(stop_s) = self.stop_s
            && end_s - stop_s > past_stop_s(stop_s, interval_s)
        {
            return Err(Refusal::PastStop { end_s, stop_s });
        }
        Ok(end_s)
    }
}

/// How far rounding may take an importer's time near `time_s` (s) from the FMU's, in steps of `interval_s` (s).
#[inline]
fn rounding_s(time_s: f64, interval_s: f64) -> f64 {
    1e-6 * interval_s + 16.0 * f64::EPSILON * time_s.abs()
}

/// How far a step of `interval_s` (s) may end past the stop time: as far as the sum drifts of an importer that adds h again
/// and again, but never so far that a late stop time leaves room for another step.
#[inline]
fn past_stop_s(stop_s: f64, interval_s: f64) -> f64 {
    let drift_s = f64::min(1e-2 * interval_s, 1e-9 * stop_s.abs());
    drift_s + rounding_s(stop_s, interval_s)
}
