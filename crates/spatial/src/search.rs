//! The joint alone, searched from several starts: some lead to other minima.

use crate::error::SpatialError;
use crate::fit::Fit;
use crate::normal::Deviations;
use crate::problem::Problem;
use crate::starts::starts;

/// Lines that are searched from several starts; all are used from where these lead.
pub(crate) const SEARCHED: usize = 60;

/// A search that has come as low as the lowest, up to this part.
const AS_LOW: f64 = 1e-6;

/// The lowest of the searches, how many starts were tried and how many came as low. When a second one has, the others are not
/// tried.
pub(crate) fn searched(
    problem: &Problem,
    level: &Deviations,
) -> Result<(Fit, usize, usize), SpatialError> {
    let slack = 2.0 * (problem.observed.len() * problem.frequency_hz.len()) as f64;
    let mut best: Option<Fit> = None;
    let (mut tried, mut agreeing) = (0, 0);
    for start in starts(problem)? {
        tried += 1;
        let Ok(fit) = Fit::from(problem, start, level) else {
            continue;
        };
        let lowest = best.as_ref().map_or(f64::INFINITY, |best| best.cost);
        let as_low = AS_LOW * (lowest.min(fit.cost) + slack);
        agreeing = match fit.cost - lowest {
            above if above > as_low => agreeing,
            above if above >= -as_low => agreeing + 1,
            _ => 1,
        };
        if fit.cost < lowest {
            best = Some(fit);
        }
        if agreeing > 1 {
            break;
        }
    }
    Ok((best.ok_or(SpatialError::NoStart)?, tried, agreeing))
}
