//! The joint together with the errors of the set-up.
//!
//! Beside noise of a thousandth, sensors a millimetre off leave residuals of a half, and the search for both goes astray. So
//! the noise is taken as large as the residuals at first, and let down in steps: the errors that matter most come first, and
//! each step begins near its end.

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

/// Noise of a step, in parts of that of the step before, at most.
const LET_DOWN: f64 = 0.3;

/// Steps after which residuals that do not follow the noise will not.
const PATIENCE: usize = 5;

/// Squares over numbers that do not follow it, and those that noise and the budget explain.
const LAGGING: f64 = 3.0;
const EXPLAINED: f64 = 1.05;

/// Likewise of the errors of the set-up.
const EXPECTED: f64 = 1.3;

/// A search that has come as low as the lowest, up to this part.
const AS_LOW: f64 = 1e-3;

/// The joint and the errors of the set-up, at [`LINES_MAX`] lines; how many starts were tried and how many came to the same
/// minimum. None is tried after one that noise explains, where its level is stated, after one that leaves nothing, or after two that
/// agree.
pub(crate) fn together(
    problem: &Problem,
    level: &Deviations,
    is_stated: bool,
) -> Result<(Fit, [usize; 2]), SpatialError> {
    let thin = problem.thinned(LINES);
    let mut starts: Vec<(f64, Unknowns)> = starts(&thin, level)?
        .filter_map(|start| Some((cost(&thin, &start, level).ok()?, start)))
        .collect();
    starts.sort_by(|(one, _), (other, _)| one.total_cmp(other));
    let explained = |fit: &Fit| {
        let errors = squares_of_errors(&thin, &fit.unknowns);
        let numbers = thin.numbers() as f64;
        fit.cost < NOTHING * numbers
            || is_stated
                && fit.cost < EXPLAINED * numbers
                && errors < EXPECTED * problem.error_count() as f64
    };
    let mut best: Option<Fit> = None;
    let (mut tried, mut agreeing) = (0, 0);
    for (residual, start) in starts {
        tried += 1;
        let Ok(fit) = let_down(&thin, start, residual, level) else {
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
        if agreeing > 1 || best.as_ref().is_some_and(explained) {
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
    let mut unknowns = start;
    let mut factor = (residual / problem.numbers() as f64).sqrt();
    for step in 1.. {
        if factor <= 1.0 {
            break;
        }
        let own: Deviations = level.iter().map(|level| factor * level).collect();
        let fit = Fit::of(problem, unknowns, &own, Effort::Coarse)?;
        unknowns = fit.unknowns;
        if step >= PATIENCE && lags(problem, fit.cost) {
            return Ok(Fit {
                cost: cost(problem, &unknowns, level)?,
                unknowns,
                has_converged: false,
            });
        }
        factor *= (fit.cost / problem.numbers() as f64).sqrt().min(LET_DOWN);
    }
    Fit::of(problem, unknowns, level, Effort::Near)
}
