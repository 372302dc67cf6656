//! What symmetry leaves of a joint's 21 numbers: matrices that turning and mirroring the joint does not change.

use nalgebra::Matrix6;

use crate::Dof::{self, Rx, Ry, Rz, X, Y, Z};
use crate::Entry;

/// An unknown: where its value stands, and with which sign. The first place names it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Term {
    pub(super) first: (Dof, Dof),
    pub(super) second: Option<(Dof, Dof, f64)>,
}

impl Term {
    const fn one(row: Dof, column: Dof) -> Self {
        Self {
            first: (row, column),
            second: None,
        }
    }

    const fn two(row: Dof, column: Dof, sign: f64, also: (Dof, Dof)) -> Self {
        Self {
            first: (row, column),
            second: Some((also.0, also.1, sign)),
        }
    }

    pub(super) fn entry(&self) -> Entry {
        Entry::new(self.first.0, self.first.1)
    }

    /// What one unit of the unknown is in the joint's matrix.
    pub(super) fn matrix(&self) -> Matrix6<f64> {
        let second = self
            .second
            .map(|(row, column, sign)| Entry::new(row, column).unit() * sign);
        self.entry().unit() + second.unwrap_or_else(Matrix6::zeros)
    }
}

/// Turning about z by any angle, and mirrors that hold z.
pub(super) const ONE_BOLT: &[Term] = ONE_BOLT_TWISTED.split_at(5).0;

/// Turning about z by any angle, or by 360°/n for n ≥ 3: a symmetric matrix holds no more than the second harmonic of
/// the angle.
pub(super) const ONE_BOLT_TWISTED: &[Term] = &[
    Term::two(X, X, 1.0, (Y, Y)),
    Term::one(Z, Z),
    Term::two(Rx, Rx, 1.0, (Ry, Ry)),
    Term::one(Rz, Rz),
    Term::two(X, Ry, -1.0, (Y, Rx)),
    // a mirror that holds an axis reverses the rotation about it and leaves the translation along it
    Term::two(X, Rx, 1.0, (Y, Ry)),
    Term::one(Z, Rz),
];

/// Mirrors across x and across y.
pub(super) const TWO_BOLTS: &[Term] = TWO_BOLTS_TWISTED.split_at(8).0;

/// Turning about z by 180°.
pub(super) const TWO_BOLTS_TWISTED: &[Term] = &[
    Term::one(X, X),
    Term::one(Y, Y),
    Term::one(Z, Z),
    Term::one(Rx, Rx),
    Term::one(Ry, Ry),
    Term::one(Rz, Rz),
    Term::one(X, Ry),
    Term::one(Y, Rx),
    Term::one(X, Y),
    Term::one(X, Rx),
    Term::one(Y, Ry),
    Term::one(Z, Rz),
    Term::one(Rx, Ry),
];
