//! Substitution with a triangular matrix that is nothing beside a band, as the mass matrix of a beam has it.

use nalgebra::DMatrix;

/// A lower triangular matrix L with its band alone.
pub(super) struct Banded {
    /// Entries on either side of the diagonal, and the diagonal itself.
    width: usize,
    /// Rows of the band, L[i][i − w] to L[i][i].
    rows: Vec<f64>,
    /// Columns of it, L[i][i] to L[i + w][i].
    columns: Vec<f64>,
}

impl Banded {
    /// The lower triangle of a matrix whose diagonal has no zeros.
    pub(super) fn of(lower: &DMatrix<f64>) -> Self {
        let size = lower.nrows();
        let reach = (0..size).map(|j| {
            let below = (j..size).rev().find(|&i| lower[(i, j)] != 0.0);
            below.map_or(0, |i| i - j)
        });
        let width = 1 + reach.max().unwrap_or(0);
        let entry = |i: usize, j: usize| if i < size { lower[(i, j)] } else { 0.0 };
        let row = |i: usize| {
            (0..width).map(move |k| (i + k + 1).checked_sub(width).map_or(0.0, |j| entry(i, j)))
        };
        let column = |j: usize| (0..width).map(move |k| entry(j + k, j));
        Self {
            width,
            rows: (0..size).flat_map(row).collect(),
            columns: (0..size).flat_map(column).collect(),
        }
    }

    /// L⁻¹ B
    pub(super) fn solve(&self, mut matrix: DMatrix<f64>) -> DMatrix<f64> {
        for mut column in matrix.column_iter_mut() {
            let x = column.as_mut_slice();
            for (i, row) in self.rows.chunks_exact(self.width).enumerate() {
                let first = (i + 1).saturating_sub(self.width);
                let (before, own) = row.split_at(self.width - 1);
                let before = &before[first + self.width - 1 - i..];
                let known: f64 = before.iter().zip(&x[first..i]).map(|(l, x)| l * x).sum();
                x[i] = (x[i] - known) / own[0];
            }
        }
        matrix
    }

    /// L⁻ᵀ B
    pub(super) fn solve_transposed(&self, mut matrix: DMatrix<f64>) -> DMatrix<f64> {
        for mut column in matrix.column_iter_mut() {
            let x = column.as_mut_slice();
            for (i, own) in self.columns.chunks_exact(self.width).enumerate().rev() {
                let later = own[1..].iter().zip(&x[i + 1..]);
                let known: f64 = later.map(|(l, x)| l * x).sum();
                x[i] = (x[i] - known) / own[0];
            }
        }
        matrix
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_is_what_the_whole_triangle_gives() {
        for (size, width) in [(1, 1), (2, 1), (7, 3), (5, 5)] {
            let number = |i: usize, j: usize| (1.0 + (3 * i + 7 * j) as f64).sin();
            let lower = DMatrix::from_fn(size, size, |i, j| match i.checked_sub(j) {
                Some(0) => 2.0,
                Some(below) if below < width => number(i, j),
                _ => 0.0,
            });
            let right = DMatrix::from_fn(size, 3, |i, j| number(j, i));
            let banded = Banded::of(&lower);
            assert_eq!(banded.width, width);
            let back = &lower * banded.solve(right.clone());
            assert!((back - &right).amax() < 1e-12);
            let back = lower.transpose() * banded.solve_transposed(right.clone());
            assert!((back - &right).amax() < 1e-12);
        }
    }
}
