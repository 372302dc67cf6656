//! How much of what seems to be information about bolts near each other is noise of the substructures.
//!
//! Sensitivities J follow from receptances that have noise, so that M = JᵀΣ⁻¹J has this noise's square in it. Where bolts move nearly
//! alike that is most of M. The second derivative H of what is minimised, the corrections of the substructures following, does not have
//! it, as that of total least squares, XᵀX − nσ²1, has not. What scatters with variance ½ M is the score (W. A. Fuller, Measurement
//! Error Models, 1987, of estimates that are corrected for errors in the regressors), so that
//!
//! Cov θ̂ = ½ H⁻¹ M H⁻¹.
//!
//! With M = L Lᵀ the eigenvalues of L⁻¹ H L⁻ᵀ are the part of M that is information: 1 where the noise does not matter.

use std::sync::Arc;

use nalgebra::{DMatrix, DVector, SymmetricEigen};

use super::estimator::{Estimate, arrived};
use super::noise::{Levels, Noise};
use super::objective::{Corrections, Objective, State, Weights};
use super::parallel;

/// Steps of the corrections, each of which leaves a small part of their error, before derivatives are taken by differences …
const SETTLINGS: usize = 5;
/// … and at the places of the differences, near by: with one the derivative errs by 0.002 to 0.004 of M between two bolts and
/// four, with none by a sixth.
const SETTLINGS_NEAR: usize = 1;
/// Steps of the differences, in what M takes for 1/√2 standard deviations.
const DIFFERENCE: f64 = 0.3;
/// Part of M below which a direction counts as one of which nothing is known: its own error is of that size.
const LEAST_PART: f64 = 0.02;
/// Steps to the minimum by the second derivative.
const STEPS: usize = 6;
/// Step in standard deviations that is no more worth while …
const NEGLIGIBLE_STEP: f64 = 0.02;
/// … and the longest that is taken at once.
const LONGEST_STEP: f64 = 2.0;

/// What the second derivative says of an estimate.
#[derive(Clone, Debug)]
pub(super) struct Observed {
    /// What comes to ½ M⁻¹, the covariance if the noise is as assumed.
    pub(super) added: DMatrix<f64>,
    /// Part of M that is information, in the direction where it is smallest.
    pub(super) least_part: f64,
}

impl Observed {
    /// Of a covariance M⁻¹ and of H.
    pub(super) fn of(covariance: &DMatrix<f64>, curvature: &DMatrix<f64>) -> Option<Self> {
        // with M⁻¹ = R Rᵀ the parts are the eigenvalues of Rᵀ H R
        let root = covariance.clone().cholesky()?.l();
        let parts = (root.tr_mul(curvature) * &root).symmetric_eigen();
        let inverse_root = root.transpose();
        let observed = Curvature {
            inverse_root,
            parts,
        }
        .observed();
        // here M is that of real numbers
        Some(Self {
            added: observed.added * 2.0,
            ..observed
        })
    }

    /// Whether in some direction there is no information at all.
    pub(super) fn is_void(&self) -> bool {
        self.least_part < LEAST_PART
    }
}

/// M and H at one point.
struct Curvature {
    /// L⁻¹ with L Lᵀ = M.
    inverse_root: DMatrix<f64>,
    /// Of L⁻¹ H L⁻ᵀ.
    parts: SymmetricEigen<f64, nalgebra::Dyn>,
}

/// The estimate of several bolts with joints of their own, led on to the minimum by the second derivative, and what this says there.
/// Between substructures without errors M is all that there is to know, and the estimate stays what it is.
pub(super) fn observed(
    objective: &Objective<'_>,
    noise: &Noise,
    estimate: Estimate,
) -> (Estimate, Option<Observed>) {
    if objective.is_independent() {
        return (estimate, None);
    }
    followed(objective, noise, &estimate).unwrap_or((estimate, None))
}

fn followed(
    objective: &Objective<'_>,
    noise: &Noise,
    estimate: &Estimate,
) -> Option<(Estimate, Option<Observed>)> {
    let levels = estimate.levels;
    let start = (estimate.unknowns.clone(), Arc::clone(&estimate.corrections));
    let (mut weights, mut state) = settled(objective, levels, start, SETTLINGS)?;
    let mut steps = 0;
    loop {
        let curvature = Curvature::at(objective, levels, &state)?;
        let observed = curvature.observed();
        if observed.is_void() {
            return Some((estimate.clone(), Some(observed)));
        }
        let step = curvature.step(&state.normal.gradient);
        let unrest = step.component_div(&curvature.deviation()).amax();
        let converged = unrest < NEGLIGIBLE_STEP;
        if converged || steps == STEPS {
            let end = (weights, state, levels);
            let found = arrived(objective, noise, end, (converged, unrest));
            return Some((found, Some(observed)));
        }
        let part = (LONGEST_STEP / unrest).min(1.0);
        let next = (&state.unknowns + step * part, state.corrections);
        (weights, state) = settled(objective, levels, next, SETTLINGS)?;
        steps += 1;
    }
}

/// The point with these unknowns, once the corrections have come to rest.
fn settled(
    objective: &Objective<'_>,
    levels: Levels,
    (unknowns, corrections): (DVector<f64>, Corrections),
    settlings: usize,
) -> Option<(Vec<Weights>, State)> {
    let (weights, mut state) = objective.renewed(levels, unknowns, Some(corrections))?;
    for _ in 0..settlings {
        state = objective.at(&weights, state.unknowns, Some(state.corrections))?;
    }
    Some((weights, state))
}

impl Curvature {
    fn at(objective: &Objective<'_>, levels: Levels, state: &State) -> Option<Self> {
        let root = state.normal.matrix.clone().cholesky()?.l();
        let inverse_root = root.try_inverse()?;
        let score = |by: DVector<f64>| {
            let point = (&state.unknowns + by, Arc::clone(&state.corrections));
            let (_, state) = settled(objective, levels, point, SETTLINGS_NEAR)?;
            Some(state.normal.gradient)
        };
        let directions: Vec<usize> = (0..inverse_root.nrows()).collect();
        let columns = parallel::map(&directions, |&direction| {
            // a column of L⁻ᵀ
            let by = inverse_root.row(direction).transpose() * DIFFERENCE;
            let change = score(-&by)? - score(by)?;
            Some(&inverse_root * change / (2.0 * DIFFERENCE))
        });
        let columns: Vec<DVector<f64>> = columns.into_iter().collect::<Option<_>>()?;
        let relative = DMatrix::from_columns(&columns);
        let symmetric = (&relative + relative.transpose()) / 2.0;
        let is_finite = symmetric.iter().all(|value| value.is_finite());
        is_finite.then(|| Self {
            inverse_root,
            parts: symmetric.symmetric_eigen(),
        })
    }

    /// L⁻ᵀ V f(λ) Vᵀ L⁻¹
    fn with_parts(&self, f: impl Fn(f64) -> f64) -> DMatrix<f64> {
        let whole = self.inverse_root.transpose() * &self.parts.eigenvectors;
        let middle = DMatrix::from_diagonal(&self.parts.eigenvalues.map(f));
        &whole * middle * whole.transpose()
    }

    fn observed(&self) -> Observed {
        // ½ (H⁻¹ M H⁻¹ − M⁻¹), and nothing where M is the smaller one: no interval becomes shorter
        let added = self.with_parts(|part| {
            let part = part.clamp(LEAST_PART, 1.0);
            0.5 * (1.0 / (part * part) - 1.0)
        });
        Observed {
            added,
            least_part: self.parts.eigenvalues.min(),
        }
    }

    fn step(&self, gradient: &DVector<f64>) -> DVector<f64> {
        self.with_parts(|part| 1.0 / part) * gradient
    }

    fn deviation(&self) -> DVector<f64> {
        let covariance = self.with_parts(|part| 0.5 / (part * part));
        covariance.diagonal().map(f64::sqrt)
    }
}
