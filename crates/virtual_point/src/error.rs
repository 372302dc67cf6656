//! Why sensors and impacts do not make a virtual point.

use bolted_joint_space::SpaceError;
use thiserror::Error;

use crate::unseen::{UnseenMotion, listed};
use crate::words::triple;
use crate::{Place, Role};

/// What keeps sensors, impacts or functions from being used.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum VirtualPointError {
    /// A direction has not the length one.
    #[error(
        "direction: found {} of length {length}, expected a unit vector: divide it by its length, and give a \
         sensitivity as the gain",
        triple(found)
    )]
    NotUnit {
        /// Its components.
        found: [f64; 3],
        /// Its length.
        length: f64,
    },
    /// The axes of a triaxial sensor are mirrored, or not at right angles.
    #[error("triaxial sensor, {0}; a channel that reads inverted has a gain of −1")]
    Axes(#[from] SpaceError),
    /// A gain that loses the signal.
    #[error(
        "gain: found {found}, expected a finite number other than 0: leave out a channel or impact that is dead"
    )]
    Gain {
        /// The gain.
        found: f64,
    },
    /// Something holds a number that is none.
    #[error("{what}: found a number that is not finite")]
    NotFinite {
        /// What holds it.
        what: &'static str,
    },
    /// A measured function has a value that is no number.
    #[error(
        "functions: found a value that is not finite in line {}, channel {}, impact {}: leave that line out",
        line + 1, channel + 1, impact + 1
    )]
    Function {
        /// The line, counted from 0 among those that were handed over.
        line: usize,
        /// The channel, counted from 0.
        channel: usize,
        /// The impact, counted from 0.
        impact: usize,
    },
    /// There is nothing to judge.
    #[error("{what}: found none, expected one or more")]
    Nothing {
        /// What there is none of.
        what: &'static str,
    },
    /// Motions or loads need as many places.
    #[error("{role}s: found {found}, expected {least} or more: add some, {} to {} are good", least + 3, least + 6)]
    TooFew {
        /// Channels or impacts.
        role: Role,
        /// How many there are.
        found: usize,
        /// How many are needed.
        least: usize,
    },
    /// The places do not determine all motions or loads.
    #[error("{role}s: found rank {rank}, expected {}: {}", rank + motions.len(), listed(*role, motions))]
    Unseen {
        /// Channels or impacts.
        role: Role,
        /// How many motions they determine.
        rank: usize,
        /// Motions that they say nothing of: 6 − rank of them, from which the others are combined.
        motions: Vec<UnseenMotion>,
    },
    /// A list or matrix has the wrong size.
    #[error("{what}: found {found}, expected {expected}")]
    Size {
        /// Which size.
        what: &'static str,
        /// What it is.
        found: usize,
        /// What it should be.
        expected: usize,
    },
    /// Weights that are not symmetric.
    #[error(
        "weights of the {role}s: found {found} at ({row}, {column}) and {mirrored} across the diagonal, expected the \
         same: take the mean of both if they differ by rounding"
    )]
    NotSymmetric {
        /// Channels or impacts.
        role: Role,
        /// Row, from 0.
        row: usize,
        /// Column, from 0.
        column: usize,
        /// What stands there.
        found: f64,
        /// What stands across the diagonal.
        mirrored: f64,
    },
    /// A weight, or a full matrix of them, is not positive.
    #[error(
        "weights of the {role}s: found {found}, expected {expected}: leave out what is to count for nothing"
    )]
    NotPositive {
        /// Channels or impacts.
        role: Role,
        /// The weight, or the smallest eigenvalue of the matrix.
        found: f64,
        /// What it can be.
        expected: &'static str,
    },
    /// A standard deviation is negative, or no number.
    #[error("{what}: found {found}, expected {expected}")]
    Deviation {
        /// Which one.
        what: &'static str,
        /// Its value.
        found: f64,
        /// What it can be.
        expected: &'static str,
    },
    /// A place with a gain that errors of the set-up have brought to nothing.
    #[error(
        "{place}: the errors of the set-up leave it a gain of {gain}, expected a number other than 0"
    )]
    Lost {
        /// Which place.
        place: Place,
        /// What is left.
        gain: f64,
    },
}
