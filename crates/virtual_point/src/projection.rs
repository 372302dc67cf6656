//! T of rows and weights: the least squares that find six motions, or those of a plane, in many channels.

use bolted_joint_space::Motions;
use nalgebra::DMatrix;

/// T = (Rᵀ W R)⁻¹ Rᵀ W, 6 × n, so that T R = I. Of impacts, T_f is its transpose. Rows of motions that the virtual point does
/// not have are zero.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Projection {
    rows: DMatrix<f64>,
    weights: DMatrix<f64>,
    inverse: DMatrix<f64>,
    /// (Rᵀ W R)⁻¹
    normal: DMatrix<f64>,
    motions: Motions,
}

impl Projection {
    /// Rows of the motions' rank, weights that are symmetric and positive definite; `length_m` scales rotations. None if that
    /// does not hold after all.
    pub(crate) fn new(
        rows: DMatrix<f64>,
        weights: DMatrix<f64>,
        length_m: f64,
        motions: Motions,
    ) -> Option<Self> {
        let scale = |j: usize| if j < 3 { 1.0 } else { 1.0 / length_m };
        let own = motions.rows();
        let count = own.len();
        // W = L Lᵀ; Lᵀ R s = Q U; T = s U⁻¹ Qᵀ Lᵀ, without squaring the condition number
        let root = weights.clone().cholesky()?.l().transpose();
        let scaled = DMatrix::from_fn(rows.nrows(), count, |i, j| {
            rows[(i, own[j])] * scale(own[j])
        });
        let decomposed = (&root * scaled).qr();
        let triangle = decomposed.r();
        let orthogonal = decomposed.q().transpose() * root;
        let solved = triangle.solve_upper_triangular(&orthogonal)?;
        let of_unit = triangle.solve_upper_triangular(&DMatrix::identity(count, count))?;
        let mut inverse = DMatrix::zeros(6, rows.nrows());
        let mut half = DMatrix::zeros(6, count);
        for (at, &j) in own.iter().enumerate() {
            inverse.set_row(j, &(solved.row(at) * scale(j)));
            half.set_row(j, &(of_unit.row(at) * scale(j)));
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
            motions,
        })
    }

    /// The motions that are found.
    pub(crate) fn motions(&self) -> Motions {
        self.motions
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
