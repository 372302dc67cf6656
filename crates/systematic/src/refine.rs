//! An estimate that was found on few lines, refined on many. The lines are linearised at the receptances that a smooth fit gives:
//! these are near the true ones, so that none has to follow.

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use super::budget::Prior;
use super::estimate::{Estimate, Settings, of};
use super::experiment::Experiment;
use super::line::{Point, Task};
use super::normal::{Scatter, Share, Whitened, as_measured};
use super::search::{Found, TOLERANCE, step, summed};
use super::structures::Recomputations;
use super::taking_part::{is_linear, keeps_its_frequency};

/// Gauss–Newton steps at most.
const MOST_STEPS: usize = 20;
/// A step longer than this part of the one before, in standard deviations, overshoots …
const FALLING: f64 = 0.3;
/// … and this part of it is taken.
const SHORTER: f64 = 0.4;
/// Lines that are linearised before they are summed up.
const PIECE: usize = 512;

/// The estimate on the lines of `experiment` that begins where `found` ended on others. `None` where it does not come to rest
/// nearby.
#[must_use]
pub fn refine(
    experiment: &Experiment<'_>,
    found: &Estimate,
    settings: &Settings,
) -> Option<Estimate> {
    let priors: Vec<Prior> = found.causes.iter().map(|cause| cause.prior).collect();
    let contradicted: Vec<Option<f64>> = found.causes.iter().map(|of| of.contradicted).collect();
    let task = Task::new(experiment, &priors);
    let mut point = Point {
        unknowns: found.unknowns.clone(),
        causes: found.causes.iter().map(|cause| cause.value).collect(),
    };
    let mut lines: Vec<usize> = (0..task.lines())
        .filter(|&line| keeps_its_frequency(&task, line, settings))
        .collect();
    let mut before = f64::INFINITY;
    for iteration in 0..MOST_STEPS {
        let (information, gradient, cost) =
            sums(&task, &point, &mut lines, iteration == 0, settings)?;
        let (step, deviation) = step(&task, &point, &information, &gradient)?;
        let relative = step.iter().zip(deviation.iter());
        let largest = relative.map(|(s, d)| (s / d).abs()).fold(0.0, f64::max);
        if largest < TOLERANCE {
            let found = Found {
                point,
                labelled: Vec::new(),
                lines,
                information,
                cost,
                shares: Vec::new(),
                iterations: iteration,
                converged: true,
            };
            return of(&task, found, &contradicted);
        }
        let part = if largest > FALLING * before {
            SHORTER
        } else {
            1.0
        };
        before = largest;
        point.moves(&(step * part));
    }
    None
}

/// Information, gradient and cost of the lines; at `first` those that are not linear are left out for good.
fn sums(
    task: &Task<'_>,
    point: &Point,
    lines: &mut Vec<usize>,
    first: bool,
    settings: &Settings,
) -> Option<(DMatrix<f64>, DVector<f64>, f64)> {
    let size = task.unknowns() + task.priors.len();
    let recomputed = Recomputations::of(task.experiment, task.priors, &point.causes)?;
    let of_line = |&line: &usize| -> Option<Option<(usize, Share)>> {
        let labelled = task.smooth(line, point, &as_measured(task, line, point));
        let terms = task.terms(line, point, &labelled, &recomputed)?;
        if first && !is_linear(&terms, settings.most_nonlinear) {
            return Some(None);
        }
        let scatter = Scatter {
            keeps_second_order: task.experiment.has_common_errors(),
            ..Scatter::default()
        };
        let whitened = Whitened::of(task, line, &terms, &scatter)?;
        Some(Some((line, whitened.share())))
    };
    let mut kept = Vec::with_capacity(lines.len());
    let mut total = (DMatrix::zeros(size, size), DVector::zeros(size), 0.0);
    for piece in lines.chunks(PIECE) {
        let shares: Option<Vec<Option<(usize, Share)>>> = piece.par_iter().map(of_line).collect();
        let (used, shares): (Vec<usize>, Vec<Share>) = shares?.into_iter().flatten().unzip();
        kept.extend(used);
        if shares.is_empty() {
            continue;
        }
        let (information, gradient, cost) = summed(&shares, size)?;
        total.0 += information;
        total.1 += gradient;
        total.2 += cost;
    }
    *lines = kept;
    (!lines.is_empty()).then_some(total)
}
