//! Causes so large that a joint which is sought without them is none: each is sought with the joint, from everywhere.

use rayon::prelude::*;

use super::budget::Prior;
use super::cause::Cause;
use super::estimate::{Settings, Start, rank};
use super::experiment::Experiment;
use super::line::Task;
use super::search::{Found, Inflation, search};
use super::starts::few;

/// Lines of these searches.
const MOST_LINES: usize = 60;
/// Their steps: those after which most are given up, …
const FIRST_ITERATIONS: usize = 9;
/// … and those of the others.
const MORE_ITERATIONS: usize = 16;
/// Searches with a cause that go on, those that leave least.
const GO_ON: usize = 3;
/// How much larger the assembly's noise is taken to be at first: what is far away shows through.
const INFLATION: f64 = 30.0;

/// For each of these causes the best place that a search with this one alone leads to, what fits best first. The priors are
/// those of a careful laboratory, and are widened by `wider`.
pub(crate) fn from_far(
    experiment: &Experiment<'_>,
    candidates: &[Prior],
    wider: f64,
    settings: &Settings,
) -> Vec<(Prior, Start)> {
    let [first, more] = [FIRST_ITERATIONS, MORE_ITERATIONS].map(|most_iterations| Settings {
        most_lines: MOST_LINES,
        most_iterations,
        ..settings.clone()
    });
    let starts = few(experiment);
    let inflation = Inflation::from(experiment, INFLATION);
    let none = Inflation::none(experiment);
    let sought = |careful: &Prior| -> Option<(f64, Prior, Start)> {
        let free = [Prior {
            standard_deviation: wider * careful.standard_deviation,
            centre: 0.0,
            ..*careful
        }];
        let task = Task::new(experiment, &free);
        let places = beginnings(careful.cause).iter().flat_map(|beginning| {
            starts.iter().map(move |unknowns| Start {
                unknowns: unknowns.clone(),
                causes: vec![(careful.cause, beginning * careful.standard_deviation)],
            })
        });
        let mut begun: Vec<(f64, Found)> = places
            .filter_map(|start| search(&task, start.point(&free), &first, &inflation))
            .map(|found| (rank(&task, &found), found))
            .collect();
        begun.sort_by(|(one, _), (other, _)| one.total_cmp(other));
        let go_on = begun.into_iter().take(GO_ON);
        // the noise is no longer inflated after the first steps
        let found = go_on.filter_map(|(_, found)| {
            let found = search(&task, found.point, &more, &none)?;
            Some((rank(&task, &found), found))
        });
        let (rank, found) = found.min_by(|(one, _), (other, _)| one.total_cmp(other))?;
        let start = Start {
            unknowns: found.point.unknowns,
            causes: vec![(careful.cause, found.point.causes[0])],
        };
        Some((rank, *careful, start))
    };
    let mut found: Vec<_> = candidates.par_iter().filter_map(sought).collect();
    found.sort_by(|one, other| one.0.total_cmp(&other.0));
    let found = found.into_iter();
    found.map(|(_, prior, start)| (prior, start)).collect()
}

/// Where a cause begins, in standard deviations of its prior: what moves resonances has many minima.
fn beginnings(cause: Cause) -> &'static [f64] {
    match cause {
        Cause::Gain(_)
        | Cause::CommonGain
        | Cause::ChannelGain(..)
        | Cause::Phase(_)
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
        | Cause::DifferenceStiffness(_) => &[0.0, 7.0, -7.0],
    }
}
