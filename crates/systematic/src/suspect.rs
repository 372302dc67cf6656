//! What is wrong, by name: the causes that the score tests point to are let free one by one, and compared by what they leave.

use super::budget::{Budget, Prior, causes};
use super::cause::Cause;
use super::estimate::{Estimate, Settings, Start, estimate_with};
use super::experiment::Experiment;
use super::far::from_far;
use super::score::{Score, score_tests};

/// Scores below this are chance, and so is a cause that lowers χ² by less: in a hundred tests without any mistake the most telling
/// of some thirty causes was beyond it and stayed so in three.
pub const TELLING: f64 = 16.0;
/// Causes that are let free at most.
const MOST: usize = 6;
/// A score below this part of the largest is not looked at.
const WORTH: f64 = 0.05;
/// A cause that leaves fewer of the lines than this part has not explained them.
const ENOUGH: f64 = 0.9;
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
    /// Lines that say so.
    pub lines: usize,
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

/// Standard deviations of χ² that chance lowers it by at most.
const BEYOND_CHANCE: f64 = 6.0;

/// A suspect, and where joint and cause are if it was let free.
type Trial = (Suspect, Option<Start>);

/// An estimate without causes, and the way to others.
struct Case<'c> {
    experiment: &'c Experiment<'c>,
    plain: &'c Estimate,
    settings: &'c Settings,
    careful: Budget,
}

/// Looks for what is wrong with an estimate without causes, from where that is.
#[must_use]
pub fn diagnose(experiment: &Experiment<'_>, plain: &Estimate, settings: &Settings) -> Diagnosis {
    let case = Case::of(experiment, plain, settings);
    let scores = case.scores();
    let trials = case.near(&scores);
    case.diagnosis(trials, scores)
}

impl Diagnosis {
    /// What the score tests say alone, where the causes together explain the data and none stands out.
    #[must_use]
    pub fn of_scores(experiment: &Experiment<'_>, plain: &Estimate, settings: &Settings) -> Self {
        let case = Case::of(experiment, plain, settings);
        case.diagnosis(Vec::new(), case.scores())
    }

    /// Looks for causes so large that the estimate without them is in the wrong place altogether; `None` where what it leaves is
    /// not so much, or where a suspect explains it.
    #[must_use]
    pub fn from_far(
        &self,
        experiment: &Experiment<'_>,
        plain: &Estimate,
        settings: &Settings,
    ) -> Option<Self> {
        let case = Case::of(experiment, plain, settings);
        let first = self.suspects.first();
        if !plain.is_far() || first.is_some_and(|suspect| case.is_explained(suspect)) {
            return None;
        }
        // one step from the wrong place says nothing
        let refitted = self.suspects.iter().copied();
        let refitted = refitted.filter(|suspect| suspect.reduced_chi_squared.is_some());
        let own = |suspect: Suspect| (suspect, first == Some(&suspect));
        let mut trials: Vec<Trial> = refitted
            .map(own)
            .map(|(suspect, is_first)| (suspect, is_first.then(|| self.start.clone())))
            .collect();
        for trial in case.far() {
            add(&mut trials, trial);
        }
        Some(case.diagnosis(trials, self.scores.clone()))
    }

    /// Adds the causes whose priors an estimate with all causes contradicts: it may have come near the joint where no cause
    /// alone did.
    #[must_use]
    pub fn with_contradicted(
        mut self,
        experiment: &Experiment<'_>,
        plain: &Estimate,
        found: &Estimate,
        settings: &Settings,
    ) -> Self {
        let case = Case::of(experiment, plain, settings);
        let contradicted = found.causes.iter().filter(|of| of.contradicted.is_some());
        for of in contradicted.filter(|_| found.converged) {
            let cause = of.prior.cause;
            if self.suspects.iter().any(|suspect| suspect.cause == cause) {
                continue;
            }
            let start = Start {
                unknowns: found.unknowns.clone(),
                causes: vec![(cause, of.value)],
            };
            let free = case.freed(cause, of.value);
            let trial = case.refitted(free, &start);
            let telling = trial.filter(|(suspect, _)| suspect.drop > TELLING);
            self.suspects.extend(telling.map(|(suspect, _)| suspect));
        }
        self.suspects
            .sort_by(|one, other| other.drop.total_cmp(&one.drop));
        self
    }
}

impl<'c> Case<'c> {
    fn of(experiment: &'c Experiment<'c>, plain: &'c Estimate, settings: &'c Settings) -> Self {
        Self {
            experiment,
            plain,
            settings,
            careful: Budget {
                phase_rad: 1e-2,
                ..Budget::default()
            },
        }
    }

    fn careful_prior(&self, cause: Cause) -> Prior {
        Prior {
            cause,
            standard_deviation: self.careful.standard_deviation(cause),
            centre: 0.0,
        }
    }

    /// A prior that hardly holds a cause which may be as large as this.
    fn freed(&self, cause: Cause, value: f64) -> Prior {
        let wide = WIDE * self.careful.standard_deviation(cause);
        Prior {
            cause,
            standard_deviation: wide.max(value.abs()),
            centre: 0.0,
        }
    }

    /// The score tests of all causes.
    fn scores(&self) -> Vec<Score> {
        let candidates: Vec<Prior> = causes(self.experiment)
            .into_iter()
            .map(|cause| self.careful_prior(cause))
            // what a careful laboratory knows exactly is no suspect
            .filter(|prior| prior.standard_deviation > 0.0)
            .collect();
        score_tests(self.experiment, self.plain, &candidates)
    }

    /// The causes that the scores point to, each let free from where the estimate is.
    fn near(&self, scores: &[Score]) -> Vec<Trial> {
        let largest = scores.first().map_or(0.0, |score| score.drop);
        let least = TELLING.max(WORTH * largest);
        let start = Start::without_causes(&self.plain.unknowns);
        let telling = scores.iter().filter(|score| score.drop > least).take(MOST);
        let trial = |score: &Score| -> Option<Trial> {
            let free = self.freed(score.cause, score.value);
            match self.refitted(free, &start) {
                Some((suspect, start)) => Some((suspect, Some(start))),
                None => Some((self.as_scored(score)?, None)),
            }
        };
        telling.filter_map(trial).collect()
    }

    fn diagnosis(&self, mut trials: Vec<Trial>, scores: Vec<Score>) -> Diagnosis {
        trials.retain(|(suspect, _)| suspect.drop > TELLING);
        // what lowers χ² most comes first
        trials.sort_by(|(one, _), (other, _)| other.drop.total_cmp(&one.drop));
        let first = trials.first().and_then(|(_, start)| start.clone());
        Diagnosis {
            suspects: trials.into_iter().map(|(suspect, _)| suspect).collect(),
            scores,
            start: first.unwrap_or_else(|| Start::without_causes(&self.plain.unknowns)),
        }
    }

    /// The causes that fit best from far away.
    fn far(&self) -> Vec<Trial> {
        let candidates: Vec<Prior> = causes(self.experiment)
            .into_iter()
            .filter(|cause| !cause.is_hidden())
            .map(|cause| self.careful_prior(cause))
            .filter(|prior| prior.standard_deviation > 0.0)
            .collect();
        let places = from_far(self.experiment, &candidates, WIDE, self.settings);
        let trial = |(careful, start): (Prior, Start)| {
            let (suspect, start) = self.refitted(self.freed(careful.cause, 0.0), &start)?;
            Some((suspect, Some(start)))
        };
        places.into_iter().take(MOST).filter_map(trial).collect()
    }

    /// One step is not enough for a large cause: it is estimated with the joint. `None` where that does not come to rest.
    fn refitted(&self, free: Prior, start: &Start) -> Option<(Suspect, Start)> {
        let found = estimate_with(self.experiment, &[free], start, self.settings)?;
        let cause = found.causes.first().filter(|_| found.converged)?;
        // over the lines that both use: a frequency scale leaves lines out
        let before: f64 = self.plain.costs_at(&found).sum();
        let after: f64 = found.costs_at(self.plain).sum();
        let suspect = Suspect {
            cause: free.cause,
            value: cause.value,
            standard_deviation: cause.standard_deviation,
            drop: before - after,
            reduced_chi_squared: found.reduced_chi_squared,
            lines: found.lines.0,
        };
        let start = Start {
            unknowns: found.unknowns.clone(),
            causes: vec![(free.cause, cause.value)],
        };
        Some((suspect, start))
    }

    /// What the score says alone; `None` where it promises more than noise has above its least: where noise is large beside a
    /// function, as at a resonance of what differences are taken of, one line can promise that.
    fn as_scored(&self, score: &Score) -> Option<Suspect> {
        let squares: f64 = self.plain.costs_at(self.plain).sum();
        let reduced = self.plain.reduced_chi_squared.filter(|own| *own > 0.0)?;
        let freedom = squares / reduced;
        let most = squares - freedom + BEYOND_CHANCE * (2.0 * freedom).sqrt();
        (score.drop < most).then_some(Suspect {
            cause: score.cause,
            value: score.value,
            standard_deviation: score.standard_deviation,
            drop: score.drop,
            reduced_chi_squared: None,
            lines: self.plain.lines.0,
        })
    }

    /// Whether this cause leaves noise, at nearly all lines.
    fn is_explained(&self, suspect: &Suspect) -> bool {
        let chi = suspect.reduced_chi_squared;
        let fits = chi.is_some_and(|chi| chi < self.settings.most_reduced_chi_squared);
        fits && suspect.lines as f64 > ENOUGH * self.plain.lines.0 as f64
    }
}

/// Keeps the better of two trials of the same cause.
fn add(trials: &mut Vec<Trial>, trial: Trial) {
    let cause = trial.0.cause;
    match trials.iter_mut().find(|(of, _)| of.cause == cause) {
        Some(known) if known.0.drop >= trial.0.drop => {}
        Some(known) => *known = trial,
        None => trials.push(trial),
    }
}
