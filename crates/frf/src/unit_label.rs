//! Unit labels such as `(m/s^2)/N`, `g/lbf` or `rad/N·m`, read for their dimension and their factor to SI.

use std::f64::consts::PI;

use super::uff::{KGF, LBF};

/// lengthᵃ · forceᵇ · timeᶜ, and how many SI units one of it is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Unit {
    pub(crate) length: i32,
    pub(crate) force: i32,
    pub(crate) time: i32,
    pub(crate) to_si: f64,
}

const ONE: Unit = unit(0, 0, 0, 1.0);

const fn unit(length: i32, force: i32, time: i32, to_si: f64) -> Unit {
    Unit {
        length,
        force,
        time,
        to_si,
    }
}

/// The symbols that labels use. `nm`, `ms` and `MN` are left out: they are as often nanometre as newton metre, and so on.
const SYMBOLS: &[(&[&str], Unit)] = &[
    (&["1"], ONE),
    (&["rad", "RAD"], ONE),
    (&["mrad", "MRAD"], unit(0, 0, 0, 1e-3)),
    (&["urad", "µrad", "μrad"], unit(0, 0, 0, 1e-6)),
    (&["deg", "DEG", "°"], unit(0, 0, 0, PI / 180.0)),
    (&["m", "M"], unit(1, 0, 0, 1.0)),
    (&["cm", "CM"], unit(1, 0, 0, 1e-2)),
    (&["mm", "MM"], unit(1, 0, 0, 1e-3)),
    (&["um", "µm", "μm"], unit(1, 0, 0, 1e-6)),
    (&["in", "inch", "IN"], unit(1, 0, 0, 0.0254)),
    (&["ft", "FT"], unit(1, 0, 0, 0.3048)),
    (&["mil"], unit(1, 0, 0, 2.54e-5)),
    (&["s", "sec", "S", "SEC"], unit(0, 0, 1, 1.0)),
    (&["N", "n"], unit(0, 1, 0, 1.0)),
    (&["kN", "KN"], unit(0, 1, 0, 1e3)),
    (&["mN"], unit(0, 1, 0, 1e-3)),
    (&["lbf", "lb", "LBF", "LB"], unit(0, 1, 0, LBF)),
    (&["kgf", "KGF"], unit(0, 1, 0, KGF)),
    (&["Nm", "NM"], unit(1, 1, 0, 1.0)),
    (&["Nmm", "NMM"], unit(1, 1, 0, 1e-3)),
    (&["kNm", "KNM"], unit(1, 1, 0, 1e3)),
    // 1 kg = 1 N·s²/m, so that 1/kg is an accelerance
    (&["kg", "KG"], unit(-1, 1, 2, 1.0)),
    // standard gravity: vibration labels never mean grams
    (&["g", "gn", "G"], unit(1, 0, -2, 9.806_65)),
];

impl Unit {
    fn times(self, other: Self) -> Self {
        Self {
            length: self.length + other.length,
            force: self.force + other.force,
            time: self.time + other.time,
            to_si: self.to_si * other.to_si,
        }
    }

    fn power(self, exponent: i32) -> Self {
        Self {
            length: self.length * exponent,
            force: self.force * exponent,
            time: self.time * exponent,
            to_si: self.to_si.powi(exponent),
        }
    }

    /// The unit divided by another.
    pub(crate) fn per(self, other: Self) -> Self {
        self.times(other.power(-1))
    }

    /// Reads a label; `None` if it holds anything that is not a known unit.
    ///
    /// A product binds tighter than a quotient, since `rad/N·m` never means radian metre per newton.
    pub(crate) fn from_label(label: &str) -> Option<Self> {
        let characters: Vec<char> = label.trim().chars().collect();
        let mut cursor = Cursor {
            characters: &characters,
            at: 0,
        };
        let unit = cursor.quotient()?;
        cursor.peek().is_none().then_some(unit)
    }
}

struct Cursor<'label> {
    characters: &'label [char],
    at: usize,
}

impl Cursor<'_> {
    fn peek(&self) -> Option<char> {
        self.characters.get(self.at).copied()
    }

    fn take(&mut self, wanted: char) -> bool {
        let found = self.peek() == Some(wanted);
        self.at += usize::from(found);
        found
    }

    fn skip_blanks(&mut self) {
        while self.take(' ') {}
    }

    fn quotient(&mut self) -> Option<Unit> {
        let mut unit = self.product()?;
        while self.take('/') {
            unit = unit.per(self.product()?);
        }
        Some(unit)
    }

    fn product(&mut self) -> Option<Unit> {
        let mut unit = self.factor()?;
        loop {
            self.skip_blanks();
            match self.peek() {
                None | Some('/' | ')' | ']') => return Some(unit),
                Some('*' | '·' | '.' | '-') => self.at += 1,
                Some(_) => {}
            }
            unit = unit.times(self.factor()?);
        }
    }

    fn factor(&mut self) -> Option<Unit> {
        self.skip_blanks();
        let base = if self.take('(') {
            let inner = self.quotient()?;
            self.take(')').then_some(inner)?
        } else if self.take('[') {
            let inner = self.quotient()?;
            self.take(']').then_some(inner)?
        } else if self.take('1') {
            ONE
        } else {
            self.symbol()?
        };
        self.exponent().map(|exponent| base.power(exponent))
    }

    fn symbol(&mut self) -> Option<Unit> {
        let start = self.at;
        while self.peek().is_some_and(|c| c.is_alphabetic() || c == '°') {
            self.at += 1;
        }
        let symbol: String = self.characters[start..self.at].iter().collect();
        SYMBOLS
            .iter()
            .find(|(spellings, _)| spellings.contains(&symbol.as_str()))
            .map(|(_, unit)| *unit)
    }

    /// `^2`, `**-1`, `2`, `-2`, `²` or nothing, which is 1; `None` for a sign without its digit.
    fn exponent(&mut self) -> Option<i32> {
        let marked = self.take('^') || {
            let starred = self.characters[self.at..].starts_with(&['*', '*']);
            self.at += 2 * usize::from(starred);
            starred
        };
        let next_is_digit = |cursor: &Self| {
            cursor
                .characters
                .get(cursor.at + 1)
                .is_some_and(char::is_ascii_digit)
        };
        let sign = match self.peek() {
            Some('-' | '⁻') if marked || next_is_digit(self) || self.peek() == Some('⁻') => {
                self.at += 1;
                -1
            }
            _ => 1,
        };
        let digit = self.peek().and_then(|c| match c {
            '¹' => Some(1),
            '²' => Some(2),
            '³' => Some(3),
            _ => c.to_digit(10).and_then(|digit| i32::try_from(digit).ok()),
        });
        match digit {
            Some(digit) => {
                self.at += 1;
                Some(sign * digit)
            }
            None if marked || sign < 0 => None,
            None => Some(1),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_of_every_habit_give_dimension_and_factor() {
        let accelerance = unit(1, -1, -2, 1.0);
        for label in [
            "(m/s^2)/N",
            "m/s2/N",
            "m/s/s/N",
            "(m/s**2)/N",
            "[m/s²]/[N]",
            "1/kg",
            "m s-2 N-1",
            "m·s⁻²·N⁻¹",
            "M/SEC2/N",
            " m/(N s^2) ",
            "m/s^2/N",
        ] {
            assert_eq!(Unit::from_label(label), Some(accelerance), "{label}");
        }
        for (label, expected) in [
            ("m/N", unit(1, -1, 0, 1.0)),
            ("(m/s)/N", unit(1, -1, -1, 1.0)),
            ("rad/N·m", unit(-1, -1, 0, 1.0)),
            ("rad/(N.m)", unit(-1, -1, 0, 1.0)),
            ("rad/N-m", unit(-1, -1, 0, 1.0)),
            ("rad/s^2/Nm", unit(-1, -1, -2, 1.0)),
            ("N", unit(0, 1, 0, 1.0)),
            ("1", ONE),
        ] {
            assert_eq!(Unit::from_label(label), Some(expected), "{label}");
        }
    }

    #[test]
    fn other_units_than_si_have_their_factor() {
        for (label, to_si) in [
            ("g/N", 9.806_65),
            ("g/lbf", 9.806_65 / 4.448_221_615_260_5),
            ("mm/s^2", 1e-3),
            ("in/s2/lb", 0.0254 / 4.448_221_615_260_5),
            ("µm/kN", 1e-9),
            ("deg", PI / 180.0),
            ("1/m2", 1.0),
            ("mm/Nmm", 1.0),
            ("m/Nmm", 1e3),
            ("rad/Nmm", 1e3),
            ("rad/(N*mm)", 1e3),
            ("rad/(N mm)", 1e3),
            ("rad/N·mm", 1e3),
            ("rad/N.mm", 1e3),
            ("mrad/N", 1e-3),
            ("mrad/Nm", 1e-3),
            ("mrad/Nmm", 1.0),
            ("mrad/s^2/N", 1e-3),
            ("µrad/N", 1e-6),
            ("rad/kNm", 1e-3),
        ] {
            let found = Unit::from_label(label).unwrap().to_si;
            assert!((found - to_si).abs() < 1e-15 * to_si, "{label}: {found}");
        }
    }

    #[test]
    fn what_is_no_unit_is_not_guessed() {
        for label in [
            "", "NONE", "V/N", "EU", "m/s^", "m/", "(m/s", "m)", "dB", "m^-", "nm", "m/s^2]", "*m",
        ] {
            assert_eq!(Unit::from_label(label), None, "{label}");
        }
    }
}
