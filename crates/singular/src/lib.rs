//! Decompositions in singular values that come to an end. Those of `nalgebra` do not where a number is not finite: they seek for
//! ever. Clippy refuses them elsewhere; they are compiled here, once for all crates.
#![forbid(unsafe_code)]
// the one place where they may be called
#![allow(clippy::disallowed_methods)]

use nalgebra::{ComplexField, DMatrix, DVector, Dyn, SVD};
use num_complex::Complex64;

/// When a value has come to rest, as in `nalgebra`.
const AT_REST: f64 = 5.0 * f64::EPSILON;
/// Steps for each number of the matrix, where a few for each singular value are usual.
const STEPS: usize = 1000;

/// Singular values with their vectors, the largest first. `None` where a number is not finite, or the matrix is empty.
#[must_use]
pub fn real(matrix: DMatrix<f64>) -> Option<SVD<f64, Dyn, Dyn>> {
    decomposed(matrix)
}

/// As [`real`], of a complex matrix.
#[must_use]
pub fn complex(matrix: DMatrix<Complex64>) -> Option<SVD<Complex64, Dyn, Dyn>> {
    decomposed(matrix)
}

fn decomposed<T: ComplexField<RealField = f64>>(matrix: DMatrix<T>) -> Option<SVD<T, Dyn, Dyn>> {
    if matrix.is_empty() || !matrix.iter().all(ComplexField::is_finite) {
        return None;
    }
    let steps = STEPS * matrix.len();
    matrix.try_svd(true, true, AT_REST, steps)
}

/// The pseudo-inverse in which singular values up to `least` are none. `None` where a number is not finite.
#[must_use]
pub fn pseudo_inverse(matrix: DMatrix<f64>, least: f64) -> Option<DMatrix<f64>> {
    real(matrix)?.pseudo_inverse(least).ok()
}

/// The least squares of a matrix times x beside `right`, of which the smallest x. Singular values up to `least` are none. `None` where
/// a number is not finite.
#[must_use]
pub fn solution(matrix: DMatrix<f64>, right: &DVector<f64>, least: f64) -> Option<DVector<f64>> {
    real(matrix)?.solve(right, least).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_matrix_is_the_product_of_what_it_is_decomposed_in() {
        let matrix = DMatrix::from_fn(5, 3, |i, j| {
            Complex64::new((i * j) as f64, (i + 2 * j) as f64)
        });
        let found = complex(matrix.clone()).unwrap().recompose().unwrap();
        assert!((found - matrix).norm() < 1e-13);
    }

    /// Rank 2: the smallest of all x with x₁ + x₂ = 2, x₃ = 3.
    #[test]
    fn what_is_not_determined_is_smallest() {
        let matrix = DMatrix::from_row_slice(2, 3, &[1.0, 1.0, 0.0, 0.0, 0.0, 1.0]);
        let right = DVector::from_vec(vec![2.0, 3.0]);
        let found = solution(matrix.clone(), &right, 1e-12).unwrap();
        assert!((found - DVector::from_vec(vec![1.0, 1.0, 3.0])).norm() < 1e-14);
        let inverse = pseudo_inverse(matrix, 1e-12).unwrap();
        let expected = DMatrix::from_row_slice(3, 2, &[0.5, 0.0, 0.5, 0.0, 0.0, 1.0]);
        assert!((inverse - expected).norm() < 1e-14);
    }

    #[test]
    fn what_is_not_finite_has_none() {
        for bad in [f64::NAN, f64::INFINITY] {
            for place in 0..12 {
                let mut matrix = DMatrix::from_fn(4, 3, |i, j| ((3 * i + j) as f64).sin());
                matrix[place] = bad;
                assert!(complex(matrix.map(Complex64::from)).is_none());
                assert!(pseudo_inverse(matrix.clone(), 0.0).is_none());
                assert!(real(matrix).is_none());
            }
        }
        assert!(real(DMatrix::zeros(0, 3)).is_none());
    }
}
