//! Why something cannot be said of a joint in space.

use thiserror::Error;

use crate::{Dof, Motions};

/// What keeps matrices, axes or receptances from being used.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum SpaceError {
    /// The axes are those of a left hand.
    #[error(
        "axes: found a left-handed system (determinant {determinant}), expected a right-handed one: order the axes so that \
         x × y = z, or turn one of them round"
    )]
    Mirrored {
        /// Determinant of the three axes.
        determinant: f64,
    },
    /// The axes are not perpendicular, or not of length one.
    #[error(
        "axes: found three vectors that are {off} off from unit vectors at right angles, expected less than {most}: \
         give them with more digits"
    )]
    NotOrthonormal {
        /// Largest entry of Q Qᵀ − I.
        off: f64,
        /// Largest one that is accepted.
        most: f64,
    },
    /// A vector that should give a direction does not.
    #[error("{what}: found ({}, {}, {}), expected {expected}", .found[0], .found[1], .found[2])]
    Direction {
        /// Which vector.
        what: &'static str,
        /// Its components.
        found: [f64; 3],
        /// What it can be.
        expected: &'static str,
    },
    /// A number is outside of what it can be.
    #[error("{what}: found {found}, expected {expected}")]
    Value {
        /// Which number.
        what: &'static str,
        /// Its value.
        found: f64,
        /// What it can be.
        expected: &'static str,
    },
    /// A matrix of a joint is not symmetric.
    #[error(
        "the joint's matrix is not symmetric: found {found} at ({row}, {column}) and {mirrored} at ({column}, {row}), \
         expected the same: take the mean of both if they differ by noise"
    )]
    NotSymmetric {
        /// DOF of the row.
        row: Dof,
        /// DOF of the column.
        column: Dof,
        /// What stands there.
        found: f64,
        /// What stands across the diagonal.
        mirrored: f64,
    },
    /// A matrix of a joint gives energy away.
    #[error("the joint is not passive: found {condition} = {found:.3e}, expected 0 or more")]
    NotPassive {
        /// What must not be negative.
        condition: &'static str,
        /// Its value.
        found: f64,
    },
    /// The numbers of bolts act on six motions.
    #[error(
        "the joint's model: found one of bolts, whose numbers act on six motions, for a test of {motions}; expected \"full\", \
         \"blocks\", \"diagonal\" or \"translations\""
    )]
    OfSixMotions {
        /// Those of the test.
        motions: Motions,
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
    /// There is too little of something.
    #[error("{what}: found {found}, expected {least} or more")]
    TooFew {
        /// What is counted.
        what: &'static str,
        /// How many there are.
        found: usize,
        /// How many are needed.
        least: usize,
    },
    /// A DOF stands twice in a list.
    #[error("DOFs: found {dof} twice, expected each once")]
    Twice {
        /// The DOF.
        dof: Dof,
    },
    /// DOFs that are let free have loads from the others but no stiffness to bear them.
    #[error(
        "condensation: the free DOFs have no stiffness against loads that the others put on them, which no passive \
         joint has: hold them, or check the matrix"
    )]
    NothingBears,
    /// The assembly resonates without damping.
    #[error(
        "coupling: I + H D cannot be solved, so the assembly resonates here without damping: give the structures or \
         the joint damping, or leave this line out"
    )]
    Resonance,
    /// A matrix holds something that is no number.
    #[error("{what}: found a number that is not finite")]
    NotFinite {
        /// Which matrix.
        what: &'static str,
    },
}

#[cfg(test)]
mod tests {
    use bolted_joint_testing::has;

    use super::*;

    #[test]
    fn messages_say_what_was_found_and_what_was_expected() {
        let two = SpaceError::TooFew {
            what: "bolts of a circle",
            found: 2,
            least: 3,
        };
        assert_eq!(
            two.to_string(),
            "bolts of a circle: found 2, expected 3 or more"
        );
        let (row, column) = (Dof::X, Dof::Ry);
        let asymmetric = SpaceError::NotSymmetric {
            row,
            column,
            found: 1.0,
            mirrored: -1.0,
        };
        has(
            &asymmetric.to_string(),
            &["found 1 at (x, ry) and -1 at (ry, x)", "expected the same"],
        );
        let what = "axis";
        let flat = SpaceError::Direction {
            what,
            found: [0.0; 3],
            expected: "a length",
        };
        assert_eq!(flat.to_string(), "axis: found (0, 0, 0), expected a length");
    }
}
