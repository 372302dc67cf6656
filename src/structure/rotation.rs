//! Rotational receptances from translations measured at neighbouring points.

use num_complex::Complex64;

use super::coupling::ComplexMatrix;

/// Second-order central difference over three equally spaced points (Tol 3.53).
///
/// The rotation at the middle point is (w₃ − w₁)/(2s): the order of the points sets the sign of θ.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CentralDifference {
    /// Distance between neighbouring points, m.
    pub spacing_m: f64,
}

impl CentralDifference {
    /// T (2×3) with (w₂, θ₂) = T (w₁, w₂, w₃).
    ///
    /// Receptances at the middle point are T H Tᵀ (Tol 3.54), those between it and other points T H.
    #[must_use]
    pub fn transformation(&self) -> ComplexMatrix {
        // T = 1/(2s) [0 2s 0; −1 0 1]   (Tol 3.53)
        let slope = 0.5 / self.spacing_m;
        ComplexMatrix::from_row_slice(
            2,
            3,
            &[0.0, 1.0, 0.0, -slope, 0.0, slope].map(Complex64::from),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_quadratic_field_is_differentiated_exactly() {
        // w(x) = 3 + 2x + 5x² at x = −s, 0, s has w = 3 and ∂w/∂x = 2 at the middle.
        let s = 0.015;
        let field = |x: f64| 3.0 + 2.0 * x + 5.0 * x * x;
        let w = [field(-s), field(0.0), field(s)];
        let measured = ComplexMatrix::from_fn(3, 3, |p, q| Complex64::from(w[p] * w[q]));
        let transformation = CentralDifference { spacing_m: s }.transformation();
        let found = &transformation * measured * transformation.transpose();
        for (place, expected) in [((0, 0), 9.0), ((0, 1), 6.0), ((1, 0), 6.0), ((1, 1), 4.0)] {
            assert!((found[place].re - expected).abs() < 1e-10);
        }
    }
}
