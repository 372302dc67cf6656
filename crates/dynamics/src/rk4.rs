//! How long the steps of the classical Runge–Kutta method of fourth order may be: accuracy, stability, number.

use std::num::NonZeroU32;

/// Longest |hλ| for which RK4 stays stable on the negative real axis.
pub const STABILITY_LIMIT_REAL: f64 = 2.785_293_563_405_282;

/// Longest |hλ| for which RK4 stays stable on the imaginary axis: 2√2.
pub const STABILITY_LIMIT_IMAGINARY: f64 = 2.0 * std::f64::consts::SQRT_2;

/// Phase error (rad) that the recommended step allows over one period of the fastest mode.
pub const PHASE_ERROR_PER_PERIOD: f64 = 1e-6;

/// Number of equal substeps, none longer than `step_size_max_s`, that cover `interval_s`.
///
/// Both are in s. A remainder below 1e-9 of a step is taken for rounding of the interval and gives no extra
/// substep. `None` if an argument is not positive and finite or the number does not fit.
#[must_use]
pub fn substeps(interval_s: f64, step_size_max_s: f64) -> Option<NonZeroU32> {
    let positive = |value: f64| value.is_finite() && value > 0.0;
    if !positive(interval_s) || !positive(step_size_max_s) {
        return None;
    }
    let ratio = interval_s / step_size_max_s;
    // n = ⌈H/h_max⌉
    let count = (ratio * (1.0 - 1e-15) - 1e-9).ceil().max(1.0);
    if count > f64::from(u32::MAX) {
        return None;
    }
    NonZeroU32::new(count as u32)
}

/// Longest |hλ| at which the phase error over one period stays within [`PHASE_ERROR_PER_PERIOD`].
pub(crate) fn accurate_h_lambda() -> f64 {
    // Amplification R(iz) = e^{iz} (1 − i z⁵/120 + …): over 2π/z steps the phase drifts by 2π z⁴/120.
    (PHASE_ERROR_PER_PERIOD * 120.0 / std::f64::consts::TAU)
        .sqrt()
        .sqrt()
}

/// Squared modulus of RK4's amplification of a mode with hλ = `real` + j `imaginary`.
pub(crate) fn amplification_squared(real: f64, imaginary: f64) -> f64 {
    // R(z) = 1 + z (1 + z/2 (1 + z/3 (1 + z/4)))
    let (mut re, mut im) = (1.0, 0.0);
    for order in [4.0, 3.0, 2.0, 1.0] {
        let product_re = (real * re - imaginary * im) / order;
        let product_im = (real * im + imaginary * re) / order;
        (re, im) = (1.0 + product_re, product_im);
    }
    re * re + im * im
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_amplification_is_the_fourth_order_taylor_polynomial() {
        let z: f64 = -0.3;
        let taylor = 1.0 + z + z * z / 2.0 + z.powi(3) / 6.0 + z.powi(4) / 24.0;
        assert!((amplification_squared(z, 0.0) - taylor * taylor).abs() < 1e-15);
    }

    #[test]
    fn the_stability_limits_are_where_the_amplification_is_one() {
        assert!((amplification_squared(-STABILITY_LIMIT_REAL, 0.0) - 1.0).abs() < 1e-12);
        assert!((amplification_squared(0.0, STABILITY_LIMIT_IMAGINARY) - 1.0).abs() < 1e-12);
    }

    #[test]
    fn the_recommended_step_drifts_by_a_millionth_of_a_radian_in_a_period() {
        let z = accurate_h_lambda();
        let (mut re, mut im) = (1.0, 0.0);
        for order in [4.0, 3.0, 2.0, 1.0] {
            (re, im) = (1.0 - z * im / order, z * re / order);
        }
        let drift = (f64::atan2(im, re) - z).abs() * std::f64::consts::TAU / z;
        assert!(
            (drift / PHASE_ERROR_PER_PERIOD - 1.0).abs() < 0.01,
            "{drift}"
        );
    }

    #[test]
    fn substeps_ignore_the_last_digits_of_the_interval() {
        let count = |interval, longest| substeps(interval, longest).map(NonZeroU32::get);
        assert_eq!(count(1e-3, 2e-5), Some(50));
        assert_eq!(count(0.1 + 0.2, 0.1), Some(3));
        assert_eq!(count(1.0000001e-3, 2e-5), Some(51));
        assert_eq!(count(1e-6, 1.0), Some(1));
        assert_eq!(count(1e9, 1e-6), None);
        for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert_eq!(count(bad, 1.0), None);
            assert_eq!(count(1.0, bad), None);
        }
    }
}
