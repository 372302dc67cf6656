//! The iteration of Levenberg and Marquardt with weights that are held: each step is damped by what the last one came to.

use std::sync::Arc;

use nalgebra::DVector;

use super::estimator::Chart;
use super::normal::Normal;
use super::objective::{Objective, State, Weights};

/// Less than this changes no step.
const LEAST: f64 = 1e-15;
/// More than this, and the step is as good as none.
const MOST: f64 = 1e12;
/// Parts of the promised gain from which on the model is trusted far, or as far as before.
const GOOD: f64 = 0.75;
const FAIR: f64 = 0.25;
/// Promised gain, as a fraction of the cost, that is none where no damped step lowers the cost any more: rounding of the sum hides gains of this size.
const HIDDEN_GAIN: f64 = 1e-12;
/// The damping of an iteration, a fraction of the diagonal of JᵀJ.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Damping {
    pub(super) value: f64,
    /// By how much the next refused step raises it.
    raise: f64,
    ways: Ways,
}

/// How damping follows what steps come to.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Ways {
    /// Factor after a step that gained what it promised.
    fall: f64,
    /// After a refused step: less than this would lead to the same place again.
    least_that_shortens: f64,
}

/// Few unknowns are told well: all eigenvalues of JᵀJ, in columns of unit length, are far above these.
const OF_WIDE_VALLEYS: Ways = Ways {
    fall: 0.01,
    least_that_shortens: 1e-6,
};
/// Valleys of many unknowns have eigenvalues of 1e-8 and less, which damping has to find.
const OF_NARROW_VALLEYS: Ways = Ways {
    fall: 0.1,
    least_that_shortens: 1e-10,
};

/// By how much the first refused step raises it, and by how much more each further one.
const RAISE: f64 = 10.0;
/// That of the first step.
const FIRST: f64 = 1e-3;

impl Damping {
    /// That of the first step.
    pub(super) fn first(objective: &Objective<'_>) -> Self {
        let ways = if objective.has_many_joints() {
            OF_NARROW_VALLEYS
        } else {
            OF_WIDE_VALLEYS
        };
        Self::of(FIRST, ways)
    }

    const fn of(value: f64, ways: Ways) -> Self {
        Self {
            value,
            raise: RAISE,
            ways,
        }
    }

    /// After a step that was taken and gained this part of what it promised.
    pub(super) fn taken(self, part_of_promise: f64) -> Self {
        let factor = match part_of_promise {
            part if part > GOOD => self.ways.fall,
            part if part > FAIR => 0.2,
            _ => 1.0,
        };
        Self::of((self.value * factor).max(LEAST), self.ways)
    }

    /// After a refused step; `None` where no shorter one is worth a trial.
    pub(super) fn refused(self) -> Option<Self> {
        let more = (self.raise * self.value).max(self.ways.least_that_shortens);
        (more <= MOST).then_some(Self {
            value: more,
            raise: self.raise * RAISE,
            ways: self.ways,
        })
    }

    /// What the next iteration begins with.
    pub(super) fn for_the_next(self) -> Self {
        Self::of(self.value.min(FIRST), self.ways)
    }
}

/// When an iteration ends, and how it begins.
pub(super) struct Control {
    /// Gain that the full step promises, as a fraction of the cost, below which it has come to rest.
    pub(super) negligible_gain: f64,
    pub(super) damping: Damping,
    /// Trials of a step.
    pub(super) most: usize,
}

/// Where an iteration with held weights came to rest.
pub(super) struct Rest {
    pub(super) coordinates: DVector<f64>,
    pub(super) state: State,
    pub(super) scale: DVector<f64>,
    pub(super) settled: bool,
    /// Damping that the last step left, to go on with.
    pub(super) damping: Damping,
}

/// Steps over which the promise of a search that comes to rest falls by more than half.
const STEPS_OF_A_FALL: usize = 8;

/// Whether what steps promise has all but ceased to fall.
fn wanders(promises: &[f64]) -> bool {
    let before = promises.len().checked_sub(STEPS_OF_A_FALL + 1);
    before.is_some_and(|before| promises.last() > Some(&(0.5 * promises[before])))
}

/// Length of what bends a step, as a part of the step's own, beyond which second derivatives do not say enough.
const BENT_MOST: f64 = 0.75;

/// Gain that makes a step worth bending, as a part of a residual's mean square.
const LONG: f64 = 1e-3;

/// A step that may be taken.
struct Step {
    coordinates: DVector<f64>,
    /// Gain that it promises in the linearised model.
    promised: f64,
}

/// The damped step from these coordinates, bent as the assembly's receptances bend along it; `None` where it is singular.
fn stepped(
    objective: &Objective<'_>,
    weights: &[Weights],
    chart: &dyn Chart,
    (coordinates, normal): (&DVector<f64>, &Normal),
    damping: Damping,
) -> Option<Step> {
    let straight = normal.step(damping.value)?;
    let promised = normal.gain(&straight, damping.value);
    let is_long = promised * objective.measurements() as f64 > LONG * normal.cost;
    let is_in_unknowns = || chart.derivative(coordinates).is_none();
    let bend = || {
        let right = objective.bend(weights, coordinates, &straight)?;
        let bend = normal.solved(&right, damping.value)? * 0.5;
        let length = |step: &DVector<f64>| step.component_div(&normal.scale()).norm();
        (length(&bend) <= BENT_MOST * length(&straight)).then_some(bend)
    };
    let bend = (is_long && is_in_unknowns()).then(bend).flatten();
    let end = coordinates + straight;
    Some(Step {
        coordinates: match bend {
            Some(bend) => end + bend,
            None => end,
        },
        promised,
    })
}

/// The iteration from `start` coordinates, at which `state` is.
pub(super) fn levenberg_marquardt(
    objective: &Objective<'_>,
    weights: &[Weights],
    chart: &dyn Chart,
    start: &DVector<f64>,
    mut state: State,
    control: Control,
) -> Rest {
    let mut coordinates = start.clone();
    let mut normal = state.normal_in(chart, &coordinates);
    let Control {
        negligible_gain,
        mut damping,
        most,
    } = control;
    let mut settled = false;
    let mut promises: Vec<f64> = Vec::new();
    for _ in 0..most {
        bolted_joint_wanted::look();
        if objective.has_many_joints() && wanders(&promises) {
            break;
        }
        if normal.is_settled(&coordinates, negligible_gain) {
            settled = true;
            break;
        }
        let here = (&coordinates, &normal);
        let trial = stepped(objective, weights, chart, here, damping);
        let improved = trial
            .as_ref()
            .filter(|trial| objective.is_within_reach(&chart.unknowns(&trial.coordinates)))
            .and_then(|trial| {
                let corrections = Some(Arc::clone(&state.corrections));
                objective.at(weights, chart.unknowns(&trial.coordinates), corrections)
            })
            .filter(|next| next.normal.cost <= state.normal.cost * (1.0 + negligible_gain));
        if let (Some(trial), Some(next)) = (trial, improved) {
            coordinates = trial.coordinates;
            damping = damping.taken((state.normal.cost - next.normal.cost) / trial.promised);
            state = next;
            normal = state.normal_in(chart, &coordinates);
            promises.extend(normal.promise());
        } else {
            match damping.refused() {
                Some(more) => damping = more,
                None => break,
            }
        }
    }
    settled = settled || normal.is_settled(&coordinates, HIDDEN_GAIN);
    Rest {
        scale: normal.scale(),
        coordinates,
        state,
        settled,
        damping: damping.for_the_next(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_model_that_keeps_its_promise_is_trusted_and_one_that_does_not_is_not() {
        let damping = Damping::of(FIRST, OF_WIDE_VALLEYS);
        assert!(damping.taken(1.0).value < damping.taken(0.5).value);
        assert_eq!(damping.taken(0.1), damping);
        assert!(damping.refused().unwrap().value > damping.value);
        assert_eq!(Damping::of(LEAST, OF_WIDE_VALLEYS).taken(1.0).value, LEAST);
    }

    #[test]
    fn few_refusals_shorten_a_step_to_nothing() {
        let mut damping = Damping::of(LEAST, OF_WIDE_VALLEYS);
        let mut count = 0;
        while let Some(more) = damping.refused() {
            damping = more;
            count += 1;
        }
        assert!(count < 8, "{count}");
        // a step that is taken begins anew
        assert_eq!(
            damping.taken(0.1),
            Damping::of(damping.value, OF_WIDE_VALLEYS)
        );
    }
}
