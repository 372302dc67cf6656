//! What is wrong, by name: the causes that the score tests point to are let free one by one, and compared by what they leave.

use super::budget::{Budget, Prior, causes};
use super::cause::Cause;
use super::estimate::{Estimate, Settings, estimate_with};
use super::experiment::Experiment;
use super::score::{Score, score_tests};

/// Scores below this are chance: of thirty causes that do not act the most telling one is above it once in twenty times.
pub const TELLING: f64 = 10.0;
/// Causes that are let free at most.
const MOST: usize = 6;
/// A score below this part of the largest is not looked at.
const WORTH: f64 = 0.05;
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

/// The causes that speak against an estimate without any, the most telling first; empty where none does. What cannot be told
/// apart stands side by side with nearly the same drop of χ².
#[must_use]
pub fn suspects(
    experiment: &Experiment<'_>,
    plain: &Estimate,
    settings: &Settings,
) -> Vec<Suspect> {
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
    let Some(largest) = scores
        .first()
        .map(|score| score.drop)
        .filter(|&drop| drop > TELLING)
    else {
        return Vec::new();
    };
    let telling = scores
        .iter()
        .filter(|score| score.drop > TELLING.max(WORTH * largest));
    let mut suspects: Vec<Suspect> = telling
        .take(MOST)
        .map(|score| refitted(experiment, plain, prior(score.cause), score, settings))
        .collect();
    suspects.retain(|suspect| suspect.drop > TELLING);
    suspects.sort_by(|one, other| other.drop.total_cmp(&one.drop));
    suspects
}

/// One step is not enough for a large cause: it is estimated with the joint.
fn refitted(
    experiment: &Experiment<'_>,
    plain: &Estimate,
    prior: Prior,
    score: &Score,
    settings: &Settings,
) -> Suspect {
    let as_scored = Suspect {
        cause: score.cause,
        value: score.value,
        standard_deviation: score.standard_deviation,
        drop: score.drop,
        reduced_chi_squared: None,
    };
    let free = Prior {
        standard_deviation: (WIDE * prior.standard_deviation).max(score.value.abs()),
        ..prior
    };
    let Some(found) = estimate_with(experiment, &[free], &plain.unknowns, settings) else {
        return as_scored;
    };
    let Some(cause) = found.causes.first().filter(|_| found.converged) else {
        return as_scored;
    };
    // over the lines that both use: a frequency scale leaves lines out
    let before: f64 = plain.costs_at(&found).sum();
    let after: f64 = found.costs_at(plain).sum();
    Suspect {
        cause: score.cause,
        value: cause.value,
        standard_deviation: cause.standard_deviation,
        drop: before - after,
        reduced_chi_squared: found.reduced_chi_squared,
    }
}
