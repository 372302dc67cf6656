//! What Model Exchange adds: the importer integrates, the instance gives the derivatives of its states.

use std::mem::MaybeUninit;

use super::Instance;
use crate::{
    interface::{ContinuousState, reference::TIME},
    mode::Mode,
    refusal::{Refusal, Warning},
    version::Abi,
};

/// Modes in which the states and what follows from them can be read.
const READABLE: &[Mode] = &[
    Mode::Initialization,
    Mode::Event,
    Mode::ContinuousTime,
    Mode::Terminated,
];

impl Instance {
    /// From an event on to continuous time: parameters that were changed take effect.
    pub(crate) fn enter_continuous_time_mode(&mut self) -> Result<Option<Warning>, Refusal> {
        self.require(&[Mode::Event])?;
        let active = self.use_parameters()?;
        self.mode = Mode::ContinuousTime;
        Ok(Warning::of(active, None))
    }

    /// Sets the time; the importer's solver may also go back.
    pub(crate) fn set_time(&mut self, time_s: f64) -> Result<(), Refusal> {
        self.require(&[Mode::ContinuousTime])?;
        if !time_s.is_finite() {
            return Err(Refusal::Time { found_s: time_s });
        }
        // nothing but the time itself depends on it
        self.values[TIME] = time_s;
        Ok(())
    }

    /// Sets all states, or none.
    pub(crate) fn set_continuous_states(&mut self, states: &[f64]) -> Result<(), Refusal> {
        self.require(&[Mode::ContinuousTime])?;
        self.check_count(states.len())?;
        let variables = &self.identity.variables;
        for (state, &value) in variables.continuous_states().zip(states) {
            if !value.is_finite() {
                let name = self.name(state.reference);
                return Err(Refusal::ValueNotFinite { name, value });
            }
        }
        for (state, &value) in variables.continuous_states().zip(states) {
            self.values[state.reference] = value;
        }
        self.outputs_stale = true;
        Ok(())
    }

    /// Reads all states.
    pub(crate) fn continuous_states(
        &mut self,
        states: &mut [MaybeUninit<f64>],
    ) -> Result<(), Refusal> {
        self.require(READABLE)?;
        if self.begins() {
            // inner states follow from the start values
            self.calculate_outputs();
        }
        self.fill(states, |state| Ok(self.values[state.reference]))
    }

    /// Reads the derivatives of all states.
    pub(crate) fn derivatives(
        &mut self,
        derivatives: &mut [MaybeUninit<f64>],
    ) -> Result<(), Refusal> {
        self.require(READABLE)?;
        self.calculate_outputs();
        self.fill(derivatives, |state| {
            let derivative = self.values[state.derivative];
            if derivative.is_finite() {
                Ok(derivative)
            } else {
                Err(self.overflow(state.derivative))
            }
        })
    }

    /// Reads typical magnitudes of all states; in FMI 2.0 in every state.
    pub(crate) fn nominals(&self, nominals: &mut [MaybeUninit<f64>]) -> Result<(), Refusal> {
        if self.identity.abi == Abi::Fmi3 {
            self.require(READABLE)?;
        }
        self.fill(nominals, |state| Ok(state.nominal))
    }

    /// Refuses to read another number of event indicators than there is. In FMI 2.0 they are only where states can be read.
    pub(crate) fn check_indicator_count(&self, found: usize) -> Result<(), Refusal> {
        if self.identity.abi == Abi::Fmi2 {
            self.require(READABLE)?;
        }
        match self.indicator_count() {
            expected if expected == found => Ok(()),
            expected => Err(Refusal::IndicatorCount {
                argument: self.words().indicator_count,
                found,
                expected,
            }),
        }
    }

    /// Reads all event indicators: where one falls to zero there is an event. Their number was checked.
    pub(crate) fn event_indicators(
        &mut self,
        indicators: &mut [MaybeUninit<f64>],
    ) -> Result<(), Refusal> {
        if indicators.is_empty() {
            return Ok(());
        }
        self.calculate_outputs();
        let references = self.identity.variables.event_indicators();
        for (indicator, reference) in indicators.iter_mut().zip(references) {
            let value = self.values[reference];
            if !value.is_finite() {
                return Err(self.overflow(reference));
            }
            indicator.write(value);
        }
        Ok(())
    }

    /// Number of event indicators.
    pub(crate) fn indicator_count(&self) -> usize {
        self.identity.variables.event_indicators().count()
    }

    /// Checks what a step of the importer's solver has led to.
    pub(crate) fn complete_integrator_step(&mut self) -> Result<Option<Warning>, Refusal> {
        self.require(&[Mode::ContinuousTime])?;
        // a restored state may have brought other parameters
        let active = self.use_parameters()?;
        let reached = self.model.check_states(&self.values)?;
        let time_s = self.values[TIME];
        self.model.commit(&mut self.values, time_s)?;
        self.outputs_stale = true;
        Ok(Warning::of(active, reached))
    }

    /// Number of continuous states.
    pub(crate) fn state_count(&self) -> usize {
        self.identity.variables.continuous_states().count()
    }

    fn check_count(&self, found: usize) -> Result<(), Refusal> {
        let expected = self.state_count();
        if found == expected {
            Ok(())
        } else {
            Err(Refusal::StateCount {
                argument: self.words().state_count,
                found,
                expected,
            })
        }
    }

    /// Writes one number for each state.
    fn fill(
        &self,
        numbers: &mut [MaybeUninit<f64>],
        number_of: impl Fn(&ContinuousState) -> Result<f64, Refusal>,
    ) -> Result<(), Refusal> {
        self.check_count(numbers.len())?;
        let states = self.identity.variables.continuous_states();
        for (number, state) in numbers.iter_mut().zip(states) {
            number.write(number_of(state)?);
        }
        Ok(())
    }
}
