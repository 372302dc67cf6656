//! The normal equations of weighted least squares with priors, gathered line by line.

use nalgebra::{DMatrix, DVector};

use crate::chain::assembled::Assembled;
use crate::chain::problem::{Problem, Unknowns};
use crate::error::SpatialError;
use crate::normal::Deviations;

/// Weighted squares and what they say of a step.
pub(crate) struct Normal {
    /// 2 Re Jᴴ Σ⁻¹ J and the priors.
    pub(crate) information: DMatrix<f64>,
    /// Half of the steepest descent.
    pub(crate) descent: DVector<f64>,
    /// 2 Σ |e|²/σ² and the priors'.
    pub(crate) cost: f64,
}

/// 2 Σ |e|²/σ² and the priors'.
pub(crate) fn cost(
    problem: &Problem,
    unknowns: &Unknowns,
    deviations: &Deviations,
) -> Result<f64, SpatialError> {
    let assembled = Assembled::new(problem, unknowns)?;
    let mut sum = squares_of_errors(problem, unknowns);
    for line in 0..problem.frequency_hz.len() {
        let functions = assembled.functions(line)?;
        for ((one, function), deviation) in problem.observed.iter().zip(functions).zip(deviations) {
            sum += 2.0 * (one.values[line] - function).norm_sqr() / (deviation * deviation);
        }
    }
    Ok(sum)
}

/// Σ (η/σ)² of the errors of the set-up: about as many as there are, or fewer, where the budget holds.
pub(crate) fn squares_of_errors(problem: &Problem, unknowns: &Unknowns) -> f64 {
    priors(problem, unknowns)
        .map(|[error, deviation]| (error / deviation).powi(2))
        .sum()
}

/// Each error of the set-up with its deviation.
fn priors(problem: &Problem, unknowns: &Unknowns) -> impl Iterator<Item = [f64; 2]> {
    let errors = unknowns.0.as_slice()[problem.joint_count()..].to_vec();
    let deviations = problem.error_deviations();
    errors.into_iter().zip(deviations).map(<[f64; 2]>::from)
}

impl Normal {
    pub(crate) fn of(
        problem: &Problem,
        unknowns: &Unknowns,
        deviations: &Deviations,
    ) -> Result<Self, SpatialError> {
        let assembled = Assembled::new(problem, unknowns)?;
        let count = problem.count();
        let rows = problem.observed.len();
        let mut normal = Self {
            information: DMatrix::zeros(count, count),
            descent: DVector::zeros(count),
            cost: 0.0,
        };
        let mut real = DMatrix::zeros(2 * rows, count);
        let mut errors = DVector::zeros(2 * rows);
        for line in 0..problem.frequency_hz.len() {
            let found = assembled.line(line)?;
            for (row, one) in problem.observed.iter().enumerate() {
                // E (Re ε)² = σ²/2
                let weight = std::f64::consts::SQRT_2 / deviations[row];
                let error = one.values[line] - found.functions[row];
                errors[2 * row] = weight * error.re;
                errors[2 * row + 1] = weight * error.im;
                for column in 0..count {
                    let derivative = found.derivatives[(row, column)];
                    real[(2 * row, column)] = weight * derivative.re;
                    real[(2 * row + 1, column)] = weight * derivative.im;
                }
            }
            // transposed first: the product of matrices as they lie is the fast one
            normal.information.gemm(1.0, &real.transpose(), &real, 1.0);
            normal.descent.gemv_tr(1.0, &real, &errors, 1.0);
            normal.cost += errors.norm_squared();
        }
        for (n, [error, deviation]) in priors(problem, unknowns).enumerate() {
            let place = problem.joint_count() + n;
            let weight = 1.0 / (deviation * deviation);
            normal.information[(place, place)] += weight;
            normal.descent[place] -= weight * error;
            normal.cost += weight * error * error;
        }
        Ok(normal)
    }
}
