//! The joints alone, searched from several starts: some lead to other minima.

use crate::error::SpatialError;
use crate::fit::Fit;
use crate::normal::Deviations;
use crate::problem::Problem;
use crate::starts::starts;

/// Lines that are searched from several starts; all are used from where these lead.
pub(crate) const SEARCHED: usize = 60;

/// A search that has come as low as the lowest, up to this part.
const AS_LOW: f64 = 1e-6;

/// Standard deviations of χ² up to which chance explains it.
const BY_CHANCE: f64 = 3.0;

/// Cost, in parts of the count of numbers, below which nothing is left that another minimum could be lower by.
pub(crate) const NOTHING: f64 = 1e-9;

/// The lowest of the searches, how many starts were tried and how many came as low. The others are not tried after one that noise
/// explains, where its level is stated, or, where it is not, after two that agree or one that leaves nothing. Where noise does not
/// explain the lowest, most of the starts have to lead there: it may be another minimum.
pub(crate) fn searched(
    problem: &Problem,
    level: &Deviations,
    is_stated: bool,
) -> Result<(Fit, [usize; 2]), SpatialError> {
    let numbers = problem.numbers() as f64;
    // χ² of ν numbers is ν ± √(2 ν)
    let explained = numbers + BY_CHANCE * (2.0 * numbers).sqrt();
    let mut best: Option<Fit> = None;
    let (mut tried, mut agreeing, mut is_explained) = (0, 0, false);
    for start in starts(problem, level)? {
        tried += 1;
        let Ok(fit) = Fit::from(problem, start, level) else {
            continue;
        };
        let lowest = best.as_ref().map_or(f64::INFINITY, |best| best.cost);
        let as_low = AS_LOW * (lowest.min(fit.cost) + numbers);
        agreeing = match fit.cost - lowest {
            above if above > as_low => agreeing,
            above if above >= -as_low => agreeing + 1,
            _ => 1,
        };
        let leaves_nothing = fit.cost < NOTHING * numbers;
        is_explained |= fit.has_converged && (leaves_nothing || is_stated && fit.cost < explained);
        if fit.cost < lowest {
            best = Some(fit);
        }
        if is_explained || (agreeing > 1 && !is_stated) {
            break;
        }
    }
    let mut best = best.ok_or(SpatialError::NoStart)?;
    best.has_converged &= is_explained
        || match is_stated {
            true => 2 * agreeing > tried,
            false => agreeing > 1,
        };
    Ok((best, [tried, agreeing]))
}
