//! Causes so large that a joint which is sought without them is none: each is sought with the joint, from everywhere.

use rayon::prelude::*;

use super::budget::Prior;
use super::cause::Cause;
use super::estimate::{Settings, Start, rank};
use super::experiment::Experiment;
use super::line::Task;
use super::search::{Inflation, search};
use super::starts::few;

/// Lines of these searches.
const MOST_LINES: usize = 60;
/// How much larger the assembly's noise is taken to be at first: what is far away shows through.
const INFLATION: f64 = 30.0;
/// Steps until it has shrunk to what it is, after which most places show that they lead nowhere, …
const FIRST_ITERATIONS: usize = 7;
/// … and those that the best ones are followed for: so many causes, …
const ITERATIONS: usize = 18;
const FOLLOWED: usize = 12;
/// … and of each so many places.
const PLACES: usize = 3;

/// For each of the causes that fit best the best place that a search with this one alone leads to, the best first. The priors are
/// those of a careful laboratory, and are widened by `wider`.
pub(crate) fn from_far(
    experiment: &Experiment<'_>,
    candidates: &[Prior],
    wider: f64,
    settings: &Settings,
) -> Vec<(Prior, Start)> {
    let starts = few(experiment);
    let searches = Searches {
        experiment,
        wider,
        settings: Settings {
            most_lines: MOST_LINES,
            ..settings.clone()
        },
    };
    let first = |careful: &Prior| -> Option<Sought> {
        let inflation = Inflation::from(experiment, INFLATION);
        let begin = beginnings(careful.cause).iter().flat_map(|beginning| {
            let value = beginning * careful.standard_deviation;
            starts.iter().map(move |unknowns| Start {
                unknowns: unknowns.clone(),
                causes: vec![(careful.cause, value)],
            })
        });
        searches.from(careful, begin, FIRST_ITERATIONS, &inflation)
    };
    let mut found: Vec<Sought> = candidates.par_iter().filter_map(first).collect();
    found.sort_by(|one, other| one.best().total_cmp(&other.best()));
    let further = |sought: &Sought| -> Option<Sought> {
        let begin = sought.places.iter().take(PLACES);
        let begin = begin.map(|(_, start)| start.clone());
        let none = Inflation::none(experiment);
        searches.from(&sought.careful, begin, ITERATIONS, &none)
    };
    let followed = found.par_iter().take(FOLLOWED);
    let mut found: Vec<Sought> = followed.filter_map(further).collect();
    found.sort_by(|one, other| one.best().total_cmp(&other.best()));
    let best = |sought: Sought| {
        let (_, start) = sought.places.into_iter().next()?;
        Some((sought.careful, start))
    };
    found.into_iter().filter_map(best).collect()
}

/// What searches with one cause led to.
struct Sought {
    careful: Prior,
    /// Ranks and places, the best first; there is one at least.
    places: Vec<(f64, Start)>,
}

impl Sought {
    fn best(&self) -> f64 {
        self.places.first().map_or(f64::INFINITY, |place| place.0)
    }
}

/// What all these searches have in common.
struct Searches<'s> {
    experiment: &'s Experiment<'s>,
    wider: f64,
    settings: Settings,
}

impl Searches<'_> {
    /// Where searches with this cause lead from these places; `None` where none leads anywhere.
    fn from(
        &self,
        careful: &Prior,
        begin: impl Iterator<Item = Start>,
        most_iterations: usize,
        inflation: &Inflation,
    ) -> Option<Sought> {
        let free = [Prior {
            standard_deviation: self.wider * careful.standard_deviation,
            centre: 0.0,
            ..*careful
        }];
        let task = Task::new(self.experiment, &free);
        let settings = Settings {
            most_iterations,
            ..self.settings.clone()
        };
        let place = |start: Start| {
            let found = search(&task, start.point(&free), &settings, inflation)?;
            let start = Start {
                causes: vec![(careful.cause, found.point.causes[0])],
                unknowns: found.point.unknowns.clone(),
            };
            Some((rank(&task, &found), start))
        };
        let mut places: Vec<(f64, Start)> = begin.filter_map(place).collect();
        places.sort_by(|one, other| one.0.total_cmp(&other.0));
        let careful = *careful;
        (!places.is_empty()).then_some(Sought { careful, places })
    }
}

/// Where a cause begins, in standard deviations of its prior: what moves resonances has many minima.
fn beginnings(cause: Cause) -> &'static [f64] {
    match cause {
        Cause::Gain(_)
        | Cause::CommonGain
        | Cause::ChannelGain(..)
        | Cause::Phase(_)
        | Cause::CommonDelay
        | Cause::StructureDamping(_)
        | Cause::LossFactor
        | Cause::JointBending(..) => &[0.0],
        Cause::Accelerometer(_) | Cause::JointMass(..) | Cause::JointInertia(..) => {
            &[0.0, 7.0, 17.0]
        }
        Cause::Delay(_)
        | Cause::Position(_)
        | Cause::JointPosition(..)
        | Cause::Frequency(_)
        | Cause::YoungsModulus(_)
        | Cause::Density(_)
        | Cause::DifferenceStiffness(_)
        | Cause::DifferenceSpacing(_) => &[0.0, 7.0, -7.0],
    }
}
