//! Numbers as Fortran prints them: D exponents, no exponent letter, no blank between neighbours.

/// A text in a data line that is no number, and the column (from 1) at which it begins.
#[derive(Debug, PartialEq)]
pub(super) struct NotANumber {
    pub(super) column: usize,
    pub(super) text: String,
}

/// One number: `1.5E-03`, `1.5D-03`, `1.5e-3`, `1.5-103` (Fortran's three-digit exponent), `.5`, `7.`, `NaN`, `Inf`.
pub(super) fn parse_number(text: &str) -> Option<f64> {
    let unsigned = text.strip_prefix(['+', '-']).unwrap_or(text);
    if ["nan", "inf", "infinity"]
        .iter()
        .any(|word| unsigned.eq_ignore_ascii_case(word))
    {
        return text.parse().ok();
    }
    let mantissa_end = unsigned
        .find(|c: char| !c.is_ascii_digit() && c != '.')
        .unwrap_or(unsigned.len());
    let (mantissa, exponent) = unsigned.split_at(mantissa_end);
    let sign = &text[..text.len() - unsigned.len()];
    if exponent.is_empty() {
        return text.parse().ok();
    }
    let digits = match exponent.strip_prefix(['E', 'e', 'D', 'd']) {
        Some(digits) => digits,
        // Without its letter the exponent has a sign and three digits, and the mantissa a point; else it is not one number.
        None if exponent.len() == 4 && mantissa.contains('.') => exponent,
        None => return None,
    };
    format!("{sign}{mantissa}e{digits}").parse().ok()
}

/// The numbers of one data line, whose format has fields of these `widths`.
///
/// Separated by blanks where that gives numbers, since many writers do not keep to the columns; by columns otherwise.
pub(super) fn parse_line(line: &str, widths: &[usize]) -> Result<Vec<f64>, NotANumber> {
    by_blanks(line).or_else(|not_a_number| by_columns(line, widths).ok_or(not_a_number))
}

fn by_blanks(line: &str) -> Result<Vec<f64>, NotANumber> {
    line.split_whitespace()
        .map(|text| {
            parse_number(text).ok_or_else(|| NotANumber {
                column: line
                    .find(text)
                    .map_or(1, |at| line[..at].chars().count() + 1),
                text: text.to_owned(),
            })
        })
        .collect()
}

fn by_columns(line: &str, widths: &[usize]) -> Option<Vec<f64>> {
    if !line.is_ascii() {
        return None;
    }
    let mut rest = line.trim_ascii_end();
    let mut numbers = Vec::with_capacity(widths.len());
    for &width in widths {
        if rest.is_empty() {
            break;
        }
        let (field, after) = rest.split_at(width.min(rest.len()));
        numbers.push(parse_number(field.trim_ascii())?);
        rest = after;
    }
    rest.is_empty().then_some(numbers)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_way_to_print_a_number_is_read() {
        for (text, value) in [
            ("1.5E-03", 1.5e-3),
            ("-1.5D+03", -1.5e3),
            ("1.5d2", 150.0),
            ("1.5-103", 1.5e-103),
            ("-1.5+103", -1.5e103),
            (".5", 0.5),
            ("7.", 7.0),
            ("+42", 42.0),
            ("0.000000000000E+00", 0.0),
        ] {
            assert_eq!(parse_number(text), Some(value), "{text}");
        }
        assert!(parse_number("NaN").unwrap().is_nan());
        assert_eq!(parse_number("-Infinity"), Some(f64::NEG_INFINITY));
        for text in [
            "",
            "-",
            "E5",
            "1.5E",
            "1.5-1",
            "15-103",
            "1.5E+001.5E+00",
            "*****",
            "0x1F",
            "1,5",
            "1.2.3",
            "--1",
        ] {
            assert_eq!(parse_number(text), None, "{text}");
        }
    }

    #[test]
    fn neighbours_without_a_blank_are_told_apart_by_their_columns() {
        let widths = [13; 6];
        let glued = "-1.23456E+123-2.50000E-103 3.00000E+00";
        assert_eq!(
            parse_line(glued, &widths),
            Ok(vec![-1.23456e123, -2.5e-103, 3.0])
        );
        let pair = "  1.00000E+00-1.123456789012E-100  2.50000E+00-9.876543210987E-100";
        assert_eq!(
            parse_line(pair, &[13, 20, 13, 20]),
            Ok(vec![1.0, -1.123456789012e-100, 2.5, -9.876543210987e-100])
        );
    }

    #[test]
    fn blanks_win_where_a_writer_ignores_the_columns() {
        // Cut into columns of 13, the first of these would be 1.2345678E-0, ten times ten times too large.
        let line = " 1.2345678901E-03 2.3456789012E-03";
        assert_eq!(
            parse_line(line, &[13; 6]),
            Ok(vec![1.2345678901e-3, 2.3456789012e-3])
        );
    }

    #[test]
    fn the_text_that_is_no_number_is_named_with_its_column() {
        let error = parse_line("  1.00000E+00  2.0000oE+00", &[13; 6]).unwrap_err();
        assert_eq!((error.column, error.text.as_str()), (16, "2.0000oE+00"));
        let error = parse_line("1.0 µ", &[13; 6]).unwrap_err();
        assert_eq!((error.column, error.text.as_str()), (5, "µ"));
        assert!(parse_line("1.00000E+002.00000E+00x", &[11; 6]).is_err());
    }

    #[test]
    fn a_blank_line_has_no_numbers() {
        assert_eq!(parse_line("    ", &[20; 4]), Ok(vec![]));
    }
}
