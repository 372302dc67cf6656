//! Estimates that take the substructures as measured, but each value of the assembly only for as good as the errors of the
//! substructures let it be computed. Those errors act most at the resonances, where they would bias a plain fit.

use nalgebra::DVector;

use super::estimator::{Estimate, Free, GAIN_BEFORE_RENEWAL, first_levels, misfit};
use super::likelihood::log_variances;
use super::marquardt::{Control, Damping, levenberg_marquardt};
use super::noise::Noise;
use super::normal::relative_change;
use super::objective::{Corrections, Objective};

/// Times that the variances are renewed, at most.
const ROUNDS: usize = 12;
/// Trials of a step between two renewals, at most: variances from a joint that is far off lead nowhere in particular.
const TRIALS_OF_A_ROUND: usize = 16;
/// Gain that ends a round, as a fraction of the cost, while rounds change an unknown much: the minimum with variances from elsewhere
/// is none.
const GAIN_OF_A_ROUND: f64 = 1e-3;
/// Change of every unknown, relative to its value or to what changes the residual by its standard deviation, below which the
/// estimate has come to rest: that of a round, or that which is to be expected of the next.
const SETTLED: f64 = 1e-5;
/// Rounds in which a search that leads somewhere more than halves the cost …
const ROUNDS_OF_A_FALL: usize = 3;
/// … as long as an unknown still changes by more than this part of it.
const FAR: f64 = 1e-1;

/// The estimate from `start`: `exact` and `whole` are the same lines without the errors of the substructures and with them. Where
/// the noise is not stated, its level follows from what is left.
pub(super) fn robust(
    exact: &Objective<'_>,
    whole: &Objective<'_>,
    noise: &Noise,
    start: &DVector<f64>,
) -> Option<Estimate> {
    let first = first_levels(noise);
    let mut unknowns = start.clone();
    let mut damping = Damping::first(exact);
    let mut converged = false;
    let mut costs: Vec<f64> = Vec::new();
    let mut moved_before = f64::INFINITY;
    let mut rest = None;
    for _ in 0..ROUNDS {
        let weights = whole.marginal_weights(first, &unknowns)?;
        let state = exact.at(&weights, unknowns.clone(), None)?;
        let is_far = moved_before > FAR;
        let control = Control {
            negligible_gain: if is_far {
                GAIN_OF_A_ROUND
            } else {
                GAIN_BEFORE_RENEWAL
            },
            damping,
            most: TRIALS_OF_A_ROUND,
        };
        let end = levenberg_marquardt(exact, &weights, &Free, &unknowns, state, control);
        let state = end.state;
        damping = end.damping;
        let moved = relative_change(&unknowns, &state.unknowns, &end.scale);
        unknowns.clone_from(&state.unknowns);
        let cost = state.normal.cost;
        rest = Some((state, weights));
        // the changes of rounds near the end fall by the same factor each
        let next = moved * (moved / moved_before).min(1.0);
        if !is_far && end.settled && next < SETTLED {
            converged = true;
            break;
        }
        moved_before = moved;
        costs.push(cost);
        let before = costs.len().checked_sub(ROUNDS_OF_A_FALL + 1);
        if moved > FAR && before.is_some_and(|before| cost > 0.5 * costs[before]) {
            break;
        }
    }
    let (state, weights) = rest?;
    let levels = if noise.is_stated() {
        first
    } else {
        noise.levels(whole.level(noise, &whole.unweighted(unknowns, None), 1.0)?)
    };
    let (cost, measurements) = (state.normal.cost, exact.measurements());
    Some(Estimate {
        cost,
        misfit: misfit(noise, cost, log_variances(&weights), measurements),
        standing: None,
        measurements,
        degrees_of_freedom: (2 * measurements).saturating_sub(start.len()),
        information: state.normal.matrix,
        unknowns: state.unknowns,
        levels,
        converged,
        unrest: 0.0,
        corrections: Corrections::default(),
    })
}
