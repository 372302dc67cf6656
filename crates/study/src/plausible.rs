//! Numbers that no joint's test has, and the slips that they look like: most are right in another unit.

use std::fmt::Display;

use super::{StudyError, StudyText};

/// A number of a beam.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BeamNumber {
    /// Along it, m.
    Length,
    /// Of its section, m.
    Width,
    /// Of its section, m.
    Height,
    /// Pa.
    YoungsModulus,
    /// kg/m³.
    Density,
}

impl BeamNumber {
    fn key(self) -> &'static str {
        match self {
            Self::Length => "length",
            Self::Width => "width",
            Self::Height => "height",
            Self::YoungsModulus => "youngs_modulus",
            Self::Density => "density",
        }
    }

    /// What is plausible, and what is expected in words.
    fn range(self) -> ([f64; 2], &'static str) {
        match self {
            Self::Length => (
                [1e-3, 20.0],
                "a length in m, from 0.001 to 20 (is it in millimetres?)",
            ),
            Self::Width => (
                [1e-4, 2.0],
                "a width in m, from 0.0001 to 2 (is it in millimetres?)",
            ),
            Self::Height => (
                [1e-4, 2.0],
                "a height in m, from 0.0001 to 2 (is it in millimetres?)",
            ),
            Self::YoungsModulus => (
                [1e8, 2e12],
                "Young's modulus in Pa, from 1e8 to 2e12 (is it in GPa or MPa?)",
            ),
            Self::Density => (
                [50.0, 30e3],
                "a density in kg/m³, from 50 to 30000 (is it in g/cm³ or t/mm³?)",
            ),
        }
    }
}

impl StudyText {
    /// Refuses a number of the beam, or of another part, at `key` that no joint's test has. What is no number at all, or none above zero, is left to the
    /// beam's own check.
    ///
    /// # Errors
    /// [`StudyError::Value`] if it is not plausible.
    pub fn plausible_in_beam(
        &self,
        key: impl Display,
        number: BeamNumber,
        found: f64,
    ) -> Result<(), StudyError> {
        let ([least, most], expected) = number.range();
        let is_plausible = (least..=most).contains(&found) || !found.is_finite() || found <= 0.0;
        let key = format_args!("{key}.{}", number.key());
        self.ensure(is_plausible, key, found, expected)
    }
}
