//! Numbers in cells of a table, with a decimal point or a decimal comma, but not both in one file.

/// How decimals are marked in a file, as far as its numbers have shown it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Decimal {
    /// Whole numbers only so far, in a file whose separator leaves the comma free.
    Either,
    /// A decimal point.
    Point,
    /// A decimal comma.
    Comma,
}

impl Decimal {
    /// What may mark decimals in a table whose cells are parted by this character.
    #[must_use]
    pub fn beside(separator: char) -> Self {
        match separator {
            ',' => Self::Point,
            _ => Self::Either,
        }
    }

    /// The number, and what its file is now known to use.
    #[must_use]
    pub fn parse(self, text: &str) -> Option<(f64, Self)> {
        let used = match (text.contains('.'), text.contains(',')) {
            (false, false) => self,
            (true, false) if self != Self::Comma => Self::Point,
            (false, true) if self != Self::Point => Self::Comma,
            _ => return None,
        };
        // `f64::from_str` takes words too; those are not what a table's cell should say by accident.
        let number = text.bytes().any(|byte| byte.is_ascii_digit());
        let word = ["nan", "+nan", "-nan", "inf", "+inf", "-inf"]
            .iter()
            .any(|word| text.eq_ignore_ascii_case(word));
        if !(number || word) {
            return None;
        }
        let value = match used {
            Self::Comma => text.replace(',', ".").parse().ok()?,
            _ => text.parse().ok()?,
        };
        Some((value, used))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_has_points_or_commas() {
        let parse = |decimal: Decimal, text| decimal.parse(text).map(|(number, _)| number);
        assert_eq!(parse(Decimal::Either, "1,5e-3"), Some(1.5e-3));
        assert_eq!(parse(Decimal::Either, "1.5e-3"), Some(1.5e-3));
        assert_eq!(Decimal::Either.parse("1,5"), Some((1.5, Decimal::Comma)));
        assert_eq!(Decimal::Comma.parse("15"), Some((15.0, Decimal::Comma)));
        assert_eq!(parse(Decimal::Comma, "1.5"), None);
        assert_eq!(parse(Decimal::Point, "1,5"), None);
        for text in [
            "1.234,5", "1,234.5", "1,234,5", "", "abc", "1 000", "infinity",
        ] {
            assert_eq!(parse(Decimal::Either, text), None, "{text}");
        }
    }
}
