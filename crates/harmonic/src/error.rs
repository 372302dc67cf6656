//! Why a periodic response cannot be computed.

use bolted_joint_dynamics::Defect;
use thiserror::Error;

/// What keeps a harmonic balance from giving a solution.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum HarmonicError {
    /// No harmonic was asked for, or more than make sense.
    #[error("harmonics: found {found}, expected 1 to {most}")]
    Harmonics {
        /// Highest harmonic asked for.
        found: usize,
        /// Highest harmonic that is accepted.
        most: usize,
    },
    /// The model cannot be used.
    #[error(
        "the lap model has an inertia that is not positive or a number that is not finite: {0:?}"
    )]
    Model(Defect),
    /// The load of the joint's friction depends on its velocity.
    #[error(
        "the joint has friction that depends on how fast it slips (lugre): harmonic balance does not know it; compute the response in \
         time"
    )]
    Rate,
    /// A number of the problem is outside of what it can be.
    #[error("{what}: found {found}, expected {expected}")]
    Value {
        /// Which number.
        what: &'static str,
        /// Its value.
        found: f64,
        /// What it can be.
        expected: &'static str,
    },
    /// No load acts where one is needed.
    #[error(
        "loads: found none, expected a harmonic load on body a or b: without one there is no phase to compare with"
    )]
    NoLoad,
    /// The constant term of the motion is not among the harmonics, although a constant load acts.
    #[error(
        "harmonics: found odd ones alone, expected all of them and the constant term, since a constant load acts"
    )]
    ConstantLoad,
    /// Newton's method found no solution.
    #[error(
        "no periodic solution found at {frequency_hz} Hz after {iterations} iterations: start nearer to it, with a smaller load or at \
         another frequency"
    )]
    NotFound {
        /// Frequency of the last iteration, Hz.
        frequency_hz: f64,
        /// Iterations taken.
        iterations: usize,
    },
    /// The shortest step of a continuation is still too long.
    #[error(
        "the curve cannot be followed beyond {frequency_hz} Hz, after {points} points: the shortest step finds no further solution; take \
         more harmonics or a smaller range"
    )]
    Stuck {
        /// Frequency of the last point, Hz.
        frequency_hz: f64,
        /// Points found.
        points: usize,
    },
    /// The curve did not come to its end within the points allowed.
    #[error(
        "the curve has not come to its end after {points} points, the last at {frequency_hz} Hz: allow more points or longer steps"
    )]
    TooLong {
        /// Frequency of the last point, Hz.
        frequency_hz: f64,
        /// Points found.
        points: usize,
    },
    /// The multipliers of a periodic solution could not be computed.
    #[error("the Floquet multipliers at {frequency_hz} Hz could not be computed")]
    Multipliers {
        /// Frequency of the solution, Hz.
        frequency_hz: f64,
    },
}
