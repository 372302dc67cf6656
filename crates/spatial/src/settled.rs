//! The estimate where the substructures are exact: at all lines that it takes, with the noise that its residuals show.

use std::borrow::Cow;

use crate::error::SpatialError;
use crate::fit::Fit;
use crate::level::of_residuals;
use crate::normal::{Deviations, cost};
use crate::problem::Problem;
use crate::search::BY_CHANCE;
use crate::together::LINES_MAX;
use crate::uneven;

/// Rounds in which the level of the noise follows the residuals.
const ROUNDS: usize = 5;

/// Rounds in which noise follows the values of the functions that were found, and parts of it that are as good as each other.
const UNEVEN: usize = 3;
const ALIKE: f64 = 0.003;

/// Levels that a round changes by less than this part are as they are.
const SETTLED: f64 = 1e-5;

/// Lines of the estimate of joint and set-up together, and twice as many while it does not hold at the others: what few lines leave
/// open of the set-up moves resonances.
const MANY: usize = 300;

/// An estimate, with what it is of.
pub(crate) struct Settled<'p> {
    /// At all lines, with noise as uneven as it was found.
    pub(crate) problem: Cow<'p, Problem>,
    pub(crate) best: Fit,
    /// At the lines of the estimate.
    pub(crate) estimated: Problem,
    /// Of each function's noise.
    pub(crate) level: Deviations,
    /// Part of the noise that goes with the values of the functions.
    pub(crate) of_values: f64,
}

impl<'p> Settled<'p> {
    /// From a fit at the first level of the noise, which is the last one where it is stated.
    pub(crate) fn of(
        problem: &'p Problem,
        fit: Fit,
        first: (&Deviations, bool),
        rms: &Deviations,
    ) -> Result<Self, SpatialError> {
        let mut problem = Cow::Borrowed(problem);
        let mut end = at_more_lines(&problem, fit, first, rms)?;
        let mut of_values = 0.0;
        // where coherence tells the noise of each line, residuals are not asked
        let rounds = if problem.is_told() { 0 } else { UNEVEN };
        for _ in 0..rounds {
            let told = match end.best.has_converged {
                true => uneven::of(&problem, &end.best.unknowns)?,
                false => None,
            };
            let Some(told) = told.filter(|told| (told - of_values).abs() > ALIKE) else {
                break;
            };
            of_values = told;
            problem = Cow::Owned(problem.with_uneven_noise(told, &end.best.unknowns)?);
            let again = match problem.error_count() {
                0 => end.best.on(&problem, &end.level)?,
                _ => end.best,
            };
            end = at_more_lines(&problem, again, first, rms)?;
        }
        let AtMoreLines {
            best,
            estimated,
            level,
        } = end;
        Ok(Self {
            problem,
            best,
            estimated,
            level,
            of_values,
        })
    }
}

/// An estimate, the lines of it, and the level of each function's noise.
struct AtMoreLines {
    best: Fit,
    estimated: Problem,
    level: Deviations,
}

/// The estimate at as many lines as it takes, from one at fewer.
fn at_more_lines(
    problem: &Problem,
    mut best: Fit,
    (first, is_stated): (&Deviations, bool),
    rms: &Deviations,
) -> Result<AtMoreLines, SpatialError> {
    let mut level = first.clone();
    let mut estimated = problem.clone();
    if problem.error_count() > 0 {
        // where nothing was found, there is nothing to be told better
        estimated = problem.thinned(if best.has_converged { MANY } else { LINES_MAX });
        if best.has_converged {
            best = best.on(&estimated, &level)?;
        }
    }
    loop {
        if !is_stated {
            best = with_its_level(problem, best, &estimated, rms, &mut level)?;
        }
        let used = estimated.frequency_hz.len();
        let is_all = used >= problem.frequency_hz.len();
        if is_all || !best.has_converged || holds(problem, &estimated, &best, &level)? {
            break;
        }
        estimated = problem.thinned(2 * used);
        best = best.on(&estimated, &level)?;
    }
    Ok(AtMoreLines {
        best,
        estimated,
        level,
    })
}

/// The estimate and a level of each function's noise by what it leaves, in rounds.
fn with_its_level(
    problem: &Problem,
    mut best: Fit,
    estimated: &Problem,
    rms: &Deviations,
    level: &mut Deviations,
) -> Result<Fit, SpatialError> {
    if problem.error_count() > 0 && !best.has_converged {
        *level = of_residuals(problem, &best.unknowns, rms)?;
        return Ok(best);
    }
    for _ in 0..ROUNDS {
        let next = of_residuals(problem, &best.unknowns, rms)?;
        let pairs = std::iter::zip(&next, &*level);
        let is_settled = pairs
            .map(|(new, old)| (new / old - 1.0).abs())
            .all(|own| own < SETTLED);
        *level = next;
        best = best.on(estimated, level)?;
        if is_settled {
            break;
        }
    }
    Ok(best)
}

/// Whether what was found at some lines leaves no more at all of them, but for chance.
fn holds(
    problem: &Problem,
    estimated: &Problem,
    best: &Fit,
    level: &Deviations,
) -> Result<bool, SpatialError> {
    let numbers = [estimated, problem].map(|own| own.numbers() as f64);
    let at_all = cost(problem, &best.unknowns, level)? / numbers[1];
    // χ² of ν numbers is ν ± √(2 ν)
    let chance = BY_CHANCE * (2.0 / numbers[0]).sqrt();
    Ok(at_all <= (1.0 + chance) * best.cost / numbers[0])
}
