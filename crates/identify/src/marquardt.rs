//! The iteration of Levenberg and Marquardt with weights that are held: each step is damped by what the last one came to.

use std::sync::Arc;

use nalgebra::DVector;

use super::estimator::Chart;
use super::objective::{Objective, State, Weights};

/// Less than this changes no step.
const LEAST: f64 = 1e-15;
/// After a refused step: less than this would lead to the same place again.
const LEAST_THAT_SHORTENS: f64 = 1e-6;
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
}

/// By how much the first refused step raises it, and by how much more each further one.
const RAISE: f64 = 10.0;

impl Damping {
    /// That of the first step.
    pub(super) const FIRST: Self = Self::of(1e-3);

    const fn of(value: f64) -> Self {
        Self {
            value,
            raise: RAISE,
        }
    }

    /// After a step that was taken and gained this part of what it promised.
    pub(super) fn taken(self, part_of_promise: f64) -> Self {
        let factor = match part_of_promise {
            part if part > GOOD => 0.01,
            part if part > FAIR => 0.2,
            _ => 1.0,
        };
        Self::of((self.value * factor).max(LEAST))
    }

    /// After a refused step; `None` where no shorter one is worth a trial.
    pub(super) fn refused(self) -> Option<Self> {
        let more = (self.raise * self.value).max(LEAST_THAT_SHORTENS);
        (more <= MOST).then_some(Self {
            value: more,
            raise: self.raise * RAISE,
        })
    }

    /// What the next iteration begins with.
    pub(super) fn for_the_next(self) -> Self {
        Self::of(self.value.min(Self::FIRST.value))
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
        if objective.is_of_many_bolts() && wanders(&promises) {
            break;
        }
        if normal.is_settled(&coordinates, negligible_gain) {
            settled = true;
            break;
        }
        let trial = normal.step(damping.value).map(|step| {
            let promised = normal.gain(&step, damping.value);
            (&coordinates + step, promised)
        });
        let improved = trial
            .as_ref()
            .map(|(trial, _)| trial)
            .filter(|trial| objective.is_within_reach(&chart.unknowns(trial)))
            .and_then(|trial| {
                let corrections = Some(Arc::clone(&state.corrections));
                objective.at(weights, chart.unknowns(trial), corrections)
            })
            .filter(|next| next.normal.cost <= state.normal.cost * (1.0 + negligible_gain));
        if let (Some((trial, promised)), Some(next)) = (trial, improved) {
            coordinates = trial;
            damping = damping.taken((state.normal.cost - next.normal.cost) / promised);
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
        let damping = Damping::FIRST;
        assert!(damping.taken(1.0).value < damping.taken(0.5).value);
        assert_eq!(damping.taken(0.1), damping);
        assert!(damping.refused().unwrap().value > damping.value);
        assert_eq!(Damping::of(LEAST).taken(1.0).value, LEAST);
    }

    #[test]
    fn few_refusals_shorten_a_step_to_nothing() {
        let mut damping = Damping::of(LEAST);
        let mut count = 0;
        while let Some(more) = damping.refused() {
            damping = more;
            count += 1;
        }
        assert!(count < 8, "{count}");
        // a step that is taken begins anew
        assert_eq!(damping.taken(0.1), Damping::of(damping.value));
    }
}
