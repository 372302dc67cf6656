//! Sums of products, which is what most of a step of an assembly is: several rows at a time, so that no sum waits for the one
//! before, and what they share is read once.
//!
//! They give the same bits on every processor. One that takes more numbers at once than all of its kind do takes them in less
//! time if they are compiled for it: see [`Products`].

use std::sync::OnceLock;

/// Terms of a sum that stand side by side.
pub const LANES: usize = 4;
/// Rows at a time.
pub const ROWS: usize = 4;

/// Columns of rows, in groups.
pub type Groups<'a> = &'a [[f64; LANES]];

/// The sums of each of several rows, group by group.
pub type GroupSums = fn(&[Groups<'_>; ROWS], Groups<'_>) -> [[f64; LANES]; ROWS];

/// Adds several rows, each with its factor, to a sum.
pub type AddRows = fn(&[(f64, &[f64]); ROWS], &mut [f64]);

/// Sixteen numbers of a column.
pub type Column = [[f64; LANES]; 4];

/// The sums of columns, each with its factor.
pub type ColumnSums = fn(&[Column], &[f64]) -> Column;

/// [`group_sums`], [`add_rows`] and [`sums_of_columns`] as a processor takes them, each compiled for that one.
#[derive(Clone, Copy, Debug)]
pub struct Products {
    /// [`group_sums`].
    pub group_sums: GroupSums,
    /// [`add_rows`].
    pub add_rows: AddRows,
    /// [`sums_of_columns`].
    pub column_sums: ColumnSums,
}

impl Products {
    /// As every processor takes them.
    const OF_ANY: Self = Self {
        group_sums: of_any::group_sums,
        add_rows: of_any::add_rows,
        column_sums: of_any::column_sums,
    };

    /// Takes all sums of this process so from now on. Only the first call counts.
    pub fn are_taken(self) {
        let _ = TAKEN.set(self);
    }

    #[inline]
    fn taken() -> &'static Self {
        TAKEN.get().unwrap_or(&Self::OF_ANY)
    }
}

static TAKEN: OnceLock<Products> = OnceLock::new();

/// By themselves, so that the lanes are what the compiler does at once, and not the rows.
mod of_any {
    use super::{Column, Groups, LANES, ROWS};

    #[inline(never)]
    pub(super) fn group_sums(rows: &[Groups<'_>; ROWS], x: Groups<'_>) -> [[f64; LANES]; ROWS] {
        super::group_sums(rows, x)
    }

    pub(super) fn add_rows(terms: &[(f64, &[f64]); ROWS], sum: &mut [f64]) {
        super::add_rows(terms, sum);
    }

    pub(super) fn column_sums(columns: &[Column], x: &[f64]) -> Column {
        super::sums_of_columns(columns, x)
    }
}

/// Σ aᵢ bᵢ
#[inline]
pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut sums = [0.0; LANES];
    let ((a, rest_of_a), (b, rest_of_b)) = (a.as_chunks::<LANES>(), b.as_chunks::<LANES>());
    for (a, b) in a.iter().zip(b) {
        for lane in 0..LANES {
            sums[lane] += a[lane] * b[lane];
        }
    }
    total(sums, rest_of_a, rest_of_b)
}

/// Σ aᵢ xᵢ of several rows a, all of them of the length of x. Each is the same to the bit as by itself.
#[inline]
pub(super) fn dots(rows: [&[f64]; ROWS], x: &[f64]) -> [f64; ROWS] {
    let sums = (Products::taken().group_sums)(
        &rows.map(|row| row[..x.len()].as_chunks().0),
        x.as_chunks().0,
    );
    let whole = x.len() - x.len() % LANES;
    std::array::from_fn(|row| total(sums[row], &rows[row][whole..], &x[whole..]))
}

/// The lanes' sums, and what is left of two rows beside them.
#[inline]
fn total([first, second, third, fourth]: [f64; LANES], a: &[f64], b: &[f64]) -> f64 {
    let rest: f64 = a.iter().zip(b).map(|(a, b)| a * b).sum();
    (first + second) + (third + fourth) + rest
}

/// Adds Σ factor · row to `sum`, term by term in their order.
#[inline]
pub(super) fn add(terms: &[(f64, &[f64]); ROWS], sum: &mut [f64]) {
    (Products::taken().add_rows)(terms, sum);
}

/// Σ xⱼ · column j
#[inline]
pub(super) fn column_sums(columns: &[Column], x: &[f64]) -> Column {
    (Products::taken().column_sums)(columns, x)
}

/// The sums of each row, lane by lane: Σₖ aₖ xₖ of the groups k. Rows have the length of x, or more.
#[inline(always)]
#[must_use]
pub fn group_sums(rows: &[Groups<'_>; ROWS], x: Groups<'_>) -> [[f64; LANES]; ROWS] {
    let rows = rows.map(|row| &row[..x.len()]);
    let mut sums = [[0.0; LANES]; ROWS];
    for (place, x) in x.iter().enumerate() {
        for (sums, row) in sums.iter_mut().zip(rows) {
            for (sum, (own, x)) in sums.iter_mut().zip(row[place].iter().zip(x)) {
                *sum += own * x;
            }
        }
    }
    sums
}

/// Adds Σ factor · row to `sum`, term by term in their order. Rows have its length, or more.
#[inline(always)]
pub fn add_rows<const ROWS: usize>(terms: &[(f64, &[f64]); ROWS], sum: &mut [f64]) {
    let size = sum.len();
    let terms = terms.map(|(factor, row)| (factor, &row[..size]));
    for (place, sum) in sum.iter_mut().enumerate() {
        for (factor, row) in terms {
            *sum += factor * row[place];
        }
    }
}

/// Σ xⱼ · column j, term by term in their order.
#[inline(always)]
#[must_use]
pub fn sums_of_columns(columns: &[Column], x: &[f64]) -> Column {
    let mut sums = Column::default();
    for (column, x) in columns.iter().zip(x) {
        for (sums, own) in sums.iter_mut().zip(column) {
            for (sum, own) in sums.iter_mut().zip(own) {
                *sum += own * x;
            }
        }
    }
    sums
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;

    /// What slides is on its corner to the bit, whichever way its motion was summed.
    #[test]
    fn several_rows_give_the_bits_of_each_by_itself() {
        let mut random = Random(11);
        for size in [0, 1, 3, 4, 7, 31, 424] {
            let mut row = || -> Vec<f64> { (0..size).map(|_| 2.0 * random.unit() - 1.0).collect() };
            let (x, rows) = (row(), [row(), row(), row(), row()]);
            let each = dots(rows.each_ref().map(Vec::as_slice), &x);
            for (row, own) in rows.iter().zip(each) {
                assert_eq!(dot(row, &x).to_bits(), own.to_bits(), "{size}");
                let plain: f64 = row.iter().zip(&x).map(|(a, b)| a * b).sum();
                assert!((own - plain).abs() < 1e-13, "{size}");
            }
            let (mut together, mut one_by_one) = (x.clone(), x.clone());
            let factors = [0.3, -1.7, 2.9, 0.8];
            let terms = std::array::from_fn(|i| (factors[i], &rows[i][..]));
            add(&terms, &mut together);
            for term in terms {
                add_rows(&[term], &mut one_by_one);
            }
            assert_eq!(together, one_by_one, "{size}");
        }
    }
}
