//! Pieces of HTML that every page of this program is made of: escaped text, numbers, tables, one look.

mod page;
mod paper;

pub use page::{figure, page, still};

/// The look of every page.
pub const STYLE: &str = include_str!("style.css");

/// `text` as HTML text or attribute value; characters that HTML forbids are replaced.
pub fn escaped(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            '\'' => escaped.push_str("&#39;"),
            '\n' | '\t' => escaped.push(c),
            c if c.is_control() => escaped.push('\u{fffd}'),
            c => escaped.push(c),
        }
    }
    escaped
}

/// The first letter in upper case, where the text begins with a word: a path, a symbol or a key is another one in capitals.
pub fn capitalised(text: &str) -> String {
    let first = text.split(' ').next().unwrap_or_default();
    let word = first.trim_end_matches([',', ';']);
    if !word.chars().all(|c| c.is_lowercase() || c == '-') {
        return text.to_owned();
    }
    let mut letters = text.chars();
    letters
        .next()
        .map(|first| first.to_uppercase().chain(letters).collect())
        .unwrap_or_default()
}

/// A number to six significant digits, with a power of ten where it is large or small.
pub fn number(value: f64) -> String {
    shown(value, 6)
}

/// A standard deviation to two significant digits: it is not known better.
pub fn spread(value: f64) -> String {
    shown(value, 2)
}

/// A number to so many significant digits at most, with a power of ten where it is large or small.
pub fn shown(value: f64, digits: usize) -> String {
    written(value, digits, true)
}

/// A number to as many digits as beside a standard deviation of which two are known.
pub fn beside(value: f64, deviation: f64) -> String {
    let decade = |size: f64| size.abs().log10().floor();
    let digits = decade(value) - decade(deviation) + 2.0;
    match digits.is_finite() {
        true => written(value, digits.clamp(2.0, 12.0) as usize, false),
        false => number(value),
    }
}

/// A number with its standard deviation in brackets, in units of the last digit: `6.223(96) × 10⁹`. Two digits of the deviation
/// are shown, and they say how many of the number are; by the rule of the GUM (JCGM 100:2008, 7.2.2).
pub fn with_deviation(value: f64, deviation: f64) -> String {
    if !(value.is_finite() && deviation.is_finite() && deviation > 0.0) {
        return number(value);
    }
    let decade = |size: f64| size.abs().log10().floor() as i32;
    // Rounded to two digits, a deviation can be one decade larger.
    let rounded = |size: f64| format!("{size:.1e}").parse::<f64>().unwrap_or(size);
    let last = decade(rounded(deviation)) - 1;
    let largest = match value {
        0.0 => decade(deviation),
        _ => decade(value).max(decade(deviation)),
    };
    let power = match largest {
        -3..=5 => 0,
        power => power,
    };
    // Digits after the point: none where the deviation is as large as tens.
    let decimals = (power - last).max(0) as usize;
    let unit = 10_f64.powi(last);
    let (value, deviation) = (
        (value / unit).round() * unit,
        (deviation / unit).round() * unit,
    );
    let scale = 10_f64.powi(power);
    // Adding zero takes the sign of a zero away.
    let mantissa = format!("{:.decimals$}", value / scale + 0.0).replace('-', "−");
    let bracket = match decimals {
        // Digits on both sides of the point are written with it.
        1.. if deviation / scale >= 1.0 => format!("{:.decimals$}", deviation / scale),
        1.. => format!("{:.0}", deviation / unit),
        0 => format!("{:.0}", deviation / scale),
    };
    match power {
        0 => format!("{mantissa}({bracket})"),
        _ => format!(
            "{mantissa}({bracket}) × 10<sup>{}</sup>",
            power.to_string().replace('-', "−")
        ),
    }
}

fn written(value: f64, digits: usize, without_zeros: bool) -> String {
    let rounded = format!("{value:.*e}", digits.saturating_sub(1));
    let Some((mantissa, exponent)) = rounded.split_once('e') else {
        return rounded;
    };
    let short = |text: &str| {
        let text = if without_zeros && text.contains('.') {
            text.trim_end_matches('0').trim_end_matches('.')
        } else {
            text
        };
        let is_zero = !text.contains(|c: char| c.is_ascii_digit() && c != '0');
        let text = text.strip_prefix('-').filter(|_| is_zero).unwrap_or(text);
        text.replace('-', "−")
    };
    match exponent.parse::<i32>() {
        Ok(power @ -3..=5) => {
            let decimals = (digits as i32 - 1 - power).max(0) as usize;
            short(&format!("{value:.decimals$}"))
        }
        Ok(_) => format!(
            "{} × 10<sup>{}</sup>",
            short(mantissa),
            exponent.replace('-', "−")
        ),
        Err(_) => rounded,
    }
}

/// How far the criterion of a model is above the best one's: small differences decide, of large ones the size is enough.
pub fn above_the_best(difference: f64) -> String {
    match difference.abs() {
        0.0..100.0 => format!("{difference:.1}"),
        _ => shown(difference, 3),
    }
}

/// A fraction in per cent: three digits say enough of a residual.
pub fn percent(fraction: f64) -> String {
    format!("{} %", shown(100.0 * fraction, 3))
}

/// A number and its unit.
pub fn quantity(value: f64, unit: &str) -> String {
    format!("{} {unit}", number(value))
}

/// A table; `rows` hold finished cells, `<td>…</td>`.
pub fn table(headings: &[&str], rows: &[String]) -> String {
    let headings: String = headings
        .iter()
        .map(|heading| format!("<th>{heading}</th>"))
        .collect();
    let style = paper::style(&headings, rows);
    let rows: String = rows.iter().map(|row| format!("<tr>{row}</tr>\n")).collect();
    format!(
        "<div class=\"scroll\"><table{style}>\n<thead><tr>{headings}</tr></thead>\n<tbody>\n{rows}</tbody>\n</table></div>\n"
    )
}

/// Headings of a table that are parted by bars.
pub fn columns(headings: &str) -> Vec<&str> {
    headings.split('|').collect()
}

/// A cell of finished HTML.
pub fn cell(html: &str) -> String {
    // A path may break where a word may not.
    let is_long = |word: &str| word.chars().count() > LONGEST_WORD;
    match html.split([' ', '\n', '<', '>']).any(is_long) {
        true => format!("<td class=\"long\">{html}</td>"),
        false => format!("<td>{html}</td>"),
    }
}

/// A word of more letters is a path or a sum.
const LONGEST_WORD: usize = 24;

/// A cell whose content is aligned as numbers are.
pub fn number_cell(html: &str) -> String {
    format!("<td class=\"number\">{html}</td>")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_cannot_leave_its_place() {
        assert_eq!(
            escaped("<script>\"&'\u{7}</script>"),
            "&lt;script&gt;&quot;&amp;&#39;\u{fffd}&lt;/script&gt;"
        );
    }

    #[test]
    fn deviations_are_shorter() {
        for (value, expected) in [
            (268.147, "268"),
            (0.152_178, "0.15"),
            (1.381e-4, "1.4 × 10<sup>−4</sup>"),
        ] {
            assert_eq!(spread(value), expected);
        }
    }

    #[test]
    fn values_have_the_digits_of_their_deviation() {
        for (value, deviation, expected) in [
            (572_892.0, 271.0, "572892"),
            (5818.123, 7.0, "5818.1"),
            (10.0, 0.15, "10.00"),
            (-0.8333, 0.004_4, "−0.8333"),
            (4.5678e8, 1.2e6, "4.568 × 10<sup>8</sup>"),
            (0.0, 1.0, "0"),
            (3.25, 0.0, "3.25"),
            (3.25, f64::INFINITY, "3.25"),
        ] {
            assert_eq!(beside(value, deviation), expected);
        }
    }

    #[test]
    fn digits_follow_the_deviation() {
        for (value, deviation, expected) in [
            (6.2234e9, 9.6e7, "6.223(96) × 10<sup>9</sup>"),
            (572_878.2, 270.4, "572880(270)"),
            (1290.048, 0.131, "1290.05(13)"),
            (-0.8333, 0.004_41, "−0.8333(44)"),
            (10.784, 0.149, "10.78(15)"),
            (5817.8, 7.02, "5817.8(7.0)"),
            (0.0, 6.5e6, "0.0(6.5) × 10<sup>6</sup>"),
            (-1.5e5, 6.5e6, "−0.2(6.5) × 10<sup>6</sup>"),
            // 0.0996 is 0.10 to two digits, not 0.100
            (1.234, 0.0996, "1.23(10)"),
            (27_347.0, 6062.0, "27300(6100)"),
            (-0.3, 100.0, "0(100)"),
            (3.25, 0.0, "3.25"),
            (3.25, f64::INFINITY, "3.25"),
        ] {
            assert_eq!(with_deviation(value, deviation), expected);
        }
    }

    #[test]
    fn numbers_are_short() {
        for (value, expected) in [
            (0.0, "0"),
            (-0.83, "−0.83"),
            (573_000.0, "573000"),
            (4.56e6, "4.56 × 10<sup>6</sup>"),
            (2e-5, "2 × 10<sup>−5</sup>"),
            (0.083, "0.083"),
            (1.0 / 3.0, "0.333333"),
            (999_999.99, "1 × 10<sup>6</sup>"),
            (100.0, "100"),
            (-0.0, "0"),
        ] {
            assert_eq!(number(value), expected);
        }
        assert_eq!(shown(-1e-3, 3), "−0.001");
    }

    #[test]
    fn large_criteria_are_short() {
        for (difference, expected) in [
            (0.0, "0.0"),
            (9.96, "10.0"),
            (1234.5, "1234"),
            (1_545_443_991.8, "1.55 × 10<sup>9</sup>"),
        ] {
            assert_eq!(above_the_best(difference), expected);
        }
    }

    #[test]
    fn paths_may_break_and_words_may_not() {
        let path = "measurements/of-the-whole-lap-joint.uff";
        assert_eq!(cell(path), format!("<td class=\"long\">{path}</td>"));
        assert_eq!(
            cell("relative displacement"),
            "<td>relative displacement</td>"
        );
    }

    #[test]
    fn what_is_no_word_keeps_its_first_letter() {
        for (text, expected) in [
            ("a point is missing", "A point is missing"),
            ("positions, not gains", "Positions, not gains"),
            ("re-made", "Re-made"),
            ("χ² is 3", "χ² is 3"),
            (
                "w/pl/a_fd.csv: states no units",
                "w/pl/a_fd.csv: states no units",
            ),
            ("c_ytheta = 3 has", "c_ytheta = 3 has"),
            ("noise.relative: too much", "noise.relative: too much"),
            ("a: rank 5", "a: rank 5"),
            ("", ""),
        ] {
            assert_eq!(capitalised(text), expected);
        }
    }
}
