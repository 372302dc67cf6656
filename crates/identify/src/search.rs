//! Which start leads to the joint: candidates that the data themselves give, then a grid, until what is left is noise.

use nalgebra::DVector;

use super::assessment::{Assessment, assess};
use super::data::{Data, Misfit};
use super::estimator::{Estimate, Free, estimate, first_levels, minimum};
use super::layout::Place;
use super::noise::Noise;
use super::normal::relative_change;
use super::parallel;
use super::strip::ENTRIES_OF_ONE;

/// Two estimates are the same if their −2 log-likelihoods agree to this …
const SAME_MISFIT: f64 = 2e-3;

/// … and their unknowns to this (with no more numbers than unknowns several joints fit exactly) …
const NEAR_UNKNOWN: f64 = 0.05;

/// … or if their unknowns agree to this, relative to its value or to what would change the residual by its assumed standard
/// deviation: data without noise leave a misfit of rounding alone.
const SAME_UNKNOWN: f64 = 1e-6;

/// Two robust starts have met if their unknowns agree to this.
const MET: f64 = 1e-4;

/// By how much the −2 log-likelihood of an estimate that has not converged must be lower to rank before one that has.
const DECISIVE_MISFIT: f64 = 20.0;

/// How many different estimates from thinned lines are refined on all lines.
const FINALISTS: usize = 4;

/// A minimum whose weighted mean square residual is so many times that of the best is not refined: no resonance between
/// the thinned lines makes up for it.
const COMPARABLE: f64 = 10.0;

/// Starts of the grid between two looks at whether the fit is beyond doubt.
const STARTS_AT_A_TIME: usize = 4;

/// How far to search.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Effort {
    /// Until the fit is beyond doubt, or the grid is exhausted.
    Whole,
    /// From starts that come from the estimate of another joint model.
    Related,
}

/// What the search came to.
#[derive(Clone, Debug)]
pub(super) struct Found {
    pub(super) estimate: Estimate,
    pub(super) assessment: Assessment,
    /// Starts tried.
    pub(super) tried: usize,
    /// Starts that led to the estimate.
    pub(super) agreeing: usize,
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

/// The best estimate from `first` and from the search's own starts; `Err` with the number of starts if there is none.
pub(super) fn best(
    data: &Data,
    entries: &[Place],
    noise: &Noise,
    first: Vec<DVector<f64>>,
    effort: Effort,
) -> Result<Found, usize> {
    let mut candidates = first;
    let guesses = [None, candidates.last().cloned()];
    candidates.extend(data.thinned.linear_starts(entries, &guesses));
    let mut ways = Vec::new();
    let mut trials = try_starts(data, entries, noise, &candidates, &mut ways);
    let mut tried = candidates.len();
    let mut finals = finalists(data, entries, noise, &trials, Vec::new());
    if effort == Effort::Whole {
        for part in data.thinned.grid(entries).chunks(STARTS_AT_A_TIME) {
            if is_certain(&trials, &finals) || is_settled(&trials, &finals, entries) {
                break;
            }
            tried += part.len();
            trials.extend(try_starts(data, entries, noise, part, &mut ways));
            finals = finalists(data, entries, noise, &trials, finals);
        }
    }
    let whole = data.whole.objective(entries);
    let best = softest_of_the_best(&finals, whole.as_ref(), entries).ok_or(tried)?;
    let agreeing = agreeing(&trials, &finals, &best.estimate);
    let estimate = if best.has_corrections {
        best.estimate.clone()
    } else if whole.is_independent() {
        Estimate {
            corrections: whole.no_corrections(),
            ..best.estimate.clone()
        }
    } else {
        let start = &best.estimate.unknowns;
        estimate(whole.as_ref(), noise, None, &Free, start, None).ok_or(tried)?
    };
    Ok(Found {
        estimate,
        assessment: best.assessment.clone(),
        tried,
        agreeing,
    })
}

/// The best estimate; of several that explain the data equally well, as when there are no more numbers than unknowns, the
/// one that is softest beside the substructures.
fn softest_of_the_best<'f>(
    finals: &'f [Final],
    whole: &dyn Misfit,
    entries: &[Place],
) -> Option<&'f End> {
    let lowest = finals.first()?.rank();
    let (own, _) = whole.substructures(0);
    let size = |end: &&End| -> f64 {
        let places = entries.iter().enumerate();
        let parts = places.map(|(t, place)| {
            let (i, j) = place.first();
            end.estimate.unknowns[t].powi(2) / (own[i] * own[j])
        });
        parts.sum()
    };
    let ends = finals.iter().filter_map(|one| one.end.as_ref());
    ends.filter(|end| rank(&end.estimate) <= lowest + SAME_MISFIT)
        .min_by(|a, b| size(a).total_cmp(&size(b)))
}

/// Whether no other minimum can be better. With errors in the substructures a wrong one can pass for noise: two starts have
/// to agree.
fn is_certain(trials: &[Estimate], finals: &[Final]) -> bool {
    let best = finals.first().and_then(|best| best.end.as_ref());
    best.is_some_and(|best| {
        best.assessment.is_certain() && agreeing(trials, finals, &best.estimate) > 1
    })
}

/// Starts that agree on a minimum of one bolt's joint: where what it leaves is no noise, no other start would find another.
const SETTLED: usize = 8;

/// Whether so many starts agree that more of them would not tell more, although what is left is no noise: errors of the set-up
/// leave more than noise at every minimum.
fn is_settled(trials: &[Estimate], finals: &[Final], entries: &[Place]) -> bool {
    let best = finals.first().and_then(|best| best.end.as_ref());
    let is_of_one_bolt =
        entries.len() <= ENTRIES_OF_ONE && entries.iter().all(|place| place.is_single());
    is_of_one_bolt && best.is_some_and(|best| agreeing(trials, finals, &best.estimate) >= SETTLED)
}

/// How many of the trials led to `best`.
fn agreeing(trials: &[Estimate], finals: &[Final], best: &Estimate) -> usize {
    let leads_to_best = |trial: &&Estimate| {
        let known = |one: &Final| {
            let is_best = |end: &End| same(&end.estimate, best);
            same(&one.candidate, trial) && one.end.as_ref().is_some_and(is_best)
        };
        finals.iter().any(known)
    };
    trials.iter().filter(leads_to_best).count()
}

/// A minimum on thinned lines and where it lies on all of them, if it is one there.
struct Final {
    candidate: Estimate,
    end: Option<End>,
}

/// A minimum on all lines.
struct End {
    estimate: Estimate,
    assessment: Assessment,
    has_corrections: bool,
}

impl Final {
    fn without_corrections(self) -> Self {
        let give_up = |end: End| End {
            estimate: end.estimate.without_corrections(),
            has_corrections: false,
            ..end
        };
        Self {
            end: self.end.map(give_up),
            ..self
        }
    }

    fn rank(&self) -> f64 {
        let end = self.end.as_ref();
        end.map_or(f64::INFINITY, |end| rank(&end.estimate))
    }
}

/// A robust start and the estimate to which it led.
struct Way {
    start: DVector<f64>,
    estimate: Option<Estimate>,
}

/// Where each of the starts leads on few lines. `ways` are those gone so far: two starts that meet go on as one.
fn try_starts(
    data: &Data,
    entries: &[Place],
    noise: &Noise,
    starts: &[DVector<f64>],
    ways: &mut Vec<Way>,
) -> Vec<Estimate> {
    let thinned = data.thinned.objective(entries);
    let thinned = thinned.as_ref();
    // Proportional errors while the joint is sought: a level that is estimated far from it would mean nothing.
    let levels = Some(first_levels(thinned, noise));
    let Some(whole) = &data.thinned_whole else {
        let trial = |start: &DVector<f64>| estimate(thinned, noise, levels, &Free, start, None);
        return parallel::map(starts, trial).into_iter().flatten().collect();
    };
    let whole = whole.objective(entries);
    let whole = whole.as_ref();
    let robust = |start: &DVector<f64>| robust_start(thinned, whole, noise, start.clone());
    let starts: Vec<DVector<f64>> = parallel::map(starts, robust)
        .into_iter()
        .flatten()
        .collect();
    let meets = |one: &DVector<f64>, other: &DVector<f64>| {
        relative_change(one, other, &DVector::zeros(one.len())) < MET
    };
    let mut new: Vec<DVector<f64>> = Vec::new();
    for start in &starts {
        let known = ways.iter().map(|way| &way.start).chain(&new);
        if !known.into_iter().any(|known| meets(known, start)) {
            new.push(start.clone());
        }
    }
    let trial = |start: &DVector<f64>| {
        let found = estimate(whole, noise, levels, &Free, start, None)?;
        Some(found.without_corrections())
    };
    let estimates = parallel::map(&new, trial);
    let led = new.into_iter().zip(estimates);
    ways.extend(led.map(|(start, estimate)| Way { start, estimate }));
    let end = |start: &DVector<f64>| {
        let way = ways.iter().find(|way| meets(&way.start, start))?;
        way.estimate.clone()
    };
    starts.iter().filter_map(end).collect()
}

/// The best few different `trials`, on all lines, best first; `known` are those of fewer trials.
fn finalists(
    data: &Data,
    entries: &[Place],
    noise: &Noise,
    trials: &[Estimate],
    mut known: Vec<Final>,
) -> Vec<Final> {
    let mut ranked: Vec<&Estimate> = trials.iter().collect();
    ranked.sort_by(|a, b| rank(a).total_cmp(&rank(b)));
    let mut chosen: Vec<&Estimate> = Vec::new();
    for candidate in ranked {
        let comparable = chosen.first().is_none_or(|best| {
            let residuals = 2.0 * best.measurements as f64;
            candidate.misfit <= best.misfit + residuals * COMPARABLE.ln()
        });
        if chosen.len() < FINALISTS
            && comparable
            && !chosen.iter().any(|known| same(known, candidate))
        {
            chosen.push(candidate);
        }
    }
    let whole = data.whole.objective(entries);
    // Thinned lines may have passed over the resonances that tell two minima apart.
    let mut finals: Vec<Final> = Vec::new();
    // The corrections of all of them would be much memory: those of the last one are kept, most likely the best.
    for candidate in chosen.into_iter().rev() {
        let is_it = |end: &Final| same(&end.candidate, candidate);
        if let Some(place) = known.iter().position(is_it) {
            finals.push(known.swap_remove(place));
            continue;
        }
        finals = finals.into_iter().map(Final::without_corrections).collect();
        known = known.into_iter().map(Final::without_corrections).collect();
        let start = &candidate.unknowns;
        let found = estimate(whole.as_ref(), noise, None, &Free, start, None);
        finals.push(Final {
            candidate: candidate.clone(),
            end: found.and_then(|estimate| {
                let assessment = assess(whole.as_ref(), &estimate, noise)?;
                Some(End {
                    estimate,
                    assessment,
                    has_corrections: true,
                })
            }),
        });
    }
    finals.sort_by(|a, b| a.rank().total_cmp(&b.rank()));
    finals
}

/// Rounds of the start for data with errors in the substructures.
const ROBUST_ROUNDS: usize = 8;

/// An estimate that takes the substructures as measured, but each value of the assembly only for as good as the errors of
/// the substructures let it be computed. Those errors act most at the resonances, where they would bias a plain fit.
pub(super) fn robust_start(
    exact: &dyn Misfit,
    whole: &dyn Misfit,
    noise: &Noise,
    mut start: DVector<f64>,
) -> Option<DVector<f64>> {
    for _ in 0..ROBUST_ROUNDS {
        let state = whole.unweighted(start.clone(), None);
        let weights = whole.marginal_weights(first_levels(whole, noise), &state)?;
        let next = minimum(exact, &weights, &start)?;
        let moved = relative_change(&start, &next, &DVector::zeros(next.len()));
        start = next;
        if moved < SAME_UNKNOWN {
            break;
        }
    }
    Some(start)
}

/// What estimates are ranked by: the −2 log-likelihood, with a handicap for those that have not converged.
fn rank(estimate: &Estimate) -> f64 {
    let handicap = if estimate.converged {
        0.0
    } else {
        DECISIVE_MISFIT
    };
    estimate.misfit + handicap
}

/// Whether two estimates from the same lines are one minimum.
pub(super) fn same(one: &Estimate, other: &Estimate) -> bool {
    let close = |tolerance: f64| {
        (0..one.unknowns.len()).all(|index| {
            let (a, b) = (one.unknowns[index], other.unknowns[index]);
            let scale = one.information[(index, index)]
                .max(f64::MIN_POSITIVE)
                .sqrt()
                .recip();
            (a - b).abs() <= tolerance * a.abs().max(b.abs()).max(scale)
        })
    };
    let equally_good = (one.misfit - other.misfit).abs() <= SAME_MISFIT;
    equally_good && close(NEAR_UNKNOWN) || close(SAME_UNKNOWN)
}
