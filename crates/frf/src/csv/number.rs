//! Complex numbers of a table, as programs write them.

use bolted_joint_files::Decimal;
use num_complex::Complex64;

/// A complex number as programs write it, and what its file is now known to use: `1.2+3.4j`, `(1.2-3.4i)`, `1.2 + -3.4i`, `5j`, `1.2`.
pub(super) fn parse_complex(decimal: Decimal, text: &str) -> Option<(Complex64, Decimal)> {
    let text = text.trim();
    let inner = text
        .strip_prefix('(')
        .and_then(|text| text.strip_suffix(')'));
    let text = inner.unwrap_or(text).trim();
    let Some(parts) = text.strip_suffix(['i', 'j', 'I', 'J']) else {
        let (real, used) = decimal.parse(text)?;
        return Some((Complex64::from(real), used));
    };
    let parts = parts.trim_end().trim_end_matches('*');
    // the sign between the parts is the last one that is no exponent's
    let bytes = parts.as_bytes();
    let between = (1..bytes.len()).rev().find(|&place| {
        matches!(bytes[place], b'+' | b'-')
            && !(matches!(bytes[place - 1], b'e' | b'E') && is_digit_before(bytes, place - 1))
    });
    let (real, imaginary) = parts.split_at(between.unwrap_or(0));
    let imaginary: String = imaginary.split_whitespace().collect();
    // `1.2 + -3.4i`: a plus for every number, and then the number's own sign
    let real = match real.trim_end().strip_suffix('+') {
        Some(before) if real.ends_with(char::is_whitespace) && !before.is_empty() => before,
        _ => real,
    };
    let (real, used) = match real.trim() {
        "" => (0.0, decimal),
        real => decimal.parse(real)?,
    };
    let (imaginary, used) = match imaginary.as_str() {
        "" | "+" => (1.0, used),
        "-" => (-1.0, used),
        imaginary => used.parse(imaginary)?,
    };
    Some((Complex64::new(real, imaginary), used))
}

/// Whether what stands before this place is a number, so that the letter there is its exponent's.
fn is_digit_before(bytes: &[u8], place: usize) -> bool {
    place > 0 && (bytes[place - 1].is_ascii_digit() || matches!(bytes[place - 1], b'.' | b','))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn complex_numbers_are_those_of_numpy_matlab_and_spreadsheets() {
        for (text, real, imaginary) in [
            ("1.2+3.4j", 1.2, 3.4),
            ("1.2-3.4i", 1.2, -3.4),
            (" (1.000000000000000000e+00-2.5e-01j)", 1.0, -0.25),
            ("(-1e-3+2E+4J)", -1e-3, 2e4),
            ("1.5 + 2i", 1.5, 2.0),
            ("1.5 - 2i", 1.5, -2.0),
            ("-1.5e-7 + -2e-11i", -1.5e-7, -2e-11),
            ("-3.4i", 0.0, -3.4),
            ("1e5j", 0.0, 1e5),
            ("j", 0.0, 1.0),
            ("1-i", 1.0, -1.0),
            ("2*i", 0.0, 2.0),
            ("7", 7.0, 0.0),
            ("nan+nanj", f64::NAN, f64::NAN),
        ] {
            let (found, _) = parse_complex(Decimal::Either, text).unwrap();
            let same = |a: f64, b: f64| a == b || a.is_nan() && b.is_nan();
            assert!(
                same(found.re, real) && same(found.im, imaginary),
                "{text}: {found}"
            );
        }
        let (found, used) = parse_complex(Decimal::Either, "1,2+3,4i").unwrap();
        assert_eq!((found, used), (Complex64::new(1.2, 3.4), Decimal::Comma));
        for text in [
            "", "1+2", "1.2+3.4", "1++2j", "1,2+3.4j", "i1", "1+2jj", "(1+2j", "e-i", "1e-+2j",
            "()", "2+i3", "1+-2j", "1 - -2j", "+ -2j",
        ] {
            assert_eq!(parse_complex(Decimal::Either, text), None, "{text}");
        }
    }
}
