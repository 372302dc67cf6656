//! Bounded least squares on the same objective, without chance: of all solutions that fit equally well, the one nearest to the
//! prior in the normalised logarithms.

use nalgebra::{DMatrix, DVector};

use super::super::parameter::LapParameters;
use super::problem::UpdateProblem;

/// Weight of the distance from the prior: from one that guides to one that only decides between equal fits.
const PRIOR_WEIGHTS: [f64; 7] = [1e-2, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12, 1e-13];
const STEPS: usize = 60;
/// Change of the place that is none.
const AT_REST: f64 = 1e-15;

/// Minimises the objective within the bounds.
#[must_use]
pub fn least_squares(problem: &UpdateProblem) -> LapParameters {
    let prior = problem.prior_place();
    let mut place = prior.clone();
    for weight in PRIOR_WEIGHTS {
        for _ in 0..STEPS {
            let next = step(problem, &place, &prior, weight);
            let change = place.iter().zip(&next).map(|(a, b)| (a - b).abs());
            let change = change.fold(0.0, f64::max);
            place = next;
            if change < AT_REST {
                break;
            }
        }
    }
    problem.parameters(&place)
}

/// A projected Gauss–Newton step: parameters that a step would carry over a bound are held there and the others stepped again.
fn step(problem: &UpdateProblem, place: &[f64], prior: &[f64], prior_weight: f64) -> Vec<f64> {
    let parameters = problem.parameters(place);
    let errors = problem.errors(&parameters);
    let sensitivity = problem.sensitivity(&parameters);
    let widths = problem.widths();
    let (rows, columns) = (errors.len(), place.len());
    let root = problem.weights.iter().map(|weight| weight.sqrt());
    let root: Vec<f64> = root.collect();
    // The rows of the objective, then those of the prior: r = √W (ω/ω_e − 1), √λ (z − z_prior).
    // ∂r/∂z = √W (ω/ω_e) ∂ln ω/∂ln p · ln(high/low)
    let jacobian = DMatrix::from_fn(rows + columns, columns, |i, j| match i.checked_sub(rows) {
        None => root[i] * (1.0 + errors[i]) * sensitivity[i][j] * widths[j],
        Some(own) if own == j => prior_weight.sqrt(),
        Some(_) => 0.0,
    });
    let residual = DVector::from_fn(rows + columns, |i, _| match i.checked_sub(rows) {
        None => root[i] * errors[i],
        Some(own) => prior_weight.sqrt() * (place[own] - prior[own]),
    });
    let mut held: Vec<Option<f64>> = vec![None; columns];
    loop {
        let moving: Vec<usize> = (0..columns).filter(|&j| held[j].is_none()).collect();
        let mut target = residual.clone();
        for (j, bound) in held.iter().enumerate() {
            if let Some(bound) = bound {
                target += jacobian.column(j) * (bound - place[j]);
            }
        }
        let mut next: Vec<f64> = (0..columns).map(|j| held[j].unwrap_or(place[j])).collect();
        if moving.is_empty() {
            return next;
        }
        let free = jacobian.select_columns(&moving);
        let Some(change) = solve(free, -target) else {
            return next;
        };
        let mut newly_held = false;
        for (&j, change) in moving.iter().zip(change.iter()) {
            let wanted = place[j] + change;
            next[j] = wanted.clamp(0.0, 1.0);
            if wanted != next[j] {
                held[j] = Some(next[j]);
                newly_held = true;
            }
        }
        if !newly_held {
            return next;
        }
    }
}

/// The least-squares solution by QR, which keeps the small weights of the prior apart from rounding.
fn solve(matrix: DMatrix<f64>, right: DVector<f64>) -> Option<DVector<f64>> {
    let qr = matrix.qr();
    qr.r().solve_upper_triangular(&(qr.q().transpose() * right))
}
