//! T of rows and weights: the least squares that find six motions in many channels.

use nalgebra::DMatrix;

/// T = (Rᵀ W R)⁻¹ Rᵀ W, 6 × n, so that T R = I. Of impacts, T_f is its transpose.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Projection {
    rows: DMatrix<f64>,
    weights: DMatrix<f64>,
    inverse: DMatrix<f64>,
    /// (Rᵀ W R)⁻¹
    normal: DMatrix<f64>,
}

impl Projection {
    /// Rows of rank six, weights that are symmetric and positive definite; `length_m` scales rotations. None if that
    /// does not hold after all.
    pub(crate) fn new(rows: DMatrix<f64>, weights: DMatrix<f64>, length_m: f64) -> Option<Self> {
        let scale = |j: usize| if j < 3 { 1.0 } else { 1.0 / length_m };
        // W = L Lᵀ; Lᵀ R s = Q U; T = s U⁻¹ Qᵀ Lᵀ, without squaring the condition number
        let root = weights.clone().cholesky()?.l().transpose();
        let scaled = DMatrix::from_fn(rows.nrows(), 6, |i, j| rows[(i, j)] * scale(j));
        let decomposed = (&root * scaled).qr();
        let triangle = decomposed.r();
        let orthogonal = decomposed.q().transpose() * root;
        let mut inverse = triangle.solve_upper_triangular(&orthogonal)?;
        let mut half = triangle.solve_upper_triangular(&DMatrix::identity(6, 6))?;
        for j in 3..6 {
            inverse.row_mut(j).scale_mut(scale(j));
            half.row_mut(j).scale_mut(scale(j));
        }
        let normal = &half * half.transpose();
        let finite = inverse
            .iter()
            .chain(&normal)
            .all(|number| number.is_finite());
        finite.then_some(Self {
            rows,
            weights,
            inverse,
            normal,
        })
    }

    /// R, n × 6.
    pub(crate) fn rows(&self) -> &DMatrix<f64> {
        &self.rows
    }

    /// W, n × n.
    pub(crate) fn weights(&self) -> &DMatrix<f64> {
        &self.weights
    }

    /// T, 6 × n.
    pub(crate) fn inverse(&self) -> &DMatrix<f64> {
        &self.inverse
    }

    /// F = R T, n × n: what of the channels' motions is that of a rigid interface.
    pub(crate) fn rigid(&self) -> DMatrix<f64> {
        &self.rows * &self.inverse
    }

    /// I − F.
    pub(crate) fn rest(&self) -> DMatrix<f64> {
        let count = self.rows.nrows();
        DMatrix::identity(count, count) - self.rigid()
    }

    /// dT of a change dR: dT = (Rᵀ W R)⁻¹ dRᵀ W (I − R T) − T dR T, from dT R + T dR = 0 and the derivative of the
    /// normal equations.
    pub(crate) fn change(&self, rows: &DMatrix<f64>) -> DMatrix<f64> {
        let of_rest = &self.normal * (rows.transpose() * (&self.weights * self.rest()));
        of_rest - &self.inverse * (rows * &self.inverse)
    }
}
