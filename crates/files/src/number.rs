//! Numbers for the terminal.

/// A number with `digits` significant digits, in the form that is easier to read.
#[must_use]
pub fn number(value: f64, digits: usize) -> String {
    if value == 0.0 || !value.is_finite() {
        return value.to_string();
    }
    let exponent = value.abs().log10().floor() as i32;
    if (-3..6).contains(&exponent) {
        let decimals = (digits as i32 - 1 - exponent).max(0) as usize;
        format!("{value:.decimals$}")
    } else {
        format!("{value:.*e}", digits.saturating_sub(1))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_keep_their_digits() {
        assert_eq!(number(573_012.3, 5), "573012");
        assert_eq!(number(0.083_04, 3), "0.0830");
        assert_eq!(number(-8.263, 3), "-8.26");
        assert_eq!(number(4.56e9, 3), "4.56e9");
        assert_eq!(number(1e-7, 2), "1.0e-7");
        assert_eq!(number(0.0, 3), "0");
    }
}
