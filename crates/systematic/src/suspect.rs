//! What is wrong, by name: the causes that the score tests point to are let free one by one, and compared by what they leave.

use super::budget::{Budget, Prior, causes};
use super::cause::Cause;
use super::estimate::{Estimate, Settings, Start, estimate_with};
use super::experiment::Experiment;
use super::far::from_far;
use super::score::{Score, score_tests};

/// Scores below this are chance: of thirty causes that do not act the most telling one is above it once in twenty times.
pub const TELLING: f64 = 10.0;
/// Causes that are let free at most.
const MOST: usize = 6;
/// A score below this part of the largest is not looked at.
const WORTH: f64 = 0.05;
/// χ² per degree of freedom beyond which the joint may have been sought in the wrong place.
const FAR: f64 = 3.0;
/// A cause that is let free has a prior so many times wider than the budget's.
const WIDE: f64 = 30.0;

/// A cause that may be what is wrong.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Suspect {
    /// The cause.
    pub cause: Cause,
    /// Its most likely size if it acts alone, in its unit.
    pub value: f64,
    /// Standard deviation of that.
    pub standard_deviation: f64,
    /// By how much it lowers χ².
    pub drop: f64,
    /// χ² per degree of freedom that it leaves; `None` where it was not let free.
    pub reduced_chi_squared: Option<f64>,
}

/// What speaks against an estimate without causes.
#[derive(Clone, Debug, PartialEq)]
pub struct Diagnosis {
    /// The causes that do, the most telling first; empty where none does. What cannot be told apart stands side by side with
    /// nearly the same drop of χ².
    pub suspects: Vec<Suspect>,
    /// The score tests of all causes, the largest first.
    pub scores: Vec<Score>,
    /// The joint with the first suspect, where that one was let free.
    pub start: Start,
}

/// Looks for what is wrong with an estimate without causes.
#[must_use]
pub fn diagnose(experiment: &Experiment<'_>, plain: &Estimate, settings: &Settings) -> Diagnosis {
    let careful = Budget {
        phase_rad: 1e-2,
        ..Budget::default()
    };
    let prior = |cause| Prior {
        cause,
        standard_deviation: careful.standard_deviation(cause),
    };
    let candidates: Vec<Prior> = causes(experiment).into_iter().map(prior).collect();
    let scores = score_tests(experiment, plain, &candidates);
    let largest = scores.first().map_or(0.0, |score| score.drop);
    let telling = scores
        .iter()
        .filter(|score| score.drop > TELLING.max(WORTH * largest));
    let near = Start::without_causes(&plain.unknowns);
    let mut tried: Vec<(Suspect, Option<Start>)> = telling
        .take(MOST)
        .map(|score| {
            let free = Prior {
                cause: score.cause,
                standard_deviation: (WIDE * careful.standard_deviation(score.cause))
                    .max(score.value.abs()),
            };
            match refitted(experiment, plain, free, &near, settings) {
                Some((suspect, start)) => (suspect, Some(start)),
                None => (as_scored(score), None),
            }
        })
        .collect();
    let fits = |(suspect, _): &(Suspect, _)| {
        let chi = suspect.reduced_chi_squared;
        chi.is_some_and(|chi| chi < settings.most_reduced_chi_squared)
    };
    let is_far = plain.reduced_chi_squared.is_none_or(|chi| chi > FAR);
    sort(&mut tried);
    if is_far && !tried.first().is_some_and(fits) {
        let is_new = |prior: &Prior| prior.cause != Cause::CommonGain;
        let candidates: Vec<Prior> = candidates.into_iter().filter(is_new).collect();
        for (careful, start) in from_far(experiment, &candidates, WIDE, settings)
            .into_iter()
            .take(MOST)
        {
            let free = Prior {
                standard_deviation: WIDE * careful.standard_deviation,
                ..careful
            };
            let Some((suspect, start)) = refitted(experiment, plain, free, &start, settings) else {
                continue;
            };
            let known = tried.iter().position(|(of, _)| of.cause == suspect.cause);
            match known {
                Some(known) if tried[known].0.drop >= suspect.drop => {}
                Some(known) => tried[known] = (suspect, Some(start)),
                None => tried.push((suspect, Some(start))),
            }
        }
    }
    if is_far && tried.iter().any(|(_, start)| start.is_some()) {
        // one step from the wrong place says nothing
        tried.retain(|(_, start)| start.is_some());
    }
    tried.retain(|(suspect, _)| suspect.drop > TELLING);
    sort(&mut tried);
    let first = tried.first().and_then(|(_, start)| start.clone());
    Diagnosis {
        suspects: tried.into_iter().map(|(suspect, _)| suspect).collect(),
        scores,
        start: first.unwrap_or(near),
    }
}

/// What lowers χ² most comes first.
fn sort(tried: &mut [(Suspect, Option<Start>)]) {
    tried.sort_by(|(one, _), (other, _)| other.drop.total_cmp(&one.drop));
}

fn as_scored(score: &Score) -> Suspect {
    Suspect {
        cause: score.cause,
        value: score.value,
        standard_deviation: score.standard_deviation,
        drop: score.drop,
        reduced_chi_squared: None,
    }
}

/// One step is not enough for a large cause: it is estimated with the joint. `None` where that does not come to rest.
fn refitted(
    experiment: &Experiment<'_>,
    plain: &Estimate,
    free: Prior,
    start: &Start,
    settings: &Settings,
) -> Option<(Suspect, Start)> {
    let found = estimate_with(experiment, &[free], start, settings)?;
    let cause = found.causes.first().filter(|_| found.converged)?;
    // over the lines that both use: a frequency scale leaves lines out
    let before: f64 = plain.costs_at(&found).sum();
    let after: f64 = found.costs_at(plain).sum();
    let suspect = Suspect {
        cause: free.cause,
        value: cause.value,
        standard_deviation: cause.standard_deviation,
        drop: before - after,
        reduced_chi_squared: found.reduced_chi_squared,
    };
    let start = Start {
        unknowns: found.unknowns.clone(),
        cause: Some((free.cause, cause.value)),
    };
    Some((suspect, start))
}
