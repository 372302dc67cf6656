//! The joints alone, searched from several starts: some lead to other minima.

use bolted_joint_wanted::{Pieces, step};

use crate::error::SpatialError;
use crate::fit::{Effort, Fit};
use crate::normal::{Deviations, Normal};
use crate::problem::Problem;
use crate::rivals::{as_good, rivals};
use crate::starts::{Starts, starts};

/// Lines that are searched from several starts; all are used from where these lead.
pub(crate) const SEARCHED: usize = 60;

/// A search that has come as low as the lowest, up to this part; and beside errors of the set-up, which leave flat valleys.
const AS_LOW: f64 = 1e-6;
pub(crate) const AS_LOW_BESIDE_ERRORS: f64 = 1e-3;

/// Standard deviations of χ² up to which chance explains it.
pub(crate) const BY_CHANCE: f64 = 3.0;

/// Likewise up to which it clearly does, though there may be other joints.
pub(crate) const CLEARLY: f64 = 1.0;

/// Cost, in parts of the count of numbers, below which nothing is left that another minimum could be lower by.
pub(crate) const NOTHING: f64 = 1e-9;

/// Searches after which functions of which all leave so large a part are taken to have no joint, where no level is stated.
const PATIENCE: usize = 8;
const HOPELESS: f64 = 0.2;

/// Searches that crept far above what noise explains and are followed to the end, the lowest ones, where none was better.
const FOLLOWED: usize = 3;

/// What searches from several starts came to.
pub(crate) struct Searched {
    /// The lowest.
    pub(crate) fit: Fit,
    /// How many starts were tried, and how many came as low.
    pub(crate) starts: [usize; 2],
    /// Others that explain the functions nearly as well, where that may be.
    pub(crate) rivals: usize,
}

/// How many starts are followed.
pub(crate) enum Extent<'f> {
    /// The likely ones: where they come to nothing, something else may be wrong.
    First,
    /// The likely ones: where they come to nothing, what came of them is told.
    Likely,
    /// As many as it takes; where the likely ones come to nothing, unless this finds something else.
    Unless(&'f mut dyn FnMut() -> bool),
}

/// The lowest of the searches. Beyond starts that are in doubt, no other is tried after one that noise explains, where its level is
/// stated, or, where it is not, after two that agree or one that leaves nothing. Where noise does not explain the lowest, most of
/// those that were followed to the end have to lead there: it may be another minimum.
pub(crate) fn searched(
    problem: &Problem,
    level: &Deviations,
    is_stated: bool,
) -> Result<Searched, SpatialError> {
    let numbers = problem.numbers() as f64;
    let explained = by_chance(problem.numbers(), BY_CHANCE);
    // without a stated level the lowest so far says what is far above
    let promising = |ended: &[Fit]| match is_stated {
        true => explained,
        false => lowest(ended),
    };
    let leaves_nothing = |fit: &Fit| fit.has_converged && fit.cost < NOTHING * numbers;
    let is_explained =
        |fit: &Fit| leaves_nothing(fit) || fit.has_converged && is_stated && fit.cost < explained;
    let mut ended: Vec<Fit> = Vec::new();
    let mut crept: Vec<Fit> = Vec::new();
    let mut tried = 0;
    let Starts { all, in_doubt } = starts(problem, level)?;
    let step = step("searches", Pieces::AtMost(all.size_hint().1.unwrap_or(0)));
    for start in all {
        tried += 1;
        let effort = Effort::Promising(promising(&ended));
        let fit = Fit::of(problem, start, level, effort);
        step.done();
        let Ok(fit) = fit else {
            continue;
        };
        match fit.has_converged || !is_stated {
            true => ended.push(fit),
            false => crept.push(fit),
        }
        let has_agreed = !is_stated && agreeing(&ended, numbers) > 1;
        // the level is the functions' own
        let is_hopeless =
            !is_stated && tried >= PATIENCE && lowest(&ended) > HOPELESS.powi(2) * numbers;
        let is_enough = has_agreed || is_hopeless || ended.iter().any(is_explained);
        if ended.last().is_some_and(&leaves_nothing) || tried >= in_doubt && is_enough {
            break;
        }
    }
    let is_as_good = |fit: &Fit, lowest: f64| in_doubt > 0 && fit.cost <= as_good(lowest, numbers);
    // one that creeps may be on its way to the lowest
    let least = lowest(&ended).min(lowest(&crept));
    for fit in crept.extract_if(.., |fit| is_as_good(fit, least)) {
        ended.extend(Fit::from(problem, fit.unknowns, level));
    }
    if !ended.iter().any(is_explained) {
        crept.sort_by(|one, other| one.cost.total_cmp(&other.cost));
        for fit in crept.drain(..FOLLOWED.min(crept.len())) {
            ended.extend(Fit::from(problem, fit.unknowns, level));
        }
    }
    let agreeing = agreeing(&ended, numbers);
    let rivals = match in_doubt {
        0 => 0,
        _ => rivals(problem, &ended, as_good(lowest(&ended), numbers), |best| {
            // without a stated level the residuals say it
            let own = if is_stated {
                1.0
            } else {
                (best.cost / numbers).sqrt()
            };
            let level = level.iter().map(|level| own * level).collect();
            Ok(Normal::of(problem, &best.unknowns, &level)?.information)
        })?,
    };
    let is_known = ended.iter().any(is_explained)
        || match is_stated {
            true => 2 * agreeing > ended.len(),
            false => agreeing > 1,
        };
    // one that has come lower on its way says that the others are not the lowest
    let all = ended.into_iter().chain(crept);
    let best = all.min_by(|one, other| one.cost.total_cmp(&other.cost));
    let mut best = best.ok_or(SpatialError::NoStart)?;
    best.has_converged &= is_known;
    Ok(Searched {
        fit: best,
        starts: [tried, agreeing],
        rivals,
    })
}

/// χ² of so many numbers up to which chance explains it, with so many of its standard deviations.
pub(crate) fn by_chance(numbers: usize, deviations: f64) -> f64 {
    // χ² of ν numbers is ν ± √(2 ν)
    numbers as f64 + deviations * (2.0 * numbers as f64).sqrt()
}

fn lowest(fits: &[Fit]) -> f64 {
    let costs = fits.iter().map(|fit| fit.cost);
    costs.fold(f64::INFINITY, f64::min)
}

/// How many came as low as the lowest.
fn agreeing(fits: &[Fit], numbers: f64) -> usize {
    let lowest = lowest(fits);
    let as_low = AS_LOW * (lowest + numbers);
    let of_them = fits.iter().filter(|fit| fit.cost <= lowest + as_low);
    of_them.count()
}

/// How many searches beside errors of the set-up came as low as the lowest, with one more that came to this cost.
pub(crate) fn agreeing_with(agreeing: usize, lowest: f64, cost: f64) -> usize {
    match cost {
        own if own > lowest * (1.0 + AS_LOW_BESIDE_ERRORS) => agreeing,
        own if own >= lowest * (1.0 - AS_LOW_BESIDE_ERRORS) => agreeing + 1,
        _ => 1,
    }
}
