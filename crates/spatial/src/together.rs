//! The joint together with the errors of the set-up.
//!
//! Beside noise of a thousandth, sensors a millimetre off leave residuals of a half, and the search for both goes astray. So
//! the noise is taken as large as the residuals at first, and let down as they shrink: the errors that matter most come first, and
//! each step begins near its end. Starts are those beside the errors that each structure tells by itself, and those without
//! errors: where one kind leads astray, the other one often does not.

use crate::error::SpatialError;
use crate::fit::{Effort, Fit};
use crate::normal::{Deviations, cost, squares_of_errors};
use crate::problem::{Problem, Unknowns};
use crate::search::NOTHING;
use crate::starts::starts;

/// Lines of the search from several starts: thousands of numbers, for hundreds of unknowns.
const LINES: usize = 12;

/// Lines of the estimate. More would tell the errors of the set-up little better.
pub(crate) const LINES_MAX: usize = 60;

/// Noise of a step, in parts of the residuals of the step before.
const LET_DOWN: f64 = 0.3;

/// Residuals of a step that hardly shrinks them, in parts of those before, and such steps one after the other that are enough.
const STALLED: f64 = 0.8;
const PATIENCE: usize = 2;

/// Squares over numbers that do not follow it, and those that noise and the budget explain.
const LAGGING: f64 = 3.0;
const EXPLAINED: f64 = 1.05;

/// Likewise of the errors of the set-up.
const EXPECTED: f64 = 1.3;

/// A search that has come as low as the lowest, up to this part.
const AS_LOW: f64 = 1e-3;

/// Stiffness in parts of the structures' own from which on a joint is as good as rigid: a search may have lost it there.
const RIGID: f64 = 1e4;

/// The joint and the errors of the set-up, at [`LINES_MAX`] lines; how many searches there were, two from each start, and how many
/// came to the same minimum. None follows one that noise explains, where its level is stated, one that leaves nothing, or two that
/// agree on what is not far above the noise.
pub(crate) fn together(
    problem: &Problem,
    level: &Deviations,
    is_stated: bool,
) -> Result<(Fit, [usize; 2]), SpatialError> {
    let likely = problem.likely_errors()?;
    let known = problem.thinned(LINES_MAX).with_errors(&likely)?;
    let balance = known.balance()?;
    // on curves along which the functions are nearly straight, and straight on: each finds what the other one misses
    let thin = problem.thinned(LINES);
    let ways = [Some(balance.clone()), None].map(|balance| Problem {
        balance,
        ..thin.clone()
    });
    let lowest_first = |starts: &mut dyn Iterator<Item = Unknowns>| {
        let known = starts.filter_map(|start| Some((cost(&thin, &start, level).ok()?, start)));
        let mut sorted: Vec<(f64, Unknowns)> = known.collect();
        sorted.sort_by(|(one, _), (other, _)| one.total_cmp(other));
        sorted
    };
    let beside = lowest_first(&mut starts(&known, level)?.map(|joint| joint.beside(&likely)));
    let alone = lowest_first(&mut starts(&thin, level)?);
    let numbers = thin.numbers() as f64;
    let explained = |fit: &Fit| {
        let errors = squares_of_errors(&thin, &fit.unknowns);
        fit.cost < NOTHING * numbers
            || is_stated
                && fit.cost < EXPLAINED * numbers
                && errors < EXPECTED * problem.error_count() as f64
                && !is_rigid(&thin, &balance, &fit.unknowns)
    };
    let mut best: Option<Fit> = None;
    let (mut tried, mut agreeing) = (0, 0);
    let [curved, straight] = &ways;
    let tries = (0..beside.len().max(alone.len())).flat_map(|i| {
        let ways = [
            (curved, &beside),
            (straight, &alone),
            (straight, &beside),
            (curved, &alone),
        ];
        ways.map(|(way, starts)| starts.get(i).map(|start| (way, start)))
    });
    let tries = tries.flatten();
    for (way, (residual, start)) in tries {
        tried += 1;
        let Ok(fit) = let_down(way, start.clone(), *residual, level) else {
            continue;
        };
        let lowest = best.as_ref().map_or(f64::INFINITY, |best| best.cost);
        agreeing = match fit.cost {
            own if own > lowest * (1.0 + AS_LOW) => agreeing,
            own if own >= lowest * (1.0 - AS_LOW) => agreeing + 1,
            _ => 1,
        };
        if fit.cost < lowest {
            best = Some(fit);
        }
        // two that are far above the noise agree on where a search gets stuck
        let is_low = |best: &Fit| !is_stated || !lags(&thin, best.cost);
        if best
            .as_ref()
            .is_some_and(|best| explained(best) || agreeing > 1 && is_low(best))
        {
            break;
        }
    }
    let best = best.ok_or(SpatialError::NoStart)?;
    // a minimum that nothing confirms may be another one
    let is_confirmed = agreeing > 1 || explained(&best);
    // what nothing explains has no bottom that is worth the way there
    let effort = match lags(&thin, best.cost) && !is_confirmed {
        true => Effort::Coarse,
        false => Effort::Full,
    };
    let lines = problem.thinned(LINES_MAX);
    let mut fit = Fit::of(&lines, best.unknowns, level, effort)?;
    fit.has_converged &= is_confirmed;
    Ok((fit, [tried, agreeing]))
}

/// Whether squares are many more than noise leaves.
fn lags(problem: &Problem, cost: f64) -> bool {
    cost > LAGGING * problem.numbers() as f64
}

/// From one start, whose squares are known.
fn let_down(
    problem: &Problem,
    start: Unknowns,
    residual: f64,
    level: &Deviations,
) -> Result<Fit, SpatialError> {
    let numbers = problem.numbers() as f64;
    let mut unknowns = start;
    let mut left = (residual / numbers).sqrt();
    let mut factor = left;
    let mut stalled = 0;
    while factor > 1.0 {
        let own: Deviations = level.iter().map(|level| factor * level).collect();
        let fit = Fit::of(problem, unknowns, &own, Effort::Coarse)?;
        unknowns = fit.unknowns;
        let now = factor * (fit.cost / numbers).sqrt();
        stalled = if now > STALLED * left { stalled + 1 } else { 0 };
        if stalled >= PATIENCE {
            return Ok(Fit {
                cost: cost(problem, &unknowns, level)?,
                unknowns,
                has_converged: false,
            });
        }
        left = now;
        factor = LET_DOWN * left;
    }
    Fit::of(problem, unknowns, level, Effort::Near)
}

/// Whether a joint is as good as rigid in a motion, beside the structures' own stiffnesses.
fn is_rigid(problem: &Problem, balance: &[f64], unknowns: &Unknowns) -> bool {
    let values = unknowns.0.as_slice();
    (problem.links.sought_matrices(values)).is_ok_and(|[stiffness, _]| {
        let own = stiffness.diagonal();
        let mut pairs = own.iter().zip(balance);
        pairs.any(|(own, balance)| own.abs() > RIGID * balance)
    })
}
