//! Normal equations of the estimator at one point: the step that they ask for, and whether it would still change anything.

use nalgebra::{DMatrix, DVector};

/// Change of every unknown, relative to its value or to 1/√(JᵀJ)_ii, below which the iteration has converged.
pub(super) const TOLERANCE: f64 = 1e-10;
/// Relative rounding of a computed receptance: residuals of this size are none.
const ROUNDING: f64 = 1e-13;

/// Cost, Σ|H|²/σ² of the measured receptances, JᵀJ and Jᵀr at one point.
#[derive(Clone, Debug)]
pub(super) struct Normal {
    /// The sum that is minimised.
    pub(super) cost: f64,
    pub(super) signal: f64,
    pub(super) matrix: DMatrix<f64>,
    pub(super) gradient: DVector<f64>,
}

impl Normal {
    pub(super) fn zero(size: usize) -> Self {
        Self {
            cost: 0.0,
            signal: 0.0,
            matrix: DMatrix::zeros(size, size),
            gradient: DVector::zeros(size),
        }
    }

    /// Adds what other lines contribute.
    pub(super) fn add(&mut self, other: &Self) {
        self.cost += other.cost;
        self.signal += other.signal;
        self.matrix += &other.matrix;
        self.gradient += &other.gradient;
    }

    /// The same in other unknowns, with the derivative of these by those.
    pub(super) fn in_chart(&self, derivative: &DMatrix<f64>) -> Self {
        Self {
            matrix: derivative.transpose() * &self.matrix * derivative,
            gradient: derivative.transpose() * &self.gradient,
            ..*self
        }
    }

    /// 1/√(JᵀJ)_ii: by how much each unknown changes the residual's norm by one.
    pub(super) fn scale(&self) -> DVector<f64> {
        self.matrix
            .diagonal()
            .map(|entry| entry.max(f64::MIN_POSITIVE).sqrt().recip())
    }

    /// Solution of (JᵀJ + μ diag JᵀJ) δ = Jᵀ r.
    pub(super) fn step(&self, damping: f64) -> Option<DVector<f64>> {
        self.solved(&self.gradient, damping)
    }

    /// The same with another right-hand side, in columns of unit length.
    pub(super) fn solved(&self, right: &DVector<f64>, damping: f64) -> Option<DVector<f64>> {
        let scale = self.scale();
        let mut system = scaled_by(&self.matrix, &scale);
        for i in 0..system.nrows() {
            system[(i, i)] += damping;
        }
        let right = right.component_mul(&scale);
        let factor = system.cholesky()?;
        Some(factor.solve(&right).component_mul(&scale))
    }

    /// Gain that a step with this damping promises in the linearised model.
    pub(super) fn gain(&self, step: &DVector<f64>, damping: f64) -> f64 {
        // S(p) − S(p + δ) = 2 δᵀ Jᵀ r − δᵀ JᵀJ δ, and JᵀJ δ = Jᵀ r − μ diag JᵀJ δ
        let of_damping = step.component_div(&self.scale()).norm_squared();
        step.dot(&self.gradient) + damping * of_damping
    }

    /// Gain that the full step promises in the linearised model, as a fraction of the cost.
    pub(super) fn promise(&self) -> Option<f64> {
        Some(self.step(1e-12)?.dot(&self.gradient) / self.cost)
    }

    /// Whether the full step would change nothing: no unknown moves, or the gain it promises is that fraction of the
    /// cost. A step that is short because it is damped proves nothing; the full one is damped only as far as a singular
    /// JᵀJ needs it.
    pub(super) fn is_settled(&self, unknowns: &DVector<f64>, negligible_gain: f64) -> bool {
        let Some(step) = self.step(1e-12) else {
            return false;
        };
        // S(p) − S(p + δ) = δᵀ Jᵀ r in the linearised model
        let gain = step.dot(&self.gradient);
        let negligible = negligible_gain * self.cost + ROUNDING * ROUNDING * self.signal;
        gain <= negligible
            || relative_change(unknowns, &(unknowns + step), &self.scale()) < TOLERANCE
    }
}

/// Largest change of an unknown, relative to the larger of its values and its `scale`: one that is zero but for rounding
/// does not count as moving.
pub(super) fn relative_change(
    before: &DVector<f64>,
    after: &DVector<f64>,
    scale: &DVector<f64>,
) -> f64 {
    let triples = before.iter().zip(after.iter()).zip(scale.iter());
    triples.fold(0.0, |largest, ((b, a), scale)| {
        f64::max(largest, (a - b).abs() / b.abs().max(a.abs()).max(*scale))
    })
}

/// D A D with the diagonal D.
pub(super) fn scaled_by(matrix: &DMatrix<f64>, diagonal: &DVector<f64>) -> DMatrix<f64> {
    DMatrix::from_fn(matrix.nrows(), matrix.ncols(), |i, j| {
        diagonal[i] * matrix[(i, j)] * diagonal[j]
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{dmatrix, dvector};

    fn normal(matrix: DMatrix<f64>, gradient: DVector<f64>) -> Normal {
        Normal {
            cost: 1.0,
            signal: 1.0,
            matrix,
            gradient,
        }
    }

    #[test]
    fn a_step_that_is_short_only_because_it_is_damped_is_not_the_end() {
        let normal = normal(dmatrix![4.0, 0.0; 0.0, 1e-4], dvector![0.4, 0.0]);
        let unknowns = dvector![1.0, 1.0];
        let damped = normal.step(1e12).unwrap();
        assert!(relative_change(&unknowns, &(&unknowns + damped), &normal.scale()) < TOLERANCE);
        assert!(!normal.is_settled(&unknowns, 1e-12));
    }

    #[test]
    fn the_gain_of_a_damped_step_is_that_of_the_residuals() {
        // r(δ) = r − J δ, whose squares are summed as they stand
        let jacobian = dmatrix![2.0, 0.3; -1.0, 4.0; 0.5, 1.5];
        let residual = dvector![1.0, -2.0, 0.7];
        let normal = Normal {
            cost: residual.norm_squared(),
            ..normal(
                jacobian.transpose() * &jacobian,
                jacobian.transpose() * &residual,
            )
        };
        for damping in [0.0, 1e-3, 0.5, 30.0] {
            let step = normal.step(damping).unwrap();
            let gained = normal.cost - (&residual - &jacobian * &step).norm_squared();
            let promised = normal.gain(&step, damping);
            assert!(
                (promised / gained - 1.0).abs() < 1e-12,
                "{damping}: {promised}"
            );
        }
    }

    #[test]
    fn an_unknown_that_is_zero_but_for_rounding_does_not_move() {
        let normal = normal(dmatrix![4.0, 0.0; 0.0, 1.0], dvector![4e-12, -1e-15]);
        assert!(normal.is_settled(&dvector![1.0, 1e-15], 0.0));
    }
}
