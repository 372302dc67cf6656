//! The exponential of a matrix, for propagators that are exact at any length of step.

use super::matrix::Matrix;

/// ‖A‖₁ up to which Padé's approximant of order 13 is exact to rounding (Higham, SIAM J. Matrix Anal. Appl. 26 (2005) 1179,
/// table 2.3).
const LARGEST_NORM: f64 = 5.371_920_351_148_152;

/// Coefficients of that approximant (there, (2.1) with m = 13).
const PADE: [f64; 14] = [
    64_764_752_532_480_000.0,
    32_382_376_266_240_000.0,
    7_771_770_303_897_600.0,
    1_187_353_796_428_800.0,
    129_060_195_264_000.0,
    10_559_470_521_600.0,
    670_442_572_800.0,
    33_522_128_640.0,
    1_323_241_920.0,
    40_840_800.0,
    960_960.0,
    16_380.0,
    182.0,
    1.0,
];

/// e^A by scaling and squaring; `None` where it is not finite.
pub(super) fn exponential(matrix: &Matrix) -> Option<Matrix> {
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
    let mut result = approximant(&matrix.times(0.5_f64.powi(halvings)))?;
    for _ in 0..halvings {
        result = result.product(&result);
    }
    result.is_finite().then_some(result)
}

/// (V − U)⁻¹ (V + U), with U the odd and V the even part of the numerator.
fn approximant(a: &Matrix) -> Option<Matrix> {
    let one = Matrix::identity(a.rows());
    let a2 = a.product(a);
    let a4 = a2.product(&a2);
    let a6 = a4.product(&a2);
    // A⁶ (b₊₆ A⁶ + b₊₄ A⁴ + b₊₂ A²) + b₆ A⁶ + b₄ A⁴ + b₂ A² + b₀, with the odd coefficients one place further
    let part = |first: usize| {
        let b = |n: usize| PADE[n + first];
        let high = a6.times(b(12)).plus(b(10), &a4).plus(b(8), &a2);
        a6.product(&high)
            .plus(b(6), &a6)
            .plus(b(4), &a4)
            .plus(b(2), &a2)
            .plus(b(0), &one)
    };
    let (odd, even) = (a.product(&part(1)), part(0));
    even.plus(-1.0, &odd).solved(even.plus(1.0, &odd))
}

#[cfg(test)]
mod tests {
    use super::*;

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
