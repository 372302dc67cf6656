//! Elementary functions from exactly rounded operations alone: the C libraries' own differ in their last bits, so
//! that an FMU would give other numbers on another platform, and their newest versions keep it from older systems.

/// √(a² + b²), also where a square alone overflows or vanishes.
pub(crate) fn hypotenuse(a: f64, b: f64) -> f64 {
    let (a, b) = (a.abs(), b.abs());
    let (longer, shorter) = if a >= b { (a, b) } else { (b, a) };
    if longer == 0.0 || !longer.is_finite() {
        return longer;
    }
    // √(a² + b²) = a √(1 + (b/a)²)
    let ratio = shorter / longer;
    longer * (1.0 + ratio * ratio).sqrt()
}

/// eˣ for x ≥ 0, to a relative 10⁻¹².
pub(crate) fn exponential(x: f64) -> f64 {
    // eˣ = (e^(x/2ⁿ))^(2ⁿ), with n so that x/2ⁿ ≤ ½
    let mut reduced = x.min(f64::MAX_EXP.into());
    let mut halvings = 0;
    while reduced > 0.5 {
        reduced *= 0.5;
        halvings += 1;
    }
    // Σ xᵏ/k!, the first term left out is below 0.5¹⁵/15! < 10⁻¹⁶
    let mut power = 1.0;
    for order in (1..15).rev() {
        power = 1.0 + power * reduced / f64::from(order);
    }
    for _ in 0..halvings {
        power *= power;
    }
    power
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_hypotenuse_is_the_c_librarys_within_two_last_bits() {
        for (a, b) in [
            (3.0, 4.0),
            (-3.0, 4.0),
            (1.0, 1.0),
            (1e300, 1e300),
            (1e-300, -2e-300),
            (5e-324, 0.0),
            (1e10, 1e-10),
            (0.0, -7.0),
            (0.1, 0.7),
        ] {
            let expected = f64::hypot(a, b);
            let found = hypotenuse(a, b);
            let unit = expected * f64::EPSILON;
            assert!((found - expected).abs() <= 2.0 * unit, "{a} {b}: {found}");
        }
        assert_eq!(hypotenuse(0.0, 0.0), 0.0);
        assert_eq!(hypotenuse(f64::NEG_INFINITY, 1.0), f64::INFINITY);
        assert!(hypotenuse(f64::NAN, 1.0).is_nan());
        assert!(hypotenuse(1.0, f64::NAN).is_nan());
    }

    #[test]
    fn the_exponential_is_the_c_librarys() {
        for x in [0.0, 1e-300, 1e-9, 0.3, 0.5, 1.0, 2.785, 20.0, 300.5, 709.7] {
            let error = exponential(x) / x.exp() - 1.0;
            assert!(error.abs() < 1e-12, "{x}: {error:e}");
        }
        assert_eq!(exponential(710.0), f64::INFINITY);
        assert_eq!(exponential(f64::INFINITY), f64::INFINITY);
    }
}
