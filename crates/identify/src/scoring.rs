//! The estimate of a search where the substructures' receptances are held as they were measured.
//!
//! Σ = Σ_C + J Σ_H Jᴴ follows the unknowns there, so that the sum falls also where Σ grows: it is no measure of a step. The estimate
//! is where the score Jᵀ Σ⁻¹ r̃ vanishes, as it does on average at the truth. A step is measured by what is left of it,
//! gᵀ N⁻¹ g.

use std::sync::Arc;

use nalgebra::DVector;

use super::estimator::Chart;
use super::marquardt::{Damping, Rest};
use super::normal::Normal;
use super::objective::{Objective, State, Weights};

/// Steps at most.
const MOST_STEPS: usize = 25;
/// A step is halved so many times at most, until less of the score is left.
const HALVINGS: usize = 5;
/// Damping where the information is singular, as in a full step elsewhere.
const LEAST_DAMPING: f64 = 1e-12;

/// Steps from `start` coordinates, at which `state` is, until the score promises no more than this part of the cost.
pub(super) fn scored(
    objective: &Objective<'_>,
    weights: &[Weights],
    chart: &dyn Chart,
    start: &DVector<f64>,
    state: State,
    negligible_gain: f64,
) -> Rest {
    let normal = state.normal_in(chart, start);
    let mut now = (start.clone(), state, normal);
    let mut settled = false;
    for _ in 0..MOST_STEPS {
        settled = now.2.is_settled(&now.0, negligible_gain);
        if settled {
            break;
        }
        let Some(next) = stepped(objective, weights, chart, &now) else {
            break;
        };
        now = next;
    }
    let (coordinates, state, normal) = now;
    Rest {
        scale: normal.scale(),
        coordinates,
        state,
        settled,
        damping: Damping::first(objective),
    }
}

type At = (DVector<f64>, State, Normal);

/// As far along the step as leaves less of the score; `None` where nothing does.
fn stepped(
    objective: &Objective<'_>,
    weights: &[Weights],
    chart: &dyn Chart,
    (coordinates, state, normal): &At,
) -> Option<At> {
    let left = |normal: &Normal| Some(normal.promise()? * normal.cost);
    let (mut step, before) = (normal.step(LEAST_DAMPING)?, left(normal)?);
    for _ in 0..=HALVINGS {
        let trial = coordinates + &step;
        let unknowns = chart.unknowns(&trial);
        if objective.is_within_reach(&unknowns) {
            let corrections = Some(Arc::clone(&state.corrections));
            if let Some(next) = objective.at(weights, unknowns, corrections) {
                let normal = next.normal_in(chart, &trial);
                if left(&normal).is_some_and(|left| left < before) {
                    return Some((trial, next, normal));
                }
            }
        }
        step *= 0.5;
    }
    None
}
