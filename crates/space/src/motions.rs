//! Which motions of an interface a test is about: all six, or those of a plane.

use std::fmt;

use nalgebra::Matrix6;

use crate::{Dof, SpaceError};

/// Some of the six motions.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Motions([bool; 6]);

impl Motions {
    /// All six.
    pub const ALL: Self = Self([true; 6]);

    /// These.
    ///
    /// # Errors
    ///
    /// [`SpaceError::TooFew`] for none.
    pub fn of(dofs: &[Dof]) -> Result<Self, SpaceError> {
        if dofs.is_empty() {
            let (what, found, least) = ("motions", 0, 1);
            return Err(SpaceError::TooFew { what, found, least });
        }
        Ok(Self(Dof::ALL.map(|dof| dofs.contains(&dof))))
    }

    /// Whether this one is among them.
    #[must_use]
    pub const fn has(self, dof: Dof) -> bool {
        self.0[dof.index()]
    }

    /// Whether all six are.
    #[must_use]
    pub fn are_all(self) -> bool {
        self == Self::ALL
    }

    /// How many there are.
    #[must_use]
    pub fn count(self) -> usize {
        self.dofs().count()
    }

    /// In the order of [`Dof::ALL`].
    pub fn dofs(self) -> impl Iterator<Item = Dof> {
        Dof::ALL.into_iter().filter(move |&dof| self.has(dof))
    }

    /// The rows of these motions in matrices of six.
    #[must_use]
    pub fn rows(self) -> Vec<usize> {
        self.dofs().map(Dof::index).collect()
    }

    /// What of a matrix is between these motions.
    #[must_use]
    pub fn part(self, matrix: &Matrix6<f64>) -> Matrix6<f64> {
        Matrix6::from_fn(|i, j| {
            if self.0[i] && self.0[j] {
                matrix[(i, j)]
            } else {
                0.0
            }
        })
    }

    /// How much of a matrix couples these motions to others: the largest m_ij beside √(m_ii m_jj).
    #[must_use]
    pub fn coupling_to_others(self, matrix: &Matrix6<f64>) -> f64 {
        let mut largest = 0.0_f64;
        for i in (0..6).filter(|&i| self.0[i]) {
            for j in (0..6).filter(|&j| !self.0[j] && matrix[(i, j)] != 0.0) {
                let size = (matrix[(i, i)] * matrix[(j, j)]).abs().sqrt();
                largest = largest.max(matrix[(i, j)].abs() / size);
            }
        }
        largest
    }
}

impl fmt::Display for Motions {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let symbols: Vec<&str> = self.dofs().map(Dof::symbol).collect();
        f.write_str(&symbols.join(", "))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_part_has_what_is_between_its_motions() {
        let motions = Motions::of(&[Dof::Rz, Dof::Y]).unwrap();
        assert_eq!(motions.to_string(), "y, rz");
        assert_eq!((motions.count(), motions.rows()), (2, vec![1, 5]));
        let matrix = Matrix6::from_fn(|i, j| (10 * i.min(j) + i.max(j)) as f64);
        let part = motions.part(&matrix);
        assert_eq!(
            (part[(1, 5)], part[(5, 5)], part[(1, 2)], part[(0, 0)]),
            (15.0, 55.0, 0.0, 0.0)
        );
        assert_eq!(Motions::ALL.part(&matrix), matrix);
    }

    #[test]
    fn coupling_is_told_beside_what_is_coupled() {
        let motions = Motions::of(&[Dof::Y, Dof::Rz]).unwrap();
        let mut matrix = Matrix6::from_diagonal_element(4.0);
        matrix[(1, 5)] = 3.0;
        matrix[(5, 1)] = 3.0;
        assert_eq!(motions.coupling_to_others(&matrix), 0.0);
        matrix[(0, 5)] = 1.0;
        matrix[(5, 0)] = 1.0;
        assert_eq!(motions.coupling_to_others(&matrix), 0.25);
        assert_eq!(Motions::ALL.coupling_to_others(&matrix), 0.0);
    }
}
