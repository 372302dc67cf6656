//! Dense matrices of a size that is known only when an assembly is read: what the propagators are made of.

use std::ops::{Index, IndexMut};

use super::products::{ROWS as BLOCK, add, dot, dots};

/// Columns below which that gains nothing.
const SHORT: usize = 16;

/// A matrix, row by row.
#[derive(Clone, Debug, PartialEq)]
pub struct Matrix {
    rows: usize,
    columns: usize,
    values: Vec<f64>,
}

impl Matrix {
    /// All zero.
    #[must_use]
    pub fn zeros(rows: usize, columns: usize) -> Self {
        Self {
            rows,
            columns,
            values: vec![0.0; rows * columns],
        }
    }

    /// One on the diagonal.
    #[must_use]
    pub fn identity(size: usize) -> Self {
        Self::from_fn(size, size, |i, j| if i == j { 1.0 } else { 0.0 })
    }

    /// The matrix with these entries, by row and column.
    #[must_use]
    pub fn from_fn(rows: usize, columns: usize, of: impl Fn(usize, usize) -> f64) -> Self {
        let mut matrix = Self::zeros(rows, columns);
        for i in 0..rows {
            for (j, value) in matrix.row_mut(i).iter_mut().enumerate() {
                *value = of(i, j);
            }
        }
        matrix
    }

    /// Number of rows.
    #[inline]
    #[must_use]
    pub const fn rows(&self) -> usize {
        self.rows
    }

    /// Number of columns.
    #[inline]
    #[must_use]
    pub const fn columns(&self) -> usize {
        self.columns
    }

    /// One row.
    #[inline]
    #[must_use]
    pub fn row(&self, i: usize) -> &[f64] {
        &self.values[i * self.columns..(i + 1) * self.columns]
    }

    /// All rows, one after the other.
    pub(super) fn rows_mut(&mut self) -> impl Iterator<Item = &mut [f64]> {
        self.values.chunks_exact_mut(self.columns.max(1))
    }

    #[inline]
    fn row_mut(&mut self, i: usize) -> &mut [f64] {
        &mut self.values[i * self.columns..(i + 1) * self.columns]
    }

    /// All entries, row by row.
    pub fn iter(&self) -> impl Iterator<Item = &f64> {
        self.values.iter()
    }

    /// Whether every entry is a finite number.
    #[must_use]
    pub fn is_finite(&self) -> bool {
        self.values.iter().all(|value| value.is_finite())
    }

    /// Aᵀ
    #[must_use]
    pub fn transposed(&self) -> Self {
        Self::from_fn(self.columns, self.rows, |i, j| self[(j, i)])
    }

    /// `factor · A`
    #[must_use]
    pub fn times(&self, factor: f64) -> Self {
        let values = self.values.iter().map(|value| factor * value).collect();
        Self { values, ..*self }
    }

    /// `A + factor · B`, for matrices of one shape.
    #[must_use]
    pub fn plus(&self, factor: f64, other: &Self) -> Self {
        debug_assert_eq!((self.rows, self.columns), (other.rows, other.columns));
        let pairs = self.values.iter().zip(&other.values);
        Self {
            values: pairs.map(|(own, other)| own + factor * other).collect(),
            ..*self
        }
    }

    /// A B
    #[must_use]
    pub fn product(&self, other: &Self) -> Self {
        debug_assert_eq!(self.columns, other.rows);
        let mut product = Self::zeros(self.rows, other.columns);
        for i in 0..self.rows {
            let sum = product.row_mut(i);
            for (&factor, row) in self
                .row(i)
                .iter()
                .zip(other.values.chunks_exact(other.columns.max(1)))
            {
                // the matrices that come here are triangular by blocks
                if factor == 0.0 {
                    continue;
                }
                for (sum, value) in sum.iter_mut().zip(row) {
                    *sum += factor * value;
                }
            }
        }
        product
    }

    /// Matrices of one number of columns, one under the other.
    pub(super) fn stacked(parts: impl Iterator<Item = Self>) -> Self {
        parts
            .reduce(|mut above, below| {
                above.values.extend(below.values);
                above.rows += below.rows;
                above
            })
            .unwrap_or_else(|| Self::zeros(0, 0))
    }

    /// The modulus of each entry.
    pub(super) fn moduli(&self) -> Self {
        let values = self.values.iter().map(|value| value.abs()).collect();
        Self { values, ..*self }
    }

    /// Part of the matrix: `rows` by `columns` entries from row `top` and column `left` on.
    #[must_use]
    pub fn block(&self, [top, left]: [usize; 2], rows: usize, columns: usize) -> Self {
        Self::from_fn(rows, columns, |i, j| self[(top + i, left + j)])
    }

    /// Puts `block` in place of the entries from row `top` and column `left` on.
    pub fn set_block(&mut self, [top, left]: [usize; 2], block: &Self) {
        for i in 0..block.rows {
            self.row_mut(top + i)[left..left + block.columns].copy_from_slice(block.row(i));
        }
    }

    /// Adds A x to `sum`.
    #[inline]
    pub fn add_product_to(&self, x: &[f64], sum: &mut [f64]) {
        debug_assert_eq!((self.columns, self.rows), (x.len(), sum.len()));
        if self.columns < SHORT {
            for (i, sum) in sum.iter_mut().enumerate() {
                *sum += dot(self.row(i), x);
            }
            return;
        }
        for (block, sums) in sum.chunks_mut(BLOCK).enumerate() {
            // where rows are missing the last one stands in
            let rows = std::array::from_fn(|i| self.row(BLOCK * block + i.min(sums.len() - 1)));
            for (sum, own) in sums.iter_mut().zip(dots(rows, x)) {
                *sum += own;
            }
        }
    }

    /// Adds Aᵀ x to `sum`, row by row; what is zero costs nothing.
    #[inline]
    pub(super) fn add_rows_to(&self, x: &[f64], sum: &mut [f64]) {
        let mut block = [(0.0, &[][..]); BLOCK];
        let mut count = 0;
        for (i, &factor) in x.iter().enumerate() {
            if factor != 0.0 {
                block[count] = (factor, self.row(i));
                count += 1;
            }
            if count == BLOCK {
                add(&block, sum);
                count = 0;
            }
        }
        if let Some(&(_, last)) = block[..count].last() {
            // where rows are missing nothing of the last one is added
            block[count..].fill((0.0, last));
            add(&block, sum);
        }
    }

    /// ‖A‖₁, the largest sum of a column's moduli.
    #[must_use]
    pub fn norm(&self) -> f64 {
        let of_column = |j| (0..self.rows).map(|i| self[(i, j)].abs()).sum::<f64>();
        (0..self.columns).map(of_column).fold(0.0, f64::max)
    }

    /// X in A X = B, by elimination with pivots from the column; `None` where A is singular to the last digit.
    #[must_use]
    pub fn solved(mut self, mut right: Self) -> Option<Self> {
        let size = self.rows;
        for pivot in 0..size {
            let largest = (pivot..size)
                .max_by(|&i, &j| self[(i, pivot)].abs().total_cmp(&self[(j, pivot)].abs()))?;
            if self[(largest, pivot)] == 0.0 || !self[(largest, pivot)].is_finite() {
                return None;
            }
            self.swap_rows(pivot, largest);
            right.swap_rows(pivot, largest);
            for row in pivot + 1..size {
                let factor = self[(row, pivot)] / self[(pivot, pivot)];
                if factor != 0.0 {
                    self.subtract_row(row, factor, pivot, pivot);
                    right.subtract_row(row, factor, pivot, 0);
                }
            }
        }
        for row in (0..size).rev() {
            for other in row + 1..size {
                let factor = self[(row, other)];
                if factor != 0.0 {
                    right.subtract_row(row, factor, other, 0);
                }
            }
            let own = self[(row, row)];
            right
                .row_mut(row)
                .iter_mut()
                .for_each(|value| *value /= own);
        }
        Some(right)
    }

    /// L with L Lᵀ = A of a symmetric A that is nowhere negative; zeros where it is nothing. `None` where it is negative.
    pub(super) fn cholesky(&self) -> Option<Self> {
        let mut lower = Self::zeros(self.rows, self.rows);
        for j in 0..self.rows {
            let before = &lower.row(j)[..j];
            let rest = self[(j, j)] - dot(before, before);
            let rounding = 8.0 * f64::EPSILON * self[(j, j)].abs();
            if rest < -rounding || !rest.is_finite() {
                return None;
            }
            let pivot = if rest > rounding { rest.sqrt() } else { 0.0 };
            lower[(j, j)] = pivot;
            for i in j + 1..self.rows {
                let rest = self[(i, j)] - dot(&lower.row(i)[..j], &lower.row(j)[..j]);
                if pivot > 0.0 {
                    lower[(i, j)] = rest / pivot;
                } else if rest.abs() > rounding.max(8.0 * f64::EPSILON * self[(i, j)].abs()) {
                    return None;
                }
            }
        }
        Some(lower)
    }

    /// Rows i and j (i before j) turned by an angle: cos aᵢ − sin aⱼ and sin aᵢ + cos aⱼ.
    pub(super) fn rotate_rows(&mut self, [i, j]: [usize; 2], [cosine, sine]: [f64; 2]) {
        let columns = self.columns;
        let (first, second) = self.values.split_at_mut(j * columns);
        let rows = first[i * columns..].iter_mut().zip(&mut second[..columns]);
        for (own, other) in rows {
            let [x, y] = [*own, *other];
            *own = cosine * x - sine * y;
            *other = sine * x + cosine * y;
        }
    }

    fn swap_rows(&mut self, i: usize, j: usize) {
        if i != j {
            let (low, high) = (i.min(j), i.max(j));
            let (first, second) = self.values.split_at_mut(high * self.columns);
            first[low * self.columns..(low + 1) * self.columns]
                .swap_with_slice(&mut second[..self.columns]);
        }
    }

    /// Subtracts `factor` times row `from` from another row, from column `first` on.
    fn subtract_row(&mut self, row: usize, factor: f64, from: usize, first: usize) {
        let columns = self.columns;
        let (low, high) = (row.min(from), row.max(from));
        let (before, after) = self.values.split_at_mut(high * columns);
        let (low, high) = (
            &mut before[low * columns..(low + 1) * columns],
            &mut after[..columns],
        );
        let (own, other) = if row < from { (low, high) } else { (high, low) };
        for (own, other) in own[first..].iter_mut().zip(&other[first..]) {
            *own -= factor * other;
        }
    }
}

impl Index<(usize, usize)> for Matrix {
    type Output = f64;

    #[inline]
    fn index(&self, (i, j): (usize, usize)) -> &f64 {
        &self.values[i * self.columns + j]
    }
}

impl IndexMut<(usize, usize)> for Matrix {
    #[inline]
    fn index_mut(&mut self, (i, j): (usize, usize)) -> &mut f64 {
        &mut self.values[i * self.columns + j]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;

    fn random(rows: usize, columns: usize, seed: u64) -> Matrix {
        let mut random = Random(seed);
        let mut matrix = Matrix::zeros(rows, columns);
        for i in 0..rows {
            for j in 0..columns {
                matrix[(i, j)] = 2.0 * random.unit() - 1.0;
            }
        }
        matrix
    }

    #[test]
    fn what_is_solved_gives_the_right_side_again() {
        for size in 1..12 {
            let (left, right) = (random(size, size, 3), random(size, 3, 4));
            let x = left.clone().solved(right.clone()).unwrap();
            let difference = left.product(&x).plus(-1.0, &right);
            assert!(difference.norm() < 1e-12, "{size}");
        }
        let singular = Matrix::from_fn(2, 2, |i, _| 1.0 + i as f64);
        assert_eq!(singular.solved(Matrix::identity(2)), None);
    }

    #[test]
    fn a_pivot_that_is_zero_is_exchanged() {
        let left = Matrix::from_fn(2, 2, |i, j| if i == j { 0.0 } else { 2.0 });
        let x = left.solved(Matrix::identity(2)).unwrap();
        assert_eq!(
            x,
            Matrix::from_fn(2, 2, |i, j| if i == j { 0.0 } else { 0.5 })
        );
    }

    #[test]
    fn products_are_sums_over_rows_and_columns() {
        let (a, b) = (random(5, 7, 1), random(7, 4, 2));
        let product = a.product(&b);
        for i in 0..5 {
            for j in 0..4 {
                let sum: f64 = (0..7).map(|k| a[(i, k)] * b[(k, j)]).sum();
                assert!((product[(i, j)] - sum).abs() < 1e-15);
            }
        }
        let mut sum = vec![1.0; 5];
        a.add_product_to(b.transposed().row(2), &mut sum);
        for i in 0..5 {
            assert!((sum[i] - 1.0 - product[(i, 2)]).abs() < 1e-15);
        }
    }

    #[test]
    fn a_triangle_times_its_own_transpose_is_the_matrix() {
        let factor = random(4, 6, 5);
        let matrix = factor.product(&factor.transposed());
        let lower = matrix.cholesky().unwrap();
        let off = lower.product(&lower.transposed()).plus(-1.0, &matrix);
        assert!(off.norm() < 1e-14 * matrix.norm());
        assert!((0..4).all(|i| (i + 1..4).all(|j| lower[(i, j)] == 0.0)));
        // stiff in two directions of three
        let flat = factor.block([0, 0], 3, 2);
        let flat = flat.product(&flat.transposed());
        let lower = flat.cholesky().unwrap();
        assert!(lower.product(&lower.transposed()).plus(-1.0, &flat).norm() < 1e-14);
        assert_eq!(matrix.times(-1.0).cholesky(), None);
    }
}
