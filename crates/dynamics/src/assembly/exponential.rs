//! The exponential of a matrix, for propagators that are exact at any length of step.
//!
//! What is computed is its growth, e^A − 1: that of short steps is small beside one and keeps its own digits when the length is
//! doubled again and again.

use super::matrix::Matrix;

/// ‖A‖₁ up to which Taylor's polynomial of order 10 is exact to rounding: already the ninth term is below 3·10⁻¹⁷ ‖A‖₁. The tenth is
/// the least that what is integrated ten times over has.
const LARGEST_NORM: f64 = 0.0625;

/// How e^A grows with A: e^A − 1.
#[derive(Clone, Debug)]
pub(super) struct Growth(Matrix);

impl Growth {
    /// That of a matrix; `None` where it is not finite.
    pub(super) fn of(matrix: &Matrix) -> Option<Self> {
        let norm = matrix.norm();
        if !norm.is_finite() {
            return None;
        }
        let mut halvings = 0;
        let mut scaled = norm;
        while scaled > LARGEST_NORM {
            scaled *= 0.5;
            halvings += 1;
        }
        let mut growth = Self(polynomial(&matrix.times(0.5_f64.powi(halvings))));
        for _ in 0..halvings {
            growth = growth.doubled()?;
        }
        growth.0.is_finite().then_some(growth)
    }

    /// That of twice the matrix: (1 + F)² − 1 = 2F + F²; `None` where it is not finite.
    pub(super) fn doubled(&self) -> Option<Self> {
        let doubled = self.0.product(&self.0).plus(2.0, &self.0);
        doubled.is_finite().then_some(Self(doubled))
    }

    /// An entry of e^A.
    pub(super) fn exponential(&self, i: usize, j: usize) -> f64 {
        self.0[(i, j)] + if i == j { 1.0 } else { 0.0 }
    }
}

/// Σ Aᵏ/k!, k = 1 to 10.
fn polynomial(a: &Matrix) -> Matrix {
    let a2 = a.product(a);
    let a3 = a2.product(a);
    let a4 = a2.product(&a2);
    // A + A²/2 + A³/6 + A⁴/24 + A⁴ (A/5! + A²/6! + A³/7! + A⁴/8! + A⁴ (A/9! + A²/10!))
    let highest = a.times(1.0 / 362_880.0).plus(1.0 / 3_628_800.0, &a2);
    let high = a
        .times(1.0 / 120.0)
        .plus(1.0 / 720.0, &a2)
        .plus(1.0 / 5040.0, &a3)
        .plus(1.0 / 40_320.0, &a4)
        .plus(1.0, &a4.product(&highest));
    a4.product(&high)
        .plus(1.0 / 24.0, &a4)
        .plus(1.0 / 6.0, &a3)
        .plus(0.5, &a2)
        .plus(1.0, a)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn exponential(matrix: &Matrix) -> Option<Matrix> {
        let growth = Growth::of(matrix)?;
        Some(Matrix::from_fn(matrix.rows(), matrix.rows(), |i, j| {
            growth.exponential(i, j)
        }))
    }

    fn of(rows: [[f64; 2]; 2]) -> Matrix {
        Matrix::from_fn(2, 2, |i, j| rows[i][j])
    }

    #[test]
    fn it_is_the_rotation_of_an_oscillator() {
        for angle in [1e-9_f64, 0.3, 5.0, 40.0, 1000.0] {
            let found = exponential(&of([[0.0, angle], [-angle, 0.0]])).unwrap();
            let (sine, cosine) = angle.sin_cos();
            let expected = of([[cosine, sine], [-sine, cosine]]);
            // an angle is known to its last bit, and what is squared doubles its error
            let tolerance = 1e-15 * (1.0 + angle);
            assert!(found.plus(-1.0, &expected).norm() < tolerance, "{angle}");
        }
    }

    #[test]
    fn a_nilpotent_matrix_gives_its_polynomial() {
        // exp [[0, a], [0, 0]] = [[1, a], [0, 1]], with each entry right by itself
        for a in [1e-20, 1.0, 1e6] {
            let found = exponential(&of([[0.0, a], [0.0, 0.0]])).unwrap();
            assert!((found[(0, 1)] / a - 1.0).abs() < 1e-14, "{a}");
            assert_eq!((found[(1, 0)], found[(0, 0)]), (0.0, 1.0));
        }
    }

    #[test]
    fn what_overflows_is_none() {
        assert_eq!(exponential(&of([[1e4, 0.0], [0.0, 0.0]])), None);
        assert_eq!(exponential(&of([[f64::NAN, 0.0], [0.0, 0.0]])), None);
    }
}
