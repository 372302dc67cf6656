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

/// ln 2 in two parts, of which the first has so few digits that small multiples of it are exact.
const LN_2: [f64; 2] = [0.693_147_180_369_123_8, 1.908_214_929_270_587_7e-10];

/// eˣ, to two last bits.
pub(crate) fn exp(x: f64) -> f64 {
    if !(-745.2..=709.8).contains(&x) {
        return match x {
            x if x.is_nan() => x,
            x if x > 0.0 => f64::INFINITY,
            _ => 0.0,
        };
    }
    // eˣ = 2ⁿ eʳ with |r| ≤ ½ ln 2
    // rounded to a whole number, as a double of this size has no others
    const WHOLE: f64 = 6_755_399_441_055_744.0;
    let n = (x * std::f64::consts::LOG2_E + WHOLE) - WHOLE;
    let r = (x - n * LN_2[0]) - n * LN_2[1];
    let n = n as i64;
    // twice, because 2ⁿ alone may be no double
    (1.0 + less_one(r)) * power_of_two(n / 2) * power_of_two(n - n / 2)
}

/// eˣ − 1, to two last bits also where x is small.
pub(crate) fn exp_m1(x: f64) -> f64 {
    if x.abs() <= 0.5 * std::f64::consts::LN_2 {
        less_one(x)
    } else {
        exp(x) - 1.0
    }
}

/// eʳ − 1 for |r| ≤ ½ ln 2.
#[inline]
fn less_one(r: f64) -> f64 {
    // r + r² Σ rᵏ/(k+2)!, the first term left out is below 0.35¹⁴/14! < 10⁻¹⁷; in pairs, so that little waits
    const INVERSE: [f64; 12] = [
        1.0 / 2.0,
        1.0 / 6.0,
        1.0 / 24.0,
        1.0 / 120.0,
        1.0 / 720.0,
        1.0 / 5040.0,
        1.0 / 40_320.0,
        1.0 / 362_880.0,
        1.0 / 3_628_800.0,
        1.0 / 39_916_800.0,
        1.0 / 479_001_600.0,
        1.0 / 6_227_020_800.0,
    ];
    r + r * r * polynomial(&INVERSE, r)
}

/// Σ cₖ xᵏ of twelve terms, by halves.
#[inline]
fn polynomial(c: &[f64; 12], x: f64) -> f64 {
    let x2 = x * x;
    let x4 = x2 * x2;
    let four = |k: usize| (c[k] + c[k + 1] * x) + (c[k + 2] + c[k + 3] * x) * x2;
    four(0) + (four(4) + four(8) * x4) * x4
}

/// 2ⁿ for |n| ≤ 1022.
#[inline]
fn power_of_two(n: i64) -> f64 {
    f64::from_bits(((n + 1023) as u64) << 52)
}

/// ln x for x > 0, to two last bits; −∞ at 0, not a number below.
pub(crate) fn ln(x: f64) -> f64 {
    if !(x >= f64::MIN_POSITIVE && x.is_finite()) {
        return match x {
            0.0 => f64::NEG_INFINITY,
            x if x.is_nan() || x < 0.0 => f64::NAN,
            x if x.is_infinite() => x,
            // without a leading digit: x 2⁵⁴ has one
            x => ln(x * power_of_two(54)) - 54.0 * std::f64::consts::LN_2,
        };
    }
    // x = 2ⁿ m with m from √½ to √2
    const SQRT_HALF_BITS: u64 = std::f64::consts::FRAC_1_SQRT_2.to_bits();
    let above = x.to_bits().wrapping_sub(SQRT_HALF_BITS) as i64;
    let n = above >> 52;
    let mantissa = f64::from_bits(x.to_bits().wrapping_sub((n << 52) as u64));
    let n = n as f64;
    n * LN_2[0] + (ln_near_one(mantissa - 1.0) + n * LN_2[1])
}

/// ln(1 + f) for 1 + f from √½ to √2.
#[inline]
fn ln_near_one(f: f64) -> f64 {
    // ln(1+f) = 2 artanh s = 2s + s R with s = f/(2+f), R = Σ 2 s^(2k)/(2k+1), written as f − (½f² − s(½f² + R)) so that
    // f stands alone; s² < 0.03, so that the first term left out is below 10⁻¹⁸
    const TERMS: [f64; 12] = [
        2.0 / 3.0,
        2.0 / 5.0,
        2.0 / 7.0,
        2.0 / 9.0,
        2.0 / 11.0,
        2.0 / 13.0,
        2.0 / 15.0,
        2.0 / 17.0,
        2.0 / 19.0,
        2.0 / 21.0,
        2.0 / 23.0,
        2.0 / 25.0,
    ];
    let s = f / (2.0 + f);
    let square = s * s;
    let half = 0.5 * f * f;
    f - (half - s * (half + square * polynomial(&TERMS, square)))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Whether `found` is within some last bits of the C library's.
    fn is_close(found: f64, expected: f64) -> bool {
        (found - expected).abs() <= 2.0 * f64::EPSILON * expected.abs() + f64::MIN_POSITIVE
    }

    #[test]
    fn exponentials_and_logarithms_are_the_c_librarys_within_two_last_bits() {
        for k in 0..=40_000 {
            let x = 0.017_3 * f64::from(k - 20_000);
            assert!(is_close(exp(x), x.exp()), "exp {x}");
            assert!(is_close(exp_m1(x), x.exp_m1()), "exp − 1 {x}");
            let positive = exp(x);
            assert!(is_close(ln(positive), positive.ln()), "ln {positive}");
            let small = 1e-4 * x;
            assert!(is_close(exp_m1(small), small.exp_m1()), "exp − 1 {small}");
        }
        for x in [5e-324, 1e-310, f64::MIN_POSITIVE, 1.0, f64::MAX] {
            assert!(is_close(ln(x), x.ln()), "{x}");
        }
        assert_eq!(
            [exp(-800.0), exp(800.0), exp(0.0)],
            [0.0, f64::INFINITY, 1.0]
        );
        assert_eq!(
            [ln(0.0), ln(f64::INFINITY)],
            [f64::NEG_INFINITY, f64::INFINITY]
        );
        assert!(ln(-1.0).is_nan() && ln(f64::NAN).is_nan() && exp(f64::NAN).is_nan());
    }

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
