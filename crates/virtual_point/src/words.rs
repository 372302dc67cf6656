//! Numbers in sentences: short, and without a zero that has a sign.

/// Four significant digits.
pub(crate) fn short(number: f64) -> String {
    if number == 0.0 || !number.is_finite() {
        return format!("{}", number + 0.0);
    }
    let digits = 3 - number.abs().log10().floor() as i32;
    let scale = 10_f64.powi(digits);
    let rounded = (number * scale).round() / scale;
    format!("{}", rounded + 0.0)
}

/// Three components in brackets; what is nothing beside the largest one is 0.
pub(crate) fn triple(components: &[f64; 3]) -> String {
    let largest = components.iter().fold(0.0_f64, |most, c| most.max(c.abs()));
    let words = components.map(|component| {
        short(if component.abs() < 1e-6 * largest {
            0.0
        } else {
            component
        })
    });
    format!("({})", words.join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short_and_zero_has_no_sign() {
        assert_eq!(short(0.123_456), "0.1235");
        assert_eq!(short(-12_345.6), "-12350");
        assert_eq!(short(-0.0), "0");
        assert_eq!(short(f64::NAN), "NaN");
        assert_eq!(triple(&[0.02, -1e-18, 0.6]), "(0.02, 0, 0.6)");
    }
}
