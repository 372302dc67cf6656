//! Magnitudes in decibels: what 0 dB is has to be said, since every analyser has its own.

/// Magnitudes as 20 lg(|H|/reference).
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Decibel<'label> {
    /// What 0 dB is, in the unit.
    pub(super) reference: f64,
    pub(super) unit: &'label str,
}

impl<'label> Decibel<'label> {
    /// Whether a unit label means decibels, with or without their reference.
    pub(super) fn is_one(label: &str) -> bool {
        let mut characters = label.trim().chars();
        let begins = characters.by_ref().take(2).collect::<String>();
        // "dB", and no longer word
        begins.eq_ignore_ascii_case("db") && !characters.next().is_some_and(char::is_alphanumeric)
    }

    /// `dB re 1e-6 m/N`, `dB (re 1 m/s^2/N)` or `dB re g/N`; `None` where it does not say what 0 dB is.
    pub(super) fn read(label: &'label str) -> Option<Self> {
        let said = label.trim().get(2..)?.trim();
        let said = said
            .strip_prefix('(')
            .and_then(|said| said.strip_suffix(')'))
            .unwrap_or(said);
        let said = ["rel.", "rel", "ref.", "ref", "re.", "re"]
            .iter()
            .find_map(|word| said.trim().strip_prefix(word))?;
        // "re" is a word, and so is "rem"
        let said = said.strip_prefix([' ', ':', '\t'])?.trim();
        let (first, rest) = said.split_once(char::is_whitespace).unwrap_or((said, ""));
        let (reference, unit) = match first.parse::<f64>() {
            Ok(number) => (number, rest.trim()),
            Err(_) => (1.0, said),
        };
        let is_usable = reference.is_finite() && reference > 0.0 && !unit.is_empty();
        is_usable.then_some(Self { reference, unit })
    }
}

#[cfg(test)]
mod tests {
    use super::Decibel;

    #[test]
    fn decibels_say_what_zero_is() {
        for (label, reference, unit) in [
            ("dB re 1 m/s^2/N", 1.0, "m/s^2/N"),
            ("dB re 1e-6 m/N", 1e-6, "m/N"),
            ("dB (re 1 (m/s)/N)", 1.0, "(m/s)/N"),
            ("DB rel. 20 mm/N", 20.0, "mm/N"),
            ("dB re g/N", 1.0, "g/N"),
            ("dB ref: 1/kg", 1.0, "1/kg"),
        ] {
            assert!(Decibel::is_one(label));
            let found = Decibel::read(label);
            assert_eq!(found, Some(Decibel { reference, unit }), "{label}");
        }
        for label in [
            "dB",
            "dB re",
            "dB re 1",
            "dB re 0 m/N",
            "dB re -1 m/N",
            "dB re nan m/N",
            "dB m/N",
            "dBé",
        ] {
            assert_eq!(Decibel::read(label), None, "{label}");
        }
        assert!(!Decibel::is_one("dBA") && !Decibel::is_one("m/N") && !Decibel::is_one("d°"));
    }
}
