//! The joint, and the errors of the set-up where there are any, beside noise of the substructures: from several starts at a few
//! lines, then at more.

use super::Beside;
use crate::error::SpatialError;
use crate::fit::{Effort, Fit};
use crate::normal::{Deviations, squares_of_errors};
use crate::problem::{Problem, Unknowns};
use crate::search::{BY_CHANCE, SEARCHED};
use crate::starts::starts;

/// Lines of the search from several starts.
const LINES: usize = 12;

/// Noise of a step, in parts of that of the step before, at most; and steps after which squares that do not follow it will not.
const LET_DOWN: f64 = 0.3;
const PATIENCE: usize = 6;
const LAGGING: f64 = 3.0;

/// Squares over numbers that noise explains, and those of the errors of the set-up that the budget does.
const EXPLAINED: f64 = 1.2;
const EXPECTED: f64 = 1.5;

/// A search that has come as low as the lowest, up to this part.
const AS_LOW: f64 = 1e-3;

/// The lowest of the searches at a few lines, how many starts were tried and how many came as low. None is tried after one that
/// noise and budget explain as chance has it, or after two that agree on what is not far above.
pub(crate) fn searched_beside(
    problem: &Problem,
    level: &Deviations,
    noise: [f64; 2],
) -> Result<(Fit, [usize; 2]), SpatialError> {
    let likely = problem.likely_errors()?;
    let known = problem.thinned(SEARCHED).with_errors(&likely)?.smoothed()?;
    let begun: Vec<Unknowns> = starts(&known, level)?
        .map(|joint| joint.beside(&likely))
        .collect();
    let first = begun.first().ok_or(SpatialError::NoStart)?;
    // the lines at which noise moves least, as far as the joint is known
    let some = problem.thinned(10 * LINES);
    let steady = Beside::of(&some, level, noise, first)?.steadiest(first)?;
    let few = some.with_lines(&steady).thinned(LINES);
    let mut squares = Beside::of(&few, level, noise, first)?;
    let numbers = squares.numbers() as f64;
    let errors = problem.error_count() as f64;
    let mut starts: Vec<(f64, Unknowns)> = (begun.into_iter())
        .filter_map(|start| Some((squares.cost_as_measured(&start).ok()?, start)))
        .collect();
    starts.sort_by(|(one, _), (other, _)| one.total_cmp(other));
    let explained = |fit: &Fit| {
        fit.cost < EXPLAINED * numbers
            && squares_of_errors(problem, &fit.unknowns) <= EXPECTED * errors
    };
    // χ² of ν numbers is ν ± √(2 ν)
    let by_chance = numbers + BY_CHANCE * (2.0 * numbers).sqrt();
    let mut best: Option<Fit> = None;
    let (mut tried, mut agreeing) = (0, 0);
    for (residual, start) in starts {
        tried += 1;
        let Ok(fit) = let_down(&mut squares, start, residual) else {
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
        let is_enough = |best: &Fit| explained(best) && (best.cost < by_chance || agreeing > 1);
        if best.as_ref().is_some_and(is_enough) {
            break;
        }
    }
    let mut best = best.ok_or(SpatialError::NoStart)?;
    best.has_converged &= explained(&best) || 2 * agreeing > tried;
    Ok((best, [tried, agreeing]))
}

/// From one start, whose squares are known: with noise as large as they are at first, which is let down to what it is.
fn let_down(squares: &mut Beside<'_>, start: Unknowns, residual: f64) -> Result<Fit, SpatialError> {
    let numbers = squares.numbers() as f64;
    squares.begin();
    let mut unknowns = start;
    let mut factor = (residual / numbers).sqrt();
    for step in 1.. {
        if factor <= 1.0 {
            break;
        }
        squares.raise(factor);
        let fit = Fit::by(squares, unknowns, Effort::Coarse)?;
        unknowns = fit.unknowns;
        if step >= PATIENCE && fit.cost > LAGGING * numbers {
            squares.raise(1.0);
            return Ok(Fit {
                cost: fit.cost * factor.powi(2),
                unknowns,
                has_converged: false,
            });
        }
        factor *= (fit.cost / numbers).sqrt().min(LET_DOWN);
    }
    squares.raise(1.0);
    Fit::by(squares, unknowns, Effort::Full)
}
