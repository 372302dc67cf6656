//! The ways of a lap through a communication step, by what its joint remembers, and the lap among the variables.

use std::num::NonZeroU32;

use bolted_joint_dynamics::{Lap, LapLoads, LapState};

use crate::{
    input_course::InputCourse,
    interface::Values,
    models::{
        Outcome, Step,
        sides::{A, B, joint_law},
        watch::Watch,
    },
    refusal::{Reached, Refusal},
};

/// What a lap's parameters give when they are taken into use, and the way of the lap through a communication step. Its
/// methods do what those of `Model` with their names do.
pub(in crate::models) trait Way<const D: usize>: Sized + Send {
    /// Prepares `lap` for Runge–Kutta steps of `step_size_max_s` (s) at most, with its escape amplitudes, and the
    /// relative displacements up to which there is nothing to tell the user.
    fn new(lap: &Lap<D>, step_size_max_s: f64, escape: [Option<f64>; D], quiet: [f64; D]) -> Self;

    /// Relative displacement that a softening joint holds at most; the largest number where it always holds.
    fn hold(&self) -> &[f64; D];

    /// What there is to tell the user of this state at `time_s` (s).
    fn look(&mut self, watch: &mut Watch<D>, state: &LapState<D>, time_s: f64) -> Option<Reached>;

    fn internal_steps(&self, interval_s: f64) -> Result<NonZeroU32, Refusal>;

    fn advance(
        &mut self,
        watch: &mut Watch<D>,
        values: &mut Values,
        step: Step,
        inputs: &InputCourse,
    ) -> Outcome;

    fn advance_steadily(&self, _values: &mut Values, _interval_s: f64) -> bool {
        false
    }

    fn begin(_: &mut Values) {}

    fn commit(_values: &mut Values, _time_s: f64) -> Result<(), Refusal> {
        Ok(())
    }

    fn pass_event(_values: &mut Values) {}

    /// Writes the event indicators.
    fn set_indicators(_values: &mut Values) {}

    /// Writes the first-order change of the event indicators.
    fn differentiate_indicators(_values: &Values, _change: &mut Values) {}

    /// Adds the rates of what is integrated beside the motion.
    fn add_rates(_values: &Values, _rates: &mut Values) {}
}

pub(in crate::models) fn lap<const D: usize>(values: &Values) -> Lap<D> {
    Lap {
        joint: joint_law(values),
        a: A.body(values),
        b: B.body(values),
    }
}

#[inline]
pub(in crate::models) fn state<const D: usize>(values: &Values) -> LapState<D> {
    LapState {
        a: A.motion(values),
        b: B.motion(values),
    }
}

#[inline]
pub(in crate::models) fn set_state<const D: usize>(values: &mut Values, state: &LapState<D>) {
    A.set_motion(values, &state.a);
    B.set_motion(values, &state.b);
}

#[inline]
pub(in crate::models) fn loads<const D: usize>(values: &Values) -> LapLoads<D> {
    LapLoads {
        a: A.load(values),
        b: B.load(values),
    }
}
