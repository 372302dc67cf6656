//! Errors of sensors or impacts that explain why functions are not rigid, by Gauss and Newton.

use nalgebra::{DMatrix, DVector};
use num_complex::Complex64;

use crate::places::Places;
use crate::projection::Projection;
use crate::suspects::Spread;
use crate::{Role, Tolerance, VirtualPoint};

/// Noise is at least this part of the functions: below it nobody measures.
const LEAST_NOISE: f64 = 1e-3;

/// Eigenvalues below this part of the largest are none.
const NOTHING: f64 = 1e-9;

/// Steps of Gauss and Newton, and halvings of each.
const STEPS: usize = 12;
const HALVINGS: usize = 4;
/// χ² below which a step changes nothing.
const NEAR: f64 = 0.01;

impl VirtualPoint {
    /// For errors within this tolerance that explain these lines, which are spread so.
    pub(crate) fn search<'a>(
        &'a self,
        role: Role,
        lines: &[DMatrix<Complex64>],
        spread: &'a Spread,
        tolerance: &'a Tolerance,
    ) -> Search<'a> {
        let functions = lines.first().map_or(0, DMatrix::len) as f64;
        Search {
            weights: self.projection(role).weights(),
            length_m: self.conditioning(role).length_m,
            spread,
            numbers: 2.0 * functions * spread.lines(),
            tolerance,
        }
    }
}

/// What the functions are compared with.
pub(crate) struct Search<'a> {
    pub(crate) weights: &'a DMatrix<f64>,
    pub(crate) length_m: f64,
    pub(crate) spread: &'a Spread,
    /// Measured real numbers.
    pub(crate) numbers: f64,
    pub(crate) tolerance: &'a Tolerance,
}

/// What functions that are not rigid tell of errors, in deviations of the budget, at places.
pub(crate) struct Told {
    /// ‖(I − R T) Y‖²
    pub(crate) misfit: f64,
    pub(crate) information: DMatrix<f64>,
    pub(crate) pull: DVector<f64>,
    /// σ²
    pub(crate) noise: f64,
}

/// Errors, in deviations of the budget, and the places with them.
pub(crate) struct Start {
    pub(crate) places: Places,
    pub(crate) errors: DVector<f64>,
}

/// Errors that explain most.
pub(crate) struct Fitted {
    pub(crate) end: Start,
    /// χ²
    pub(crate) squares: f64,
    /// σ² there.
    pub(crate) noise: f64,
}

impl Search<'_> {
    pub(crate) fn told(&self, places: &Places) -> Option<Told> {
        let projection = Projection::new(
            places.matrix().clone(),
            self.weights.clone(),
            self.length_m,
            places.motions(),
        )?;
        let rest = projection.rest();
        let parameters = places.parameters();
        // (I − R T) dR_k T
        let changes: Vec<DMatrix<f64>> = (places.derivatives().iter().zip(&parameters))
            .map(|(change, one)| {
                &rest * change * projection.inverse() * self.tolerance.of(one.change)
            })
            .collect();
        let count = changes.len();
        let mut information = DMatrix::zeros(count, count);
        let mut pull = DVector::zeros(count);
        for (k, change) in changes.iter().enumerate() {
            let own = self.weights * change * &self.spread.matrix;
            for (l, other) in changes.iter().enumerate() {
                information[(k, l)] = own.dot(other);
            }
            pull[k] = own.dot(&rest);
        }
        let misfit = (self.weights * &rest * &self.spread.matrix).dot(&rest);
        // what errors of any size leave
        let eigen = information.clone().symmetric_eigen();
        let least = NOTHING * eigen.eigenvalues.max();
        let (mut left, mut rank) = (misfit, 0.0);
        for (value, vector) in (eigen.eigenvalues.iter()).zip(eigen.eigenvectors.column_iter()) {
            if *value > least {
                left -= vector.dot(&pull).powi(2) / value;
                rank += 1.0;
            }
        }
        let rows = projection.rows().nrows() as f64;
        let degrees =
            (self.numbers * (1.0 - places.motions().count() as f64 / rows) - rank).max(1.0);
        // the squares of each line are 1
        let least = LEAST_NOISE.powi(2) * self.spread.lines() / self.numbers;
        Some(Told {
            misfit,
            information,
            pull,
            noise: (left / degrees).max(least),
        })
    }

    /// By Gauss and Newton, with such 1/σ_k² in those of the budget.
    pub(crate) fn fitted(&self, start: &Start, precision: &[f64], noise: f64) -> Option<Fitted> {
        let priors = DVector::from_column_slice(precision);
        let prior = |errors: &DVector<f64>| errors.component_mul(errors).dot(&priors);
        let mut places = start.places.clone();
        let mut errors = start.errors.clone();
        let mut told = self.told(&places)?;
        let mut squares = told.misfit / noise + prior(&errors);
        for _ in 0..STEPS {
            let matrix = &told.information / noise + DMatrix::from_diagonal(&priors);
            let right = &told.pull / noise - priors.component_mul(&errors);
            let mut step = matrix.cholesky()?.solve(&right);
            let mut better = None;
            for _ in 0..HALVINGS {
                better = self.moved(&places, &step).and_then(|places| {
                    let told = self.told(&places)?;
                    let own = told.misfit / noise + prior(&(&errors + &step));
                    (own < squares).then_some((places, told, own))
                });
                if better.is_some() {
                    break;
                }
                step *= 0.5;
            }
            let Some(next) = better else { break };
            errors += step;
            let gained = squares - next.2;
            (places, told, squares) = next;
            if gained < NEAR {
                break;
            }
        }
        Some(Fitted {
            end: Start { places, errors },
            squares,
            noise: told.noise,
        })
    }

    /// Places moved by further errors, in deviations.
    pub(crate) fn moved(&self, places: &Places, step: &DVector<f64>) -> Option<Places> {
        let parameters = places.parameters();
        let errors = parameters.iter().zip(step.iter());
        let errors: Vec<f64> = errors
            .map(|(one, part)| part * self.tolerance.of(one.change))
            .collect();
        places.displaced(&errors).ok()
    }
}
