//! Why a beam cannot be built.

use thiserror::Error;

use crate::structure::SpatialError;

/// Why a beam cannot be built.
#[derive(Debug, Error, PartialEq)]
pub enum BeamError {
    /// A dimension, modulus or density is not a positive number.
    #[error("beam.{key}: found {found}, expected a positive number in SI units")]
    NotPositive {
        /// Key of the study.
        key: &'static str,
        /// Value found.
        found: f64,
    },
    /// A damping ratio or loss factor is negative or not finite.
    #[error("beam.{key}: found {found}, expected a finite number that is not negative")]
    Damping {
        /// Key of the study.
        key: &'static str,
        /// Value found.
        found: f64,
    },
    /// An empty list of damping ratios.
    #[error(
        "beam.damping_ratio: found an empty list, expected one number or a number for each mode"
    )]
    NoDampingRatio,
    /// A point that is not on the beam.
    #[error("point at {position_m} m: expected a position on the beam, from 0 to {length_m} m")]
    OffTheBeam {
        /// Position, m.
        position_m: f64,
        /// Length of the beam, m.
        length_m: f64,
    },
    /// The receptance has no value: an undamped resonance, or 0 Hz where a body is free.
    #[error(
        "the beam has no finite receptance at {frequency_hz} Hz, {reason}; leave that line out{advice}"
    )]
    Resonance {
        /// Frequency, Hz.
        frequency_hz: f64,
        /// Why.
        reason: &'static str,
        /// What else helps.
        advice: &'static str,
    },
    /// The finite-element matrices have no modes.
    #[error("the beam has no modes ({0}); check its dimensions")]
    Modes(#[from] SpatialError),
}
