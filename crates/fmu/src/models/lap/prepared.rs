//! A lap whose parameters are taken into use, and its way through a communication step.

use std::num::NonZeroU32;

use bolted_joint_dynamics::{Lap, LapIntegrator, LapLoads, LapPropagator, LapState, substeps};

use super::{
    loads::Loads,
    way::{Way, loads, set_state, state},
};
use crate::{
    input_course::InputCourse,
    interface::Values,
    models::{
        Outcome, Step,
        watch::{Watch, finite},
    },
    refusal::{Reached, Refusal},
};

/// Most Runge–Kutta steps in one communication step: about a minute's work.
const SUBSTEPS_MAX: u32 = 1_000_000_000;

/// Runge–Kutta steps in a communication step from which preparing for that one step alone is quicker than taking them.
const STEPS_WORTH_PREPARING: u32 = 256;

/// Runge–Kutta steps after which it is checked whether a softening joint still holds: a tenth of the fastest period where
/// the export has chosen the step. Checking after every one takes half as long again.
const STEPS_BETWEEN_CHECKS: NonZeroU32 = NonZeroU32::new(8).unwrap();

/// A lap made ready for steps.
#[derive(Clone, Copy, Debug)]
pub(in crate::models) struct Prepared<const D: usize> {
    pub(super) integrator: LapIntegrator<D>,
    step_size_max_s: f64,
    /// Relative displacement that a softening joint holds at most; the largest number where it always holds.
    pub(super) amplitude: [f64; D],
    /// Relative displacement up to which there is nothing to tell the user.
    quiet: [f64; D],
    /// Whether the joint holds only so far.
    softens: bool,
    /// What the latest length of a communication step gives; `None` before the first one.
    interval: Option<Interval<D>>,
}

/// One length of communication steps.
#[derive(Clone, Copy, Debug)]
struct Interval<const D: usize> {
    length_s: f64,
    /// Runge–Kutta steps that it takes.
    count: NonZeroU32,
    propagation: Propagation<D>,
}

/// Whether one product can take the place of the Runge–Kutta steps.
#[derive(Clone, Copy, Debug)]
enum Propagation<const D: usize> {
    /// Nobody has asked yet.
    Unknown,
    /// It cannot: the equations are not linear, or a mode grows past all bounds.
    Impossible,
    /// It cannot, because the joint has terms of higher order, whose steps are others.
    Higher,
    /// It can.
    Possible(LapPropagator<D>),
}

impl<const D: usize> Way<D> for Prepared<D> {
    fn new(lap: &Lap<D>, step_size_max_s: f64, escape: [Option<f64>; D], quiet: [f64; D]) -> Self {
        Self {
            integrator: LapIntegrator::new(lap),
            step_size_max_s,
            amplitude: finite(escape),
            quiet: std::array::from_fn(|dof| quiet[dof].min(escape[dof].unwrap_or(f64::MAX))),
            softens: escape.iter().any(Option::is_some),
            interval: None,
        }
    }

    fn hold(&self) -> &[f64; D] {
        &self.amplitude
    }

    fn look(&mut self, watch: &mut Watch<D>, state: &LapState<D>, time_s: f64) -> Option<Reached> {
        if self.holds_quietly(state) {
            return None;
        }
        let reached = watch.look(&state.relative().displacement, time_s);
        self.quiet = watch.quiet();
        for dof in 0..D {
            self.quiet[dof] = self.quiet[dof].min(self.amplitude[dof]);
        }
        reached
    }
    fn internal_steps(&self, interval_s: f64) -> Result<NonZeroU32, Refusal> {
        count(interval_s, self.step_size_max_s)
    }

    fn advance(
        &mut self,
        watch: &mut Watch<D>,
        values: &mut Values,
        step: Step,
        inputs: &InputCourse,
    ) -> Outcome {
        let start = state::<D>(values);
        let loads = Loads {
            start: loads(values),
            course: inputs,
        };
        let end = if inputs.is_held() {
            self.advance_held(&start, &loads.start, step)?
        } else {
            self.advance_along(&start, &loads, step)?
        };
        let mut reached = None;
        if !self.holds_quietly(&end) {
            if !self.holds(&end) {
                return Err(self.explain(&start, &loads, step));
            }
            reached = self.look(watch, &end, step.time_s + step.interval_s);
        }
        set_state(values, &end);
        Ok(reached)
    }

    #[inline(always)]
    fn advance_steadily(&self, values: &mut Values, interval_s: f64) -> bool {
        if D > 1 && self.takes_single_steps(interval_s) {
            return take_single_step(self, values, interval_s);
        }
        let (start, loads) = (state(values), loads(values));
        match self.steady_end(&start, &loads, interval_s) {
            Some(end) if self.holds_quietly(&end) => {
                set_state(values, &end);
                true
            }
            _ => false,
        }
    }
}

impl<const D: usize> Prepared<D> {
    /// State at the end of the step, by one product where that is possible and worth its preparation.
    #[inline]
    fn advance_held(
        &mut self,
        start: &LapState<D>,
        loads: &LapLoads<D>,
        step: Step,
    ) -> Result<LapState<D>, Refusal> {
        let length_s = step.interval_s;
        let interval = match &mut self.interval {
            Some(interval) if interval.length_s == length_s => interval,
            interval => interval.insert(Interval {
                length_s,
                count: count(length_s, self.step_size_max_s)?,
                propagation: Propagation::Unknown,
            }),
        };
        let count = interval.count;
        if step.is_steady || count.get() >= STEPS_WORTH_PREPARING {
            if let Propagation::Unknown = interval.propagation {
                interval.propagation = propagation(&self.integrator, length_s, count);
            }
            if let Propagation::Possible(propagator) = &interval.propagation {
                return Ok(propagator.advance(start, loads));
            }
        }
        if self.softens && count > STEPS_BETWEEN_CHECKS {
            return Ok(self.stepped_while_held(start, loads, length_s, count));
        }
        Ok(stepped(&self.integrator, start, loads, length_s, count))
    }

    /// State after the Runge–Kutta steps under held loads, or, of a softening joint, at the first check that finds it
    /// torn: what a load brings back from there cannot become whole again.
    fn stepped_while_held(
        &self,
        start: &LapState<D>,
        loads: &LapLoads<D>,
        interval_s: f64,
        count: NonZeroU32,
    ) -> LapState<D> {
        let length_s = interval_s / f64::from(count.get());
        let mut state = *start;
        let mut rest = count.get();
        while rest > 0 {
            // so many steps have the length of one to the last bit, because it is a power of two
            let next = if rest >= STEPS_BETWEEN_CHECKS.get() {
                STEPS_BETWEEN_CHECKS
            } else {
                NonZeroU32::MIN
            };
            let span_s = length_s * f64::from(next.get());
            state = stepped(&self.integrator, &state, loads, span_s, next);
            if !self.holds(&state) {
                break;
            }
            rest -= next.get();
        }
        state
    }

    /// Whether all is prepared for one of many equal steps that is a single Runge–Kutta step without terms of higher order.
    #[inline]
    fn takes_single_steps(&self, interval_s: f64) -> bool {
        self.interval.as_ref().is_some_and(|interval| {
            interval.length_s == interval_s
                && interval.count == NonZeroU32::MIN
                && matches!(interval.propagation, Propagation::Impossible)
        })
    }

    /// State at the end of one of many equal steps, if all is prepared for it.
    #[inline]
    fn steady_end(
        &self,
        start: &LapState<D>,
        loads: &LapLoads<D>,
        interval_s: f64,
    ) -> Option<LapState<D>> {
        let interval = self.interval.as_ref()?;
        if interval.length_s != interval_s {
            return None;
        }
        match &interval.propagation {
            Propagation::Unknown => None,
            Propagation::Possible(propagator) => Some(propagator.advance(start, loads)),
            Propagation::Higher => None,
            Propagation::Impossible if self.softens && interval.count > STEPS_BETWEEN_CHECKS => {
                None
            }
            Propagation::Impossible => Some(self.integrator.advance_without_higher(
                start,
                loads,
                interval_s,
                interval.count,
            )),
        }
    }

    /// State at the end of the step under loads that change, by Runge–Kutta steps.
    #[cold]
    fn advance_along(
        &self,
        start: &LapState<D>,
        loads: &Loads<'_, D>,
        step: Step,
    ) -> Result<LapState<D>, Refusal> {
        let count = self.internal_steps(step.interval_s)?.get();
        let length_s = step.interval_s / f64::from(count);
        let mut state = *start;
        for index in 0..count {
            let loads = loads.at_stages(index, length_s);
            state = self.integrator.step_with_loads(&state, &loads, length_s);
            if !self.holds(&state) {
                break;
            }
        }
        Ok(state)
    }

    /// Whether the state is finite and the joint holds.
    #[inline]
    pub(super) fn holds(&self, state: &LapState<D>) -> bool {
        is_within(&self.amplitude, state)
    }

    /// Whether, besides, there is nothing to tell the user.
    #[inline]
    fn holds_quietly(&self, state: &LapState<D>) -> bool {
        is_within(&self.quiet, state)
    }
}

/// Whether the state is finite and its relative displacements are within the limits.
#[inline(always)]
pub(in crate::models) fn is_within<const D: usize>(limits: &[f64; D], state: &LapState<D>) -> bool {
    let relative = state.a.relative_to(&state.b);
    let mut sum = 0.0;
    let mut holds = true;
    for dof in 0..D {
        sum += state.a.displacement[dof].abs() + state.b.displacement[dof].abs();
        sum += state.a.velocity[dof].abs() + state.b.velocity[dof].abs();
        // a comparison with NaN is false
        holds &= relative.displacement[dof].abs() <= limits[dof];
    }
    holds && sum <= f64::MAX
}

/// One of many equal steps that is a single Runge–Kutta step. Apart from all else, so that the numbers stay in the registers.
#[inline(never)]
fn take_single_step<const D: usize>(
    prepared: &Prepared<D>,
    values: &mut Values,
    interval_s: f64,
) -> bool {
    let end = prepared.integrator.advance_without_higher(
        &state(values),
        &loads(values),
        interval_s,
        NonZeroU32::MIN,
    );
    let holds = prepared.holds_quietly(&end);
    if holds {
        set_state(values, &end);
    }
    holds
}

/// The Runge–Kutta steps where time does not matter.
#[cold]
fn stepped<const D: usize>(
    integrator: &LapIntegrator<D>,
    start: &LapState<D>,
    loads: &LapLoads<D>,
    interval_s: f64,
    count: NonZeroU32,
) -> LapState<D> {
    integrator.advance(start, loads, interval_s, count)
}

/// Number of Runge–Kutta steps in a communication step.
#[cold]
pub(in crate::models) fn count(
    interval_s: f64,
    step_size_max_s: f64,
) -> Result<NonZeroU32, Refusal> {
    // n = ⌈H/h_max⌉
    substeps(interval_s, step_size_max_s)
        .filter(|count| count.get() <= SUBSTEPS_MAX)
        .ok_or(Refusal::TooManySubsteps {
            interval_s,
            step_size_max_s,
            most: SUBSTEPS_MAX,
        })
}

#[cold]
fn propagation<const D: usize>(
    integrator: &LapIntegrator<D>,
    interval_s: f64,
    count: NonZeroU32,
) -> Propagation<D> {
    if integrator.has_higher() {
        return Propagation::Higher;
    }
    LapPropagator::new(integrator, interval_s, count)
        .map_or(Propagation::Impossible, Propagation::Possible)
}
