//! Joint models as parametrisations: which of the 21 numbers of a joint in space are unknown, and how the others
//! follow.
//!
//! A measurement seldom tells all 21 apart. What is known of the joint beforehand, one bolt or several, says which of
//! them are zero, equal or opposite.

mod bolt;
mod parametrisation;
mod pattern;

pub use bolt::BoltNumbers;
pub use parametrisation::{Nearest, Parametrisation};

use nalgebra::Vector3;

use crate::{Axes, Entry, SpaceError, rotated, transported};
use pattern::{ONE_BOLT, ONE_BOLT_TWISTED, TWO_BOLTS, TWO_BOLTS_TWISTED, Term};

/// Whether a joint looks the same in mirrors that hold its axis.
///
/// Bolts, washers and holes do; a thread or an oblique layer does not.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Mirrors {
    /// It does.
    Kept,
    /// It need not: a force along an axis may turn the joint about it, as in a screw.
    Lost,
}

/// What is known of a joint's matrix before it is measured. The same model holds for K and for C.
#[derive(Clone, Debug, PartialEq)]
pub enum JointModel {
    /// A stiffness along each of the axes x, y and z: 3 numbers.
    Translations,
    /// The diagonal: 6 numbers.
    Diagonal,
    /// One bolt, told at a point on its axis: looks the same from every side of it. 5 numbers, 7 without mirrors, in
    /// axes whose z is the bolt's. A bolt aside of the point is one of [`JointModel::Bolts`].
    ///
    /// `k_x_ry` = −`k_y_rx` puts the centre `k_x_ry`/`k_x` along the axis, so it changes sign with the axis' sense.
    Bolt {
        /// Direction of the bolt, of any length.
        axis: Vector3<f64>,
        /// Mirror planes through the axis.
        mirrors: Mirrors,
    },
    /// Two equal bolts, seen from the middle between them: 8 numbers, 13 without mirrors, in axes whose z is the bolts'
    /// and whose x points from one to the other.
    TwoBolts {
        /// Direction of both bolts.
        axis: Vector3<f64>,
        /// From one bolt to the other, at right angles to the axis.
        line: Vector3<f64>,
        /// The mirror planes along and across the line.
        mirrors: Mirrors,
    },
    /// Three equal bolts or more at equal distances on a circle, seen from its centre: the numbers of one bolt.
    BoltCircle {
        /// How many.
        bolts: usize,
        /// Direction of all bolts.
        axis: Vector3<f64>,
        /// Mirror planes through the axis and each bolt.
        mirrors: Mirrors,
    },
    /// Equal bolts at given places, with the 5 numbers of one bolt as unknowns; the parts are rigid between them.
    Bolts {
        /// Direction of all bolts.
        axis: Vector3<f64>,
        /// From the point of the joint's matrix to each bolt, m.
        positions_m: Vec<Vector3<f64>>,
    },
    /// Translations and rotations each in full and not coupled: 12 numbers.
    Blocks,
    /// All 21 numbers.
    Full,
}

impl JointModel {
    /// Its unknowns and matrices.
    ///
    /// # Errors
    ///
    /// [`SpaceError::Direction`] for an axis or a line that gives no direction, [`SpaceError::TooFew`] for fewer bolts
    /// than the model is made of, [`SpaceError::NotFinite`] for a place that is none.
    pub fn parametrisation(&self) -> Result<Parametrisation, SpaceError> {
        let identity = Axes::identity();
        match self {
            Self::Translations => Ok(entries(&identity, |Entry { row, column }| {
                row == column && !row.is_rotation()
            })),
            Self::Diagonal => Ok(entries(&identity, |Entry { row, column }| row == column)),
            Self::Bolt { axis, mirrors } => {
                Ok(told(one_bolt(*mirrors), &Axes::with_z_along(axis)?))
            }
            Self::TwoBolts {
                axis,
                line,
                mirrors,
            } => {
                let terms = match mirrors {
                    Mirrors::Kept => TWO_BOLTS,
                    Mirrors::Lost => TWO_BOLTS_TWISTED,
                };
                Ok(told(terms, &Axes::with_z_and_x_along(axis, line)?))
            }
            Self::BoltCircle {
                bolts,
                axis,
                mirrors,
            } => {
                if *bolts < 3 {
                    return Err(SpaceError::TooFew {
                        what: "bolts of a circle (two have a model of their own)",
                        found: *bolts,
                        least: 3,
                    });
                }
                Ok(told(one_bolt(*mirrors), &Axes::with_z_along(axis)?))
            }
            Self::Bolts { axis, positions_m } => {
                if positions_m.is_empty() {
                    return Err(SpaceError::TooFew {
                        what: "places of bolts",
                        found: 0,
                        least: 1,
                    });
                }
                if !positions_m.iter().flatten().all(|place| place.is_finite()) {
                    return Err(SpaceError::NotFinite {
                        what: "the places of the bolts",
                    });
                }
                let one = told(ONE_BOLT, &Axes::with_z_along(axis)?);
                // A bolt's matrix belongs to the bolt's place, the joint's to the origin: d = 0 − r
                Ok(one.each(|matrix| {
                    positions_m
                        .iter()
                        .map(|place| transported(matrix, &-place))
                        .sum()
                }))
            }
            Self::Blocks => Ok(entries(&identity, |Entry { row, column }| {
                row.is_rotation() == column.is_rotation()
            })),
            Self::Full => Ok(entries(&identity, |_| true)),
        }
    }
}

const fn one_bolt(mirrors: Mirrors) -> &'static [Term] {
    match mirrors {
        Mirrors::Kept => ONE_BOLT,
        Mirrors::Lost => ONE_BOLT_TWISTED,
    }
}

/// A pattern in axes of its own.
fn told(terms: &[Term], axes: &Axes) -> Parametrisation {
    let back = axes.inverse();
    let unknowns = terms
        .iter()
        .map(|term| (term.entry(), rotated(&term.matrix(), &back)));
    Parametrisation::new(unknowns.collect(), *axes)
}

/// Some of the 21 entries, each for itself.
fn entries(axes: &Axes, unknown: impl Fn(Entry) -> bool) -> Parametrisation {
    let unknowns = Entry::ALL.into_iter().filter(|&entry| unknown(entry));
    Parametrisation::new(unknowns.map(|entry| (entry, entry.unit())).collect(), *axes)
}

#[cfg(test)]
mod tests;
