//! What cannot be a layered beam, or is outside of what the model says.

use std::fmt::Display;

use thiserror::Error;

use super::super::uncertain::MonteCarloError;
use bolted_joint_frf::structure::StructureError;

/// Why a layered beam, its fasteners or its damping make no sense.
#[derive(Debug, Error)]
pub enum LayeredBeamError {
    /// A value of a study that the model has no use for.
    #[error("`{key}`: found {found}, expected {expected}")]
    Value {
        /// Key in a study.
        key: &'static str,
        /// What was found.
        found: String,
        /// What was expected.
        expected: String,
    },
    /// Nothing follows from the draws.
    #[error("`uncertainty`: {0}")]
    MonteCarlo(MonteCarloError),
    /// The finite elements fail.
    #[error(transparent)]
    FiniteElements(#[from] StructureError),
}

/// A value that the model has no use for.
pub(super) fn value(
    key: &'static str,
    found: impl Display,
    expected: impl Display,
) -> LayeredBeamError {
    LayeredBeamError::Value {
        key,
        found: found.to_string(),
        expected: expected.to_string(),
    }
}

/// Refuses what is not a positive number.
pub(super) fn positive(
    key: &'static str,
    found: f64,
    unit: &'static str,
) -> Result<(), LayeredBeamError> {
    match found.is_finite() && found > 0.0 {
        true => Ok(()),
        false => {
            let found = format!("{found} {unit}");
            Err(value(key, found.trim_end(), "a positive number"))
        }
    }
}
