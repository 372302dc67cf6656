//! Units of a universal file (data set 164), and the factors that take its values to SI.

use std::fmt;

use bolted_joint_files::number;
use thiserror::Error;

use super::numbers::parse_line;
use super::{UffProblem, fields};
use crate::unit_label::Unit;

/// Two statements of a factor agree within this share; labels and factors are often rounded.
pub(super) const FACTOR_TOLERANCE: f64 = 1e-3;

/// Units of length and force that have a name, with how many make one SI unit.
const LENGTHS: [(&str, f64); 6] = [
    ("m", 1.0),
    ("cm", 1e2),
    ("mm", 1e3),
    ("µm", 1e6),
    ("in", 1.0 / 0.0254),
    ("ft", 1.0 / 0.3048),
];
const FORCES: [(&str, f64); 5] = [
    ("N", 1.0),
    ("mN", 1e3),
    ("kN", 1e-3),
    ("lbf", 1.0 / 4.448_221_615_260_5),
    ("kgf", 1.0 / 9.806_65),
];

/// The units that a file's lengths and forces are in.
///
/// Factors are those of data set 164: how many file units make one SI unit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct UnitSystem {
    length_per_metre: f64,
    force_per_newton: f64,
}

/// A factor that no unit can have.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[error("found {found} units per {si_unit}, expected a finite positive number")]
pub struct UnitFactorError {
    found: f64,
    si_unit: &'static str,
}

/// Code, name, lengths per metre and forces per newton of data set 164.
const BY_CODE: [(i64, &str, UnitSystem); 8] = [
    (1, "metre, newton", UnitSystem::SI),
    (
        2,
        "foot, pound-force",
        UnitSystem::of(1.0 / 0.3048, 1.0 / LBF),
    ),
    (3, "metre, kilogram-force", UnitSystem::of(1.0, 1.0 / KGF)),
    (
        4,
        "foot, poundal",
        UnitSystem::of(1.0 / 0.3048, 1.0 / POUNDAL),
    ),
    (5, "millimetre, millinewton", UnitSystem::of(1e3, 1e3)),
    (6, "centimetre, centinewton", UnitSystem::of(1e2, 1e2)),
    (
        7,
        "inch, pound-force",
        UnitSystem::of(1.0 / 0.0254, 1.0 / LBF),
    ),
    (
        8,
        "millimetre, kilogram-force",
        UnitSystem::of(1e3, 1.0 / KGF),
    ),
];

/// Pound-force, N (exact: 0.45359237 kg · 9.80665 m/s²).
pub(crate) const LBF: f64 = 4.448_221_615_260_5;
/// Kilogram-force, N (exact).
pub(crate) const KGF: f64 = 9.806_65;
/// Poundal, N (exact: 0.45359237 kg · 0.3048 m/s²).
const POUNDAL: f64 = 0.138_254_954_376;

impl UnitSystem {
    /// Metre and newton.
    pub const SI: Self = Self::of(1.0, 1.0);

    const fn of(length_per_metre: f64, force_per_newton: f64) -> Self {
        Self {
            length_per_metre,
            force_per_newton,
        }
    }

    /// The units of which so many make one metre and one newton: 1000 and 1 for mm and N.
    ///
    /// # Errors
    /// [`UnitFactorError`] if a factor is not finite and positive.
    pub fn new(length_per_metre: f64, force_per_newton: f64) -> Result<Self, UnitFactorError> {
        for (found, si_unit) in [(length_per_metre, "metre"), (force_per_newton, "newton")] {
            if !(found.is_finite() && found > 0.0) {
                return Err(UnitFactorError { found, si_unit });
            }
        }
        Ok(Self::of(length_per_metre, force_per_newton))
    }

    /// The units with these names, such as `mm` and `N`, or `in` and `lbf`; `None` if either is no unit of its kind.
    #[must_use]
    pub fn named(length: &str, force: &str) -> Option<Self> {
        let length =
            Unit::from_label(length).filter(|u| (u.length, u.force, u.time) == (1, 0, 0))?;
        let force = Unit::from_label(force).filter(|u| (u.length, u.force, u.time) == (0, 1, 0))?;
        Self::new(1.0 / length.to_si, 1.0 / force.to_si).ok()
    }

    /// How many lengths of the file make one metre.
    #[must_use]
    pub fn length_per_metre(self) -> f64 {
        self.length_per_metre
    }

    /// How many forces of the file make one newton.
    #[must_use]
    pub fn force_per_newton(self) -> f64 {
        self.force_per_newton
    }

    /// SI units in one file unit of lengthᵃ·forceᵇ.
    pub(crate) fn to_si(self, length_exponent: i32, force_exponent: i32) -> f64 {
        // SI = file / (Lᵃ Fᵇ)
        self.length_per_metre.powi(-length_exponent) * self.force_per_newton.powi(-force_exponent)
    }

    pub(super) fn agrees_with(self, other: Self) -> bool {
        agree(self.length_per_metre, other.length_per_metre)
            && agree(self.force_per_newton, other.force_per_newton)
    }

    /// From the records of data set 164: the code's line, then the lines of the factors.
    ///
    /// # Errors
    /// The index of the record (0 for the first) and its problem.
    pub(super) fn from_records(records: &[String]) -> Result<Self, (usize, UffProblem)> {
        let code_field = fields::columns(&records[0], 0, 10);
        let code: i64 = code_field.parse().map_err(|_| {
            (
                0,
                UffProblem::Field {
                    record: 1,
                    field: "units code",
                    found: code_field.clone(),
                    expected: "a whole number from 1 to 9",
                },
            )
        })?;
        let mut factors = Vec::new();
        for (index, record) in records.iter().enumerate().skip(1) {
            let numbers = parse_line(record, &[25; 3]).map_err(|bad| {
                let (column, found) = (bad.column, bad.text);
                (index, UffProblem::NotANumber { column, found })
            })?;
            factors.extend(numbers);
        }
        let missing = |field, found: &str| {
            let expected = "a positive number such as 1.00000000000000000D+00";
            let found = found.to_owned();
            (
                1,
                UffProblem::Field {
                    record: 2,
                    field,
                    found,
                    expected,
                },
            )
        };
        let [length, force, ..] = factors[..] else {
            return Err(missing("the length and force factors", records[1].trim()));
        };
        let units = Self::new(length, force)
            .map_err(|error| missing("the length and force factors", &error.found.to_string()))?;
        match BY_CODE.iter().find(|(known, ..)| *known == code) {
            Some(&(_, name, expected)) if !units.agrees_with(expected) => Err((
                0,
                UffProblem::UnitsCode {
                    code,
                    name,
                    length,
                    force,
                    expected_length: expected.length_per_metre,
                    expected_force: expected.force_per_newton,
                },
            )),
            _ => Ok(units),
        }
    }
}

/// Whether two statements of one factor mean the same.
pub(super) fn agree(first: f64, second: f64) -> bool {
    (first - second).abs() <= FACTOR_TOLERANCE * second.abs()
}

/// A length and a force by name, or by their factors.
impl fmt::Display for UnitSystem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let written = |known: &[(&str, f64)], per_si: f64, si_unit: &str| {
            let mut known = known.iter();
            match known.find(|(_, factor)| agree(per_si, *factor)) {
                Some((name, _)) => (*name).to_owned(),
                None => format!("{} to the {si_unit}", number(per_si, 6)),
            }
        };
        let length = written(&LENGTHS, self.length_per_metre, "metre");
        let force = written(&FORCES, self.force_per_newton, "newton");
        write!(f, "{length}, {force}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn records(code: &str, factors: &[&str]) -> Vec<String> {
        std::iter::once(code)
            .chain(factors.iter().copied())
            .map(str::to_owned)
            .collect()
    }

    #[test]
    fn the_factors_of_the_standard_are_read() {
        // The factors that the standard's own table prints for BG units.
        let units = UnitSystem::from_records(&records(
            "         2Foot (pound f)               2",
            &[
                "  3.28083989501312334D+00  2.24808943099710480D-01  1.80000000000000000D+00",
                "  4.59670000000000000D+02",
            ],
        ))
        .unwrap();
        // One ft/lbf is 0.3048 m / 4.44822 N.
        assert!((units.to_si(1, -1) - 0.3048 / LBF).abs() < 1e-15);
        assert!((units.to_si(-1, -1) - 1.0 / (0.3048 * LBF)).abs() < 1e-12);
    }

    #[test]
    fn millimetres_and_newtons_are_a_user_defined_system() {
        let units =
            UnitSystem::from_records(&records("         9mm, N", &["1.0D+03 1.0D+00 1.0D+00"]))
                .unwrap();
        assert_eq!(units, UnitSystem::new(1e3, 1.0).unwrap());
        assert_eq!(units.to_si(1, -1), 1e-3);
    }

    #[test]
    fn names_of_units_make_a_system() {
        let close = |found: f64, expected: f64| (found / expected - 1.0).abs() < 1e-14;
        for (length, force, per_metre, per_newton) in [
            ("m", "N", 1.0, 1.0),
            ("mm", "N", 1e3, 1.0),
            ("in", "lbf", 1.0 / 0.0254, 1.0 / LBF),
            ("µm", "kN", 1e6, 1e-3),
        ] {
            let units = UnitSystem::named(length, force).unwrap();
            assert!(close(units.length_per_metre(), per_metre), "{length}");
            assert!(close(units.force_per_newton(), per_newton), "{force}");
        }
        for (length, force) in [
            ("N", "m"),
            ("mm", "kg"),
            ("furlong", "N"),
            ("m^2", "N"),
            ("", ""),
        ] {
            assert_eq!(UnitSystem::named(length, force), None, "{length} {force}");
        }
    }

    #[test]
    fn a_code_that_contradicts_its_factors_is_refused() {
        let (record, problem) = UnitSystem::from_records(&records(
            "         1SI units                     1",
            &["3.28083989501312334D+00 2.24808943099710480D-01 1.8D+00"],
        ))
        .unwrap_err();
        assert_eq!(record, 0);
        let message = problem.to_string();
        assert!(
            message.contains("3.28083") && message.contains("metre, newton"),
            "{message}"
        );
    }

    #[test]
    fn factors_that_no_unit_has_are_refused() {
        for (code, factors) in [
            ("         x", "1.0 1.0 1.0"),
            ("         1", "1.0"),
            ("         1", "1.0 zero"),
            ("         9", "0.0 1.0"),
            ("         9", "1.0 -1.0"),
            ("         9", "1.0 Inf"),
        ] {
            let error = UnitSystem::from_records(&records(code, &[factors]));
            assert!(error.is_err(), "{code} {factors}");
        }
    }
}
