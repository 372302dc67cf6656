//! How large the errors of what was measured are.

use bolted_joint_study::{StudyError, StudyText};

use super::tables::NoiseTable;
use crate::response::data::SineLine;

/// A force without error counts as one with this part of the response's.
const EXACT: f64 = 1e-4;

impl Default for Noise {
    fn default() -> Self {
        Self {
            response: 0.01,
            force: 0.01,
            floor_m: 0.0,
            frequency: 1e-4,
            damping: 0.01,
            is_stated: false,
            is_of_curves: false,
        }
    }
}

/// Standard deviations of what was measured, as fractions of it: of the complex errors of response and force, so that each part and
/// each logarithm and angle has the √2-th part.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Noise {
    /// Of the response.
    pub response: f64,
    /// Of the force.
    pub force: f64,
    /// Part of the response's that does not depend on it, m.
    pub floor_m: f64,
    /// Of the frequencies of a backbone.
    pub frequency: f64,
    /// Of damping ratios and forces of a backbone.
    pub damping: f64,
    /// Whether the study stated that of all data in the estimate; else a common factor is estimated from the residual.
    pub is_stated: bool,
    /// Whether the study stated that of frequencies and damping ratios: decays have it beside the noise of their records.
    pub is_of_curves: bool,
}

impl Noise {
    /// Stated noise of force and response.
    #[must_use]
    pub fn stated(response: f64, force: f64) -> Self {
        Self {
            response,
            force,
            is_stated: true,
            ..Self::default()
        }
    }

    /// Reciprocal standard deviations of ln F, ln x and the phase. A force without error would leave its line without an amplitude
    /// to adjust, so that it has a very small one.
    pub(in crate::response) fn weights(&self, line: &SineLine) -> [f64; 3] {
        let floor = self.floor_m / line.displacement_m;
        let response = self.response * self.response + floor * floor;
        let force = (self.force * self.force).max(EXACT * EXACT * response);
        [force, response, force + response].map(|variance| (0.5 * variance).sqrt().recip())
    }
}

/// The noise that a study states, of which sines and curves (backbones and decays) are in the estimate or not.
pub(super) fn noise(
    study: &StudyText,
    table: &NoiseTable,
    [has_sines, has_curves]: [bool; 2],
) -> Result<Noise, StudyError> {
    for (name, value, may_vanish) in [
        ("response", table.response, false),
        ("force", table.force, true),
        ("floor_m", table.floor_m, true),
        ("frequency", table.frequency, false),
        ("damping", table.damping, false),
    ] {
        let Some(value) = value else { continue };
        let key = format!("noise.{name}");
        study.not_negative(&key, value, "a number that is not negative")?;
        let expected = "a fraction above zero: a measurement has errors";
        study.ensure(may_vanish || value != 0.0, &key, value, expected)?;
        if name != "floor_m" {
            study.part_of_whole(key, value)?;
        }
    }
    let is_of_curves = table.frequency.is_some();
    let otherwise = Noise::default();
    let response = table.response.unwrap_or(otherwise.response);
    Ok(Noise {
        response,
        // What is not said of the force is as of the response.
        force: table.force.unwrap_or(response),
        floor_m: table.floor_m.unwrap_or(0.0),
        frequency: table.frequency.unwrap_or(otherwise.frequency),
        damping: table.damping.unwrap_or(otherwise.damping),
        is_stated: (!has_sines || table.response.is_some()) && (!has_curves || is_of_curves),
        is_of_curves,
    })
}
