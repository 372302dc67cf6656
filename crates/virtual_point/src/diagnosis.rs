//! What the others say of one that is suspected: by which gain, shift or rotation it would agree with them.

use std::fmt;

use nalgebra::{DMatrix, DVector};

use crate::projection::Projection;
use crate::suspects::Spread;
use crate::words::{short, triple};
use crate::{Places, Tolerance};

/// Singular values of the normal equations below this share of the largest entry are left out: a channel tells nothing
/// of a shift along itself.
const NOTHING: f64 = 1e-9;

/// One cause at a time, each to first order, with the share of the suspect's disagreement that it leaves. A shift or a
/// rotation that the functions do not show is zero.
#[derive(Clone, Debug, PartialEq)]
pub struct Diagnosis {
    /// Factors on the gains, one for each channel: −1 for a signal that is turned round.
    pub gains: Vec<f64>,
    /// What these leave.
    pub left_by_gains: f64,
    /// Shift of the position, m.
    pub shift_m: [f64; 3],
    /// What it leaves.
    pub left_by_shift: f64,
    /// Rotation, rad.
    pub rotation_rad: [f64; 3],
    /// What it leaves.
    pub left_by_rotation: f64,
}

/// What may be wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Cause {
    Gains,
    Shift,
    Rotation,
}

impl Diagnosis {
    /// The cause that leaves least.
    fn cause(&self) -> Cause {
        let least = self.left_by_shift.min(self.left_by_rotation);
        if self.left_by_gains <= least {
            Cause::Gains
        } else if self.left_by_shift <= least {
            Cause::Shift
        } else {
            Cause::Rotation
        }
    }

    /// Size of the cause that leaves least, in standard deviations of what was known before: of the gain that is most
    /// off, or of the length of the shift or of the rotation vector.
    #[must_use]
    pub fn deviations(&self, tolerance: &Tolerance) -> f64 {
        let length = |of: &[f64; 3]| of.iter().map(|part| part * part).sum::<f64>().sqrt();
        match self.cause() {
            Cause::Gains => {
                let off = self.gains.iter().map(|gain| (gain - 1.0).abs());
                off.fold(0.0, f64::max) / tolerance.gain
            }
            Cause::Shift => length(&self.shift_m) / tolerance.position_m,
            Cause::Rotation => length(&self.rotation_rad) / tolerance.rotation_rad,
        }
    }
}

impl fmt::Display for Diagnosis {
    /// The cause that leaves least.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.cause() {
            Cause::Gains => {
                let gains: Vec<_> = self.gains.iter().map(|gain| short(*gain)).collect();
                write!(
                    f,
                    "as if the gain were {} times what it was told to be",
                    gains.join(", ")
                )
            }
            Cause::Shift => write!(f, "as if it were shifted by {} m", triple(&self.shift_m)),
            Cause::Rotation => write!(
                f,
                "as if it were rotated by {} rad",
                triple(&self.rotation_rad)
            ),
        }
    }
}

/// Compares the rows that were left out with what the rows that are kept say of them.
pub(crate) fn diagnosed(
    places: &Places,
    dropped: &[usize],
    remaining: &Projection,
    kept: &[usize],
    spread: &Spread,
) -> Diagnosis {
    let count = places.count();
    // motions by the others, 6 × n
    let mut motions = DMatrix::zeros(6, count);
    for (at, &row) in kept.iter().enumerate() {
        motions.set_column(row, &remaining.inverse().column(at));
    }
    let rows = places.matrix().select_rows(dropped);
    let expected = &rows * &motions;
    let mut disagreement = -&expected;
    for (at, &row) in dropped.iter().enumerate() {
        disagreement[(at, row)] += 1.0;
    }
    let causes = Causes {
        disagreement,
        spread: &spread.matrix,
    };
    let by_gains: Vec<_> = (0..dropped.len())
        .map(|at| {
            let mut change = DMatrix::zeros(dropped.len(), count);
            change.set_row(at, &expected.row(at));
            change
        })
        .collect();
    let by_pose = places.pose_derivatives(dropped).map(|rows| rows * &motions);
    let (by_shift, by_rotation) = by_pose.split_at(3);
    let (gains, left_by_gains) = causes.fitted(&by_gains);
    let (shift, left_by_shift) = causes.fitted(by_shift);
    let (rotation, left_by_rotation) = causes.fitted(by_rotation);
    Diagnosis {
        gains: gains.iter().map(|change| 1.0 + change).collect(),
        left_by_gains,
        shift_m: [0, 1, 2].map(|axis| shift[axis]),
        left_by_shift,
        rotation_rad: [0, 1, 2].map(|axis| rotation[axis]),
        left_by_rotation,
    }
}

/// What the rows that are left out show beyond what the others say, as combinations of all rows.
struct Causes<'a> {
    disagreement: DMatrix<f64>,
    spread: &'a DMatrix<f64>,
}

impl Causes<'_> {
    /// Least squares of the disagreement by changes, the smallest one of those that are as good; and the share that is
    /// left.
    fn fitted(&self, changes: &[DMatrix<f64>]) -> (DVector<f64>, f64) {
        let product = |one: &DMatrix<f64>, other: &DMatrix<f64>| (one * self.spread).dot(other);
        let count = changes.len();
        let normal = DMatrix::from_fn(count, count, |p, q| product(&changes[p], &changes[q]));
        let right = DVector::from_fn(count, |p, _| product(&changes[p], &self.disagreement));
        let whole = product(&self.disagreement, &self.disagreement);
        let least = NOTHING * normal.diagonal().max();
        let solved = bolted_joint_singular::solution(normal, &right, least);
        let solution = solved.unwrap_or_else(|| DVector::zeros(count));
        let explained = right.dot(&solution);
        let left = if whole > 0.0 {
            1.0 - explained / whole
        } else {
            0.0
        };
        (solution, left.clamp(0.0, 1.0))
    }
}
