//! Which start leads to the joint: candidates that the data themselves give, then a grid, until what is left is noise.

use std::sync::Arc;

use bolted_joint_systematic::FAR;
use bolted_joint_wanted::{Pieces, step};
use nalgebra::DVector;

use super::assessment::{Assessment, assess};
use super::data::{Data, Used};
use super::estimator::{Estimate, Free, estimate};
use super::finals::{End, Finals, finalists, finalists_of_own_lines};
use super::layout::Place;
use super::noise::Noise;
use super::objective::Objective;
use super::strip::ENTRIES_OF_ONE;
use super::trials::{SAME_MISFIT, best_trials, same, try_starts};

/// Starts of the grid between two looks at whether the fit is beyond doubt.
pub(super) const STARTS_AT_A_TIME: usize = 4;

/// How far to search.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Effort {
    /// Until the fit is beyond doubt, or the grid is exhausted.
    Whole,
    /// The same, unless the first starts leave so much that only errors of the set-up can explain it: the estimate with these has a
    /// search of its own.
    BesideBudget,
    /// From starts that come from the estimate of another joint model.
    Related,
}

/// What the search came to.
#[derive(Clone)]
pub(super) struct Found {
    pub(super) estimate: Estimate,
    pub(super) assessment: Assessment,
    /// Starts tried.
    pub(super) tried: usize,
    /// Starts that led to the estimate.
    pub(super) agreeing: usize,
    /// The lines that it rests on.
    pub(super) used: Arc<Used>,
}

impl Found {
    /// The same, the corrections of its estimate given up for the memory that they take.
    pub(super) fn without_corrections(self) -> Self {
        Self {
            estimate: self.estimate.without_corrections(),
            ..self
        }
    }
}

/// The best estimate from `first` and from the search's own starts, on the lines that are `used`, or else on those that the best
/// start can use; `Err` with the number of starts if there is none.
pub(super) fn best(
    data: &Data<'_>,
    entries: &[Place],
    noise: &Noise,
    first: Vec<DVector<f64>>,
    effort: Effort,
    used: Option<&Arc<Used>>,
) -> Result<Found, usize> {
    let mut candidates = first;
    let guesses = [None, candidates.last().cloned()];
    // the best one comes first: with another that agrees it may be enough
    if !candidates.is_empty() {
        candidates.rotate_right(1);
    }
    candidates.extend(data.thinned.linear_starts(entries, &guesses));
    let mut ways = Vec::new();
    let mut tried = match effort {
        Effort::Whole => candidates.len().min(ENOUGH),
        Effort::BesideBudget | Effort::Related => candidates.len(),
    };
    let searches = step("searches", Pieces::AtMost(candidates.len()));
    let mut trials = try_starts(data, entries, noise, &candidates[..tried], &mut ways);
    searches.are_done(tried);
    if tried < candidates.len() && !agree(&trials, noise) {
        let others = &candidates[tried..];
        trials.extend(try_starts(data, entries, noise, others, &mut ways));
        searches.are_done(others.len());
        tried = candidates.len();
    }
    data.give_standings(entries, &mut trials);
    let search = |trials: &[Estimate], known: Option<Finals>| match used {
        Some(used) => Some(finalists(used, entries, noise, trials, known)),
        None => finalists_of_own_lines(data, entries, noise, trials, known),
    };
    let gives_up = effort == Effort::BesideBudget && are_far(&trials, noise);
    if gives_up {
        trials = best_trials(&trials).into_iter().take(1).cloned().collect();
    }
    drop(searches);
    let mut finals = {
        let _step = step("the best at all lines", Pieces::Unknown);
        search(&trials, None)
    };
    if effort != Effort::Related && !gives_up {
        let mut others = candidates.split_off(tried);
        others.extend(data.thinned.grid(entries));
        let searches = step("further searches", Pieces::AtMost(others.len()));
        for part in others.chunks(STARTS_AT_A_TIME) {
            let is_enough = |finals: &Finals| {
                is_certain(&trials, finals) || is_settled(&trials, finals, entries)
            };
            if finals.as_ref().is_some_and(is_enough) {
                break;
            }
            tried += part.len();
            trials.extend(try_starts(data, entries, noise, part, &mut ways));
            data.give_standings(entries, &mut trials);
            finals = search(&trials, finals);
            searches.are_done(part.len());
        }
    }
    let finals = finals.ok_or(tried)?;
    let whole = finals.used.assemblies.objective(entries);
    let best = softest_of_the_best(&finals, &whole, entries).ok_or(tried)?;
    let agreeing = agreeing(&trials, &finals, &best.estimate);
    let mut assessment = best.assessment.clone();
    let estimate = if best.has_corrections {
        best.estimate.clone()
    } else if whole.is_independent() {
        Estimate {
            corrections: whole.no_corrections(),
            ..best.estimate.clone()
        }
    } else {
        let start = &best.estimate.unknowns;
        let followed = estimate(&whole, noise, None, &Free, start, None).ok_or(tried)?;
        if whole.is_of_many_bolts() {
            assessment = assess(&whole, &followed, noise).ok_or(tried)?;
        }
        followed
    };
    Ok(Found {
        estimate,
        assessment,
        tried,
        agreeing,
        used: Arc::clone(&finals.used),
    })
}

/// Starts that are enough if they agree on a minimum that leaves noise.
const ENOUGH: usize = 2;
/// Most of the variance of stated noise that it leaves.
const NOISE: f64 = 1.5;

/// Whether all trials ended at one minimum that leaves noise.
fn agree(trials: &[Estimate], noise: &Noise) -> bool {
    let leaves_noise = |trial: &Estimate| {
        let chi = trial.reduced_chi_squared();
        trial.converged && chi.is_some_and(|chi| chi < NOISE)
    };
    let are_one = trials.windows(2).all(|pair| same(&pair[0], &pair[1]));
    noise.is_stated() && trials.len() == ENOUGH && are_one && trials.iter().all(leaves_noise)
}

/// The best estimate; of several that explain the data equally well, as when there are no more numbers than unknowns, the
/// one that is softest beside the substructures.
fn softest_of_the_best<'f>(
    finals: &'f Finals,
    whole: &Objective<'_>,
    entries: &[Place],
) -> Option<&'f End> {
    let lowest = finals.best_first.first()?.rank();
    let (own, _) = whole.substructures(0);
    let size = |end: &&End| -> f64 {
        let places = entries.iter().enumerate();
        let parts = places.map(|(t, place)| {
            let (i, j) = place.first();
            end.estimate.unknowns[t].powi(2) / (own[i] * own[j])
        });
        parts.sum()
    };
    let best = finals.best_first.iter();
    let best = best.filter(|one| one.rank() <= lowest + SAME_MISFIT);
    best.filter_map(|one| one.end.as_ref())
        .min_by(|a, b| size(a).total_cmp(&size(b)))
}

/// Whether no other minimum can be better. With errors in the substructures a wrong one can pass for noise: two starts have
/// to agree.
fn is_certain(trials: &[Estimate], finals: &Finals) -> bool {
    finals.best().is_some_and(|best| {
        let is_at_rest = best.assessment.is_exact || best.estimate.converged;
        is_at_rest && best.assessment.is_certain() && agreeing(trials, finals, &best.estimate) > 1
    })
}

/// Whether no start comes near the data, whose noise is stated.
fn are_far(trials: &[Estimate], noise: &Noise) -> bool {
    let chi = trials.iter().filter_map(Estimate::reduced_chi_squared);
    noise.is_stated() && chi.fold(f64::INFINITY, f64::min) > FAR
}

/// Starts that agree on a minimum of one bolt's joint: where what it leaves is no noise, no other start would find another.
const SETTLED: usize = 8;

/// Whether so many starts agree that more of them would not tell more, although what is left is no noise: errors of the set-up
/// leave more than noise at every minimum.
fn is_settled(trials: &[Estimate], finals: &Finals, entries: &[Place]) -> bool {
    let best = finals.best();
    let is_of_one_bolt =
        entries.len() <= ENTRIES_OF_ONE && entries.iter().all(|place| place.is_single());
    is_of_one_bolt && best.is_some_and(|best| agreeing(trials, finals, &best.estimate) >= SETTLED)
}

/// How many of the trials led to `best`.
fn agreeing(trials: &[Estimate], finals: &Finals, best: &Estimate) -> usize {
    let leads_to_best = |trial: &&Estimate| finals.leads_to(trial, best);
    trials.iter().filter(leads_to_best).count()
}
