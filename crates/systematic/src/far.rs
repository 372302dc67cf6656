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
/// Their steps.
const MOST_ITERATIONS: usize = 25;
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
    let settings = Settings {
        most_lines: MOST_LINES,
        most_iterations: MOST_ITERATIONS,
        ..settings.clone()
    };
    let starts = few(experiment);
    let inflation = Inflation::from(experiment, INFLATION);
    let sought = |careful: &Prior| -> Option<(f64, Prior, Start)> {
        let free = [Prior {
            standard_deviation: wider * careful.standard_deviation,
            centre: 0.0,
            ..*careful
        }];
        let task = Task::new(experiment, &free);
        let mut best: Option<(f64, Start)> = None;
        for &beginning in beginnings(careful.cause) {
            for unknowns in &starts {
                let value = beginning * careful.standard_deviation;
                let start = Start {
                    unknowns: unknowns.clone(),
                    causes: vec![(careful.cause, value)],
                };
                let Some(found) = search(&task, start.point(&free), &settings, &inflation) else {
                    continue;
                };
                let rank = rank(&task, &found);
                if best.as_ref().is_none_or(|(least, _)| rank < *least) {
                    let value = found.point.causes[0];
                    let unknowns = found.point.unknowns;
                    let causes = vec![(careful.cause, value)];
                    best = Some((rank, Start { unknowns, causes }));
                }
            }
        }
        best.map(|(rank, start)| (rank, *careful, start))
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
