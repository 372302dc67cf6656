//! The six motions of a point, and how the numbers of a symmetric 6×6 matrix are named by them.

use std::fmt;

use nalgebra::Matrix6;

/// A motion of a point, or the load that does work on it: three translations, then three rotations about the same axes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Dof {
    /// Translation along x, m
    X,
    /// Translation along y, m
    Y,
    /// Translation along z, m
    Z,
    /// Rotation about x, rad
    Rx,
    /// Rotation about y, rad
    Ry,
    /// Rotation about z, rad
    Rz,
}

impl Dof {
    /// All six, in the order of every matrix here.
    pub const ALL: [Self; 6] = [Self::X, Self::Y, Self::Z, Self::Rx, Self::Ry, Self::Rz];

    /// Its row in matrices of six.
    #[must_use]
    pub const fn index(self) -> usize {
        self as usize
    }

    /// Whether it is a rotation.
    #[must_use]
    pub const fn is_rotation(self) -> bool {
        matches!(self, Self::Rx | Self::Ry | Self::Rz)
    }

    /// What it is called in names of numbers: `x`, `rx`.
    #[must_use]
    pub const fn symbol(self) -> &'static str {
        ["x", "y", "z", "rx", "ry", "rz"][self.index()]
    }
}

impl fmt::Display for Dof {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.symbol())
    }
}

/// Which of a joint's matrices a number belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Part {
    /// K: N/m, N, N·m/rad
    Stiffness,
    /// C: N·s/m, N·s, N·m·s/rad
    Damping,
    /// M: kg, kg·m, kg·m²
    Inertia,
}

impl Part {
    const fn letter(self) -> char {
        match self {
            Self::Stiffness => 'k',
            Self::Damping => 'c',
            Self::Inertia => 'm',
        }
    }
}

/// A place in a symmetric matrix: row and column, the row first in [`Dof::ALL`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Entry {
    /// Row
    pub row: Dof,
    /// Column, not before the row
    pub column: Dof,
}

impl Entry {
    /// The 21 places on and above the diagonal, row by row.
    pub const ALL: [Self; 21] = {
        let mut entries = [Self::on(Dof::X, Dof::X); 21];
        let (mut at, mut row) = (0, 0);
        while row < 6 {
            let mut column = row;
            while column < 6 {
                entries[at] = Self::on(Dof::ALL[row], Dof::ALL[column]);
                at += 1;
                column += 1;
            }
            row += 1;
        }
        entries
    };

    const fn on(row: Dof, column: Dof) -> Self {
        Self { row, column }
    }

    /// The place of two DOFs, in either order.
    #[must_use]
    pub fn new(one: Dof, other: Dof) -> Self {
        Self::on(one.min(other), one.max(other))
    }

    /// `k_x` on the diagonal, `k_x_ry` beside it.
    #[must_use]
    pub fn name(self, part: Part) -> String {
        let (letter, row) = (part.letter(), self.row);
        if self.row == self.column {
            format!("{letter}_{row}")
        } else {
            format!("{letter}_{row}_{}", self.column)
        }
    }

    /// The matrix that is one here and across the diagonal, and zero elsewhere: dK/dk_pq.
    #[must_use]
    pub fn unit(self) -> Matrix6<f64> {
        let mut matrix = Matrix6::zeros();
        let (row, column) = (self.row.index(), self.column.index());
        matrix[(row, column)] = 1.0;
        matrix[(column, row)] = 1.0;
        matrix
    }
}

/// The symmetric matrix of 21 numbers in the order of [`Entry::ALL`].
#[must_use]
pub fn symmetric(numbers: &[f64; 21]) -> Matrix6<f64> {
    let mut matrix = Matrix6::zeros();
    for (entry, &number) in Entry::ALL.iter().zip(numbers) {
        let (row, column) = (entry.row.index(), entry.column.index());
        matrix[(row, column)] = number;
        matrix[(column, row)] = number;
    }
    matrix
}

/// The 21 numbers on and above the diagonal, in the order of [`Entry::ALL`].
#[must_use]
pub fn numbers(matrix: &Matrix6<f64>) -> [f64; 21] {
    Entry::ALL.map(|entry| matrix[(entry.row.index(), entry.column.index())])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_21_numbers_stand_row_by_row() {
        let counted = std::array::from_fn(|i| i as f64);
        let matrix = symmetric(&counted);
        assert_eq!(matrix, matrix.transpose());
        assert_eq!(
            matrix.row(0).iter().copied().collect::<Vec<_>>(),
            [0.0, 1.0, 2.0, 3.0, 4.0, 5.0]
        );
        assert_eq!(
            [matrix[(1, 1)], matrix[(5, 4)], matrix[(5, 5)]],
            [6.0, 19.0, 20.0]
        );
        assert_eq!(numbers(&matrix), counted);
        let units = Entry::ALL
            .iter()
            .zip(counted)
            .map(|(entry, number)| entry.unit() * number);
        assert_eq!(units.sum::<Matrix6<f64>>(), matrix);
    }

    #[test]
    fn names_say_the_part_and_the_dofs() {
        assert_eq!(Entry::new(Dof::Ry, Dof::X).name(Part::Stiffness), "k_x_ry");
        assert_eq!(Entry::new(Dof::Rz, Dof::Rz).name(Part::Damping), "c_rz");
        assert_eq!(Entry::new(Dof::Y, Dof::Z).name(Part::Inertia), "m_y_z");
    }
}
