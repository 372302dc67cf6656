//! One search beside errors of the set-up: with noise as large as the residuals at first.

use crate::error::SpatialError;
use crate::fit::{Effort, Fit};
use crate::normal::{Deviations, cost};
use crate::problem::{Problem, Unknowns};

/// Noise of a step, in parts of the residuals of the step before.
const LET_DOWN: f64 = 0.3;

/// Residuals of a step that hardly shrinks them, in parts of those before, and such steps one after the other that are enough.
const STALLED: f64 = 0.8;
const PATIENCE: usize = 2;

/// From one start, whose squares are known.
pub(super) fn let_down(
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
