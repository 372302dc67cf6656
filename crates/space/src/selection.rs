//! Which motions of the structures the joints act on.

use nalgebra::DMatrix;
use num_complex::Complex64;

use crate::{Dof, SpaceError};

/// Where one joint in space is among the DOFs of receptances.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Connection {
    /// Rows of the six motions of its side a, in the order of [`Dof::ALL`].
    pub a: [usize; 6],
    /// Rows of the six motions of its side b, at the same point and in the same axes.
    pub b: [usize; 6],
}

/// S: motions that joints act on, as combinations of the DOFs of receptances. Each row says which motion it is, so that
/// rotations can be scaled.
#[derive(Clone, Debug, PartialEq)]
pub struct Selection {
    matrix: DMatrix<f64>,
    dofs: Vec<Dof>,
}

impl Selection {
    /// Any rows, such as the two of a planar joint.
    ///
    /// # Errors
    ///
    /// [`SpaceError::Size`] unless there is a DOF for each row, [`SpaceError::NotFinite`].
    pub fn new(matrix: DMatrix<f64>, dofs: Vec<Dof>) -> Result<Self, SpaceError> {
        let (what, found, expected) = ("DOFs of the selection's rows", dofs.len(), matrix.nrows());
        if found != expected {
            return Err(SpaceError::Size {
                what,
                found,
                expected,
            });
        }
        if !matrix.iter().all(|number| number.is_finite()) {
            return Err(SpaceError::NotFinite {
                what: "the selection",
            });
        }
        Ok(Self { matrix, dofs })
    }

    /// Relative motions q_a − q_b, six rows for each joint, of receptances with `count` DOFs.
    ///
    /// # Errors
    ///
    /// [`SpaceError::TooFew`] for a row beyond the receptances.
    pub fn relative(count: usize, joints: &[Connection]) -> Result<Self, SpaceError> {
        Self::of(
            count,
            joints,
            |matrix, joint, dof, [a, b]| {
                matrix[(6 * joint + dof, a)] += 1.0;
                matrix[(6 * joint + dof, b)] -= 1.0;
            },
            6,
        )
    }

    /// Motions of both sides (q_a; q_b), twelve rows for each joint: for joints with mass on their sides, see
    /// [`lumped`].
    ///
    /// # Errors
    ///
    /// [`SpaceError::TooFew`] for a row beyond the receptances.
    pub fn sides(count: usize, joints: &[Connection]) -> Result<Self, SpaceError> {
        Self::of(
            count,
            joints,
            |matrix, joint, dof, [a, b]| {
                matrix[(12 * joint + dof, a)] = 1.0;
                matrix[(12 * joint + 6 + dof, b)] = 1.0;
            },
            12,
        )
    }

    fn of(
        count: usize,
        joints: &[Connection],
        fill: impl Fn(&mut DMatrix<f64>, usize, usize, [usize; 2]),
        rows: usize,
    ) -> Result<Self, SpaceError> {
        let mut matrix = DMatrix::zeros(rows * joints.len(), count);
        for (number, joint) in joints.iter().enumerate() {
            for dof in 0..6 {
                let sides = [joint.a[dof], joint.b[dof]];
                let most = sides[0].max(sides[1]);
                if most >= count {
                    let what = "DOFs of the receptances";
                    return Err(SpaceError::TooFew {
                        what,
                        found: count,
                        least: most + 1,
                    });
                }
                fill(&mut matrix, number, dof, sides);
            }
        }
        let dofs = Dof::ALL
            .into_iter()
            .cycle()
            .take(rows * joints.len())
            .collect();
        Ok(Self { matrix, dofs })
    }

    /// S
    #[must_use]
    pub fn matrix(&self) -> &DMatrix<f64> {
        &self.matrix
    }

    /// Which motion each row is.
    #[must_use]
    pub fn dofs(&self) -> &[Dof] {
        &self.dofs
    }

    /// Factors of the rows that make lengths of rotations.
    pub(crate) fn lengths(&self, length_m: f64) -> Vec<f64> {
        self.dofs
            .iter()
            .map(|dof| if dof.is_rotation() { length_m } else { 1.0 })
            .collect()
    }
}

/// Z of (q_a; q_b), 12 × 12: a joint whose sides have masses of their own.
///
/// `relative` is D(ω) of the relative motion, the masses are those of sides a and b at the joint's point, kg, kg·m,
/// kg·m².
#[must_use]
pub fn lumped(
    relative: &nalgebra::Matrix6<Complex64>,
    masses: &[nalgebra::Matrix6<f64>; 2],
    omega_rad_per_s: f64,
) -> DMatrix<Complex64> {
    // Z = [D −D; −D D] − ω² blkdiag(M_a, M_b)
    DMatrix::from_fn(12, 12, |i, j| {
        let (side, at) = (i / 6, (i % 6, j % 6));
        if side == j / 6 {
            relative[at] - omega_rad_per_s * omega_rad_per_s * masses[side][at]
        } else {
            -relative[at]
        }
    })
}

/// blkdiag(D₁, D₂, …): several joints that are not coupled with each other.
#[must_use]
pub fn block_diagonal(joints: &[DMatrix<Complex64>]) -> DMatrix<Complex64> {
    let [rows, columns] = [DMatrix::nrows, DMatrix::ncols].map(|of| joints.iter().map(of).sum());
    let mut whole = DMatrix::zeros(rows, columns);
    let (mut row, mut column) = (0, 0);
    for joint in joints {
        whole
            .view_mut((row, column), joint.shape())
            .copy_from(joint);
        row += joint.nrows();
        column += joint.ncols();
    }
    whole
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_select_the_motions_of_the_sides() {
        let joint = Connection {
            a: [0, 1, 2, 3, 4, 5],
            b: [11, 10, 9, 8, 7, 6],
        };
        let motions = nalgebra::DVector::from_fn(12, |i, _| (i * i) as f64);
        let relative = Selection::relative(12, &[joint]).unwrap();
        assert_eq!(
            (relative.matrix() * &motions).as_slice(),
            [-121.0, -99.0, -77.0, -55.0, -33.0, -11.0]
        );
        let sides = Selection::sides(12, &[joint]).unwrap();
        let both = sides.matrix() * &motions;
        assert_eq!(
            both.as_slice(),
            [
                0.0, 1.0, 4.0, 9.0, 16.0, 25.0, 121.0, 100.0, 81.0, 64.0, 49.0, 36.0
            ]
        );
        assert_eq!(sides.dofs()[6..], Dof::ALL);
        assert_eq!(relative.lengths(0.1), [1.0, 1.0, 1.0, 0.1, 0.1, 0.1]);
    }

    #[test]
    fn rows_that_are_not_there_are_refused() {
        let joint = Connection {
            a: [0, 1, 2, 3, 4, 5],
            b: [6, 7, 8, 9, 10, 12],
        };
        let beyond = Selection::relative(12, &[joint]);
        assert!(matches!(
            beyond,
            Err(SpaceError::TooFew {
                found: 12,
                least: 13,
                ..
            })
        ));
        let nameless = Selection::new(DMatrix::identity(2, 2), vec![Dof::Y]);
        assert!(matches!(
            nameless,
            Err(SpaceError::Size {
                found: 1,
                expected: 2,
                ..
            })
        ));
        let broken = Selection::new(DMatrix::from_element(1, 1, f64::NAN), vec![Dof::Y]);
        assert!(matches!(broken, Err(SpaceError::NotFinite { .. })));
    }
}
