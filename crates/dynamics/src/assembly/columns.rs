//! Small matrices by their columns: sixteen sums at a time, which stay where they are while the columns pass.

use super::{
    matrix::Matrix,
    products::{Column, LANES, column_sums},
};

/// Rows at a time.
const ROWS: usize = size_of::<Column>() / size_of::<f64>();

/// A matrix for many products with few rows.
#[derive(Clone, Debug)]
pub(super) struct Columns {
    count: usize,
    /// Column by column of the first rows, then of the next ones; zero where rows are missing.
    all: Vec<Column>,
}

impl Columns {
    pub(super) fn of(matrix: &Matrix) -> Self {
        let (rows, count) = (matrix.rows(), matrix.columns());
        let blocks = rows.div_ceil(ROWS);
        let entry = |row: usize, j: usize| if row < rows { matrix[(row, j)] } else { 0.0 };
        let column = |block: usize, j: usize| -> Column {
            let row = |group: usize, lane: usize| block * ROWS + group * LANES + lane;
            std::array::from_fn(|group| std::array::from_fn(|lane| entry(row(group, lane), j)))
        };
        let of_block = |block| (0..count).map(move |j| column(block, j));
        Self {
            count,
            all: (0..blocks).flat_map(of_block).collect(),
        }
    }

    /// Adds A x to `sum`.
    #[inline]
    pub(super) fn add_product_to(&self, x: &[f64], sum: &mut [f64]) {
        if self.count == 0 {
            return;
        }
        let blocks = self.all.chunks_exact(self.count);
        for (sums, block) in sum.chunks_mut(ROWS).zip(blocks) {
            let own = column_sums(block, x);
            for (sum, own) in sums.iter_mut().zip(own.as_flattened()) {
                *sum += own;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;

    #[test]
    fn the_product_is_that_of_the_matrix() {
        let mut random = Random(3);
        for [rows, columns] in [[0, 0], [2, 5], [10, 25], [16, 40], [60, 150]] {
            let mut row = |size| -> Vec<f64> { (0..size).map(|_| random.unit() - 0.5).collect() };
            let (entries, x, mut sum) = (row(rows * columns), row(columns), row(rows));
            let matrix = Matrix::from_fn(rows, columns, |i, j| entries[i * columns + j]);
            let expected: Vec<f64> = (0..rows)
                .map(|i| sum[i] + (0..columns).map(|j| matrix[(i, j)] * x[j]).sum::<f64>())
                .collect();
            Columns::of(&matrix).add_product_to(&x, &mut sum);
            for (own, expected) in sum.iter().zip(expected) {
                assert!((own - expected).abs() < 1e-14, "{rows} × {columns}");
            }
        }
    }
}
