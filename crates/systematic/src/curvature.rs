//! The curvature of what is minimised, where the joint moves and all else follows: information about the joint without what only
//! seems to be.
//!
//! Derivatives by the joint follow from receptances that have noise, so that the square of this noise stands in M = AᴴS⁻¹A. The
//! derivative of the gradient, the receptances following, does not have it (docs/theory.md, 7.3).

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use super::budget::Prior;
use super::estimate::Estimate;
use super::experiment::Experiment;
use super::line::{Labelled, Point, Task};
use super::normal::{Scatter, Share, Whitened};
use super::search::{inverse, summed, with_priors};
use super::structures::Recomputations;

/// Steps of the receptances, each of which leaves a small part of their error, before the gradient is taken.
const SETTLINGS: usize = 3;
/// Steps of the differences, in standard deviations.
const DIFFERENCE: f64 = 0.3;

/// H: how the gradient changes where the joint's unknowns move and the causes follow, at an estimate of [`super::estimate`]; as
/// large as there are unknowns, and the inverse of their covariance where noise does not matter. `None` for an estimate whose
/// receptances do not follow, and where a difference cannot be taken.
#[must_use]
pub fn curvature(experiment: &Experiment<'_>, estimate: &Estimate) -> Option<DMatrix<f64>> {
    let found = &estimate.found;
    if found.labelled.is_empty() {
        return None;
    }
    let priors: Vec<Prior> = estimate.causes.iter().map(|cause| cause.prior).collect();
    let task = Task::new(experiment, &priors);
    let size = task.unknowns();
    let covariance = inverse(&with_priors(&task, &found.information))?;
    let root = covariance
        .view((0, 0), (size, size))
        .into_owned()
        .cholesky()?
        .l();
    let inverse_root = root.try_inverse()?;
    // B = C_·θ C_θθ⁻¹: what follows a step of the unknowns; a column of B L moves them by one standard deviation
    let steps = covariance.columns(0, size) * inverse_root.transpose();
    let gradient = |by: DVector<f64>| {
        let mut point = found.point.clone();
        point.moves(&by);
        let mut gradient = settled_gradient(&task, &found.lines, &point, found.labelled.clone())?;
        for (number, prior) in priors.iter().enumerate() {
            gradient[size + number] -= prior.pull(point.causes[number]) / prior.standard_deviation;
        }
        Some(steps.tr_mul(&gradient))
    };
    let columns: Option<Vec<DVector<f64>>> = (0..size)
        .map(|direction| {
            let by = steps.column(direction) * DIFFERENCE;
            let change = gradient(-&by)? - gradient(by)?;
            Some(change / (2.0 * DIFFERENCE))
        })
        .collect();
    // Lᵀ H L
    let relative = DMatrix::from_columns(&columns?);
    let symmetric = (&relative + relative.transpose()) / 2.0;
    let curvature = inverse_root.tr_mul(&symmetric) * &inverse_root;
    let is_finite = curvature.iter().all(|value| value.is_finite());
    is_finite.then_some(curvature)
}

/// The gradient of these lines with the receptances that go with joint and causes, sought from those near them.
fn settled_gradient(
    task: &Task<'_>,
    lines: &[usize],
    point: &Point,
    mut labelled: Vec<Labelled>,
) -> Option<DVector<f64>> {
    let recomputed = Recomputations::of(task.experiment, task.priors, &point.causes)?;
    let size = task.unknowns() + task.priors.len();
    let held = DVector::zeros(size);
    for _ in 0..SETTLINGS {
        let followed: Option<Vec<Labelled>> = lines
            .par_iter()
            .map(|&line| {
                let terms = task.terms(line, point, &labelled[line], &recomputed)?;
                let whitened = Whitened::of(task, line, &terms, &Scatter::default())?;
                Some(whitened.followed(task.unknowns(), &held))
            })
            .collect();
        for (&line, followed) in lines.iter().zip(followed?) {
            labelled[line] = followed;
        }
    }
    let shares: Option<Vec<Share>> = lines
        .par_iter()
        .map(|&line| {
            let terms = task.terms(line, point, &labelled[line], &recomputed)?;
            Some(Whitened::of(task, line, &terms, &Scatter::default())?.share())
        })
        .collect();
    let (_, gradient, _) = summed(&shares?, size)?;
    Some(gradient)
}
