//! Axes of the interface and their signs.

use std::fmt;

use serde::{Deserialize, Deserializer, de};
use thiserror::Error;

/// An axis of the interface: x and y lie in it, z is its normal. Right-handed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Axis {
    /// In the interface.
    X,
    /// In the interface.
    Y,
    /// Normal to the interface.
    Z,
}

impl Axis {
    /// Its place among the translations, and among the rotations.
    #[must_use]
    pub fn index(self) -> usize {
        match self {
            Self::X => 0,
            Self::Y => 1,
            Self::Z => 2,
        }
    }
}

/// An axis and the sense in which a motion along it or about it counts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SignedAxis {
    /// The axis.
    pub axis: Axis,
    /// Whether the motion counts against it.
    pub is_reversed: bool,
}

/// A text that is no axis.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error(
    "found {found:?}, expected \"x\", \"y\" or \"z\", with \"-\" before it for the opposite sense"
)]
pub struct AxisError {
    /// The text.
    pub found: String,
}

impl SignedAxis {
    /// The axis that a text such as `x`, `+x` or `-x` names.
    ///
    /// # Errors
    /// It names none.
    pub fn parse(text: &str) -> Result<Self, AxisError> {
        let (is_reversed, letter) = match text.strip_prefix(['-', '−']) {
            Some(letter) => (true, letter),
            None => (false, text.strip_prefix('+').unwrap_or(text)),
        };
        let axis = match letter {
            "x" | "X" => Axis::X,
            "y" | "Y" => Axis::Y,
            "z" | "Z" => Axis::Z,
            _ => {
                return Err(AxisError {
                    found: text.to_owned(),
                });
            }
        };
        Ok(Self { axis, is_reversed })
    }

    /// 1, or −1 for the opposite sense.
    #[must_use]
    pub fn sign(self) -> f64 {
        if self.is_reversed { -1.0 } else { 1.0 }
    }
}

/// As a study names it.
impl fmt::Display for SignedAxis {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let letter = ["x", "y", "z"][self.axis.index()];
        write!(f, "{}{letter}", if self.is_reversed { "-" } else { "" })
    }
}

impl<'de> Deserialize<'de> for SignedAxis {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let text = String::deserialize(deserializer)?;
        Self::parse(&text).map_err(de::Error::custom)
    }
}
