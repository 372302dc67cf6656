//! Sums over functions whose derivatives are dyads: what changes of the joint and of the substructures do to a function is a
//! row's motion times a column's motion. The sums over rows and columns are taken one after the other, which costs a small
//! part of what the table of derivatives would.
//!
//! Groups of unknowns θ_pq act as f_oi = Σ x_op θ_pq y_qi, with x and y of their own.

use std::ops::Range;

use nalgebra::{DMatrix, DVector};
use num_complex::Complex64;

/// Which functions there are, rows × columns, and how much each counts.
pub(crate) struct Grid {
    /// 1/σ², 0 for what was not measured.
    weights: DMatrix<f64>,
}

impl Grid {
    pub(crate) fn new(weights: DMatrix<f64>) -> Self {
        Self { weights }
    }
}

/// x (rows × left) and y (right × columns) of one group.
pub(crate) struct Group {
    pub(crate) left: DMatrix<Complex64>,
    pub(crate) right: DMatrix<Complex64>,
}

impl Group {
    /// Unknowns, θ_pq at p·right + q.
    pub(crate) fn count(&self) -> usize {
        self.left.ncols() * self.right.nrows()
    }
}

/// Σ w conj(∂f/∂θ) ∂f/∂θ′ over all functions, for all pairs of unknowns.
///
/// Both sums are products of real matrices: over a row's columns H = Σ_i w conj(y_q) y_u, and over the rows
/// Σ_o conj(x_p) x_r H, with real and imaginary parts one below the other.
pub(crate) fn information(grid: &Grid, groups: &[Group]) -> DMatrix<Complex64> {
    let of_columns = by_columns(grid, groups);
    let firsts = |of: &dyn Fn(&Group) -> usize| -> Vec<usize> {
        let starts = groups.iter().scan(0, |next, group| {
            let first = *next;
            *next += of(group);
            Some(first)
        });
        starts.collect()
    };
    let places = firsts(&|group| group.right.nrows());
    let unknowns = firsts(&Group::count);
    let count = groups.iter().map(Group::count).sum();
    let mut all = DMatrix::zeros(count, count);
    for (s, one) in groups.iter().enumerate() {
        for (t, other) in groups.iter().enumerate().skip(s) {
            let (height, width) = (one.right.nrows(), other.right.nrows());
            let sums = over_rows(
                &by_rows([one, other], s == t),
                &of_columns,
                [places[s]..places[s] + height, places[t]..places[t] + width],
            );
            let half = sums.nrows() / 2;
            let pairs = pairs([one, other], s == t);
            for (pair, [p, r]) in pairs.enumerate() {
                for q in 0..height {
                    for u in 0..width {
                        let place = q * width + u;
                        let value = Complex64::new(sums[(pair, place)], sums[(half + pair, place)]);
                        let i = unknowns[s] + p * height + q;
                        let j = unknowns[t] + r * width + u;
                        all[(i, j)] = value;
                        all[(j, i)] = value.conj();
                    }
                }
            }
        }
    }
    all
}

/// H of each row: real parts, and beside them imaginary ones, right × 2·right of all groups.
fn by_columns(grid: &Grid, groups: &[Group]) -> Vec<DMatrix<f64>> {
    let (rows, columns) = grid.weights.shape();
    let right: usize = groups.iter().map(|group| group.right.nrows()).sum();
    // (Re y, Im y), and what it is multiplied by for real and imaginary parts
    let mut own = DMatrix::zeros(right, 2 * columns);
    let mut others = DMatrix::zeros(2 * columns, 2 * right);
    let mut first = 0;
    for group in groups {
        for (q, row) in group.right.row_iter().enumerate() {
            let q = first + q;
            for (i, y) in row.iter().enumerate() {
                (own[(q, i)], own[(q, columns + i)]) = (y.re, y.im);
                (others[(i, q)], others[(columns + i, q)]) = (y.re, y.im);
                (others[(i, right + q)], others[(columns + i, right + q)]) = (y.im, -y.re);
            }
        }
        first += group.right.nrows();
    }
    let mut weighted = own.clone();
    let of_row = |o: usize| {
        for i in 0..columns {
            let weight = grid.weights[(o, i)];
            for column in [i, columns + i] {
                weighted.set_column(column, &(own.column(column) * weight));
            }
        }
        &weighted * &others
    };
    (0..rows).map(of_row).collect()
}

/// The pairs (p, r) of two groups; of a group with itself the other half follows.
fn pairs([one, other]: [&Group; 2], is_one: bool) -> impl Iterator<Item = [usize; 2]> {
    let (height, width) = (one.left.ncols(), other.left.ncols());
    let from = move |p: usize| if is_one { p } else { 0 };
    (0..height).flat_map(move |p| (from(p)..width).map(move |r| [p, r]))
}

/// conj(x_p) x_r of all rows, 2·pairs × 2·rows: what makes Re and, below, Im of a product from the real and imaginary parts of the
/// other factor.
fn by_rows([one, other]: [&Group; 2], is_one: bool) -> DMatrix<f64> {
    let rows = one.left.nrows();
    let count = pairs([one, other], is_one).count();
    let mut factors = DMatrix::zeros(2 * count, 2 * rows);
    for (pair, [p, r]) in pairs([one, other], is_one).enumerate() {
        for o in 0..rows {
            let factor = one.left[(o, p)].conj() * other.left[(o, r)];
            factors[(pair, o)] = factor.re;
            factors[(pair, rows + o)] = -factor.im;
            factors[(count + pair, o)] = factor.im;
            factors[(count + pair, rows + o)] = factor.re;
        }
    }
    factors
}

/// Σ_o factor · H for the places (q, u) of H: 2·pairs × places, real parts and below imaginary ones.
fn over_rows(
    factors: &DMatrix<f64>,
    of_columns: &[DMatrix<f64>],
    [rows, columns]: [Range<usize>; 2],
) -> DMatrix<f64> {
    let (count, width) = (of_columns.len(), columns.len());
    let mut parts = DMatrix::zeros(2 * count, rows.len() * width);
    for (o, own) in of_columns.iter().enumerate() {
        let right = own.nrows();
        for (place, mut column) in parts.column_iter_mut().enumerate() {
            let (q, u) = (rows.start + place / width, columns.start + place % width);
            (column[o], column[count + o]) = (own[(q, u)], own[(q, right + u)]);
        }
    }
    factors * parts
}

/// Σ w conj(∂f/∂θ) e over all functions, for residuals e (rows × columns).
pub(crate) fn descent(
    grid: &Grid,
    groups: &[Group],
    errors: &DMatrix<Complex64>,
) -> DVector<Complex64> {
    let weighted = errors.zip_map(&grid.weights, |error, weight| weight * error);
    let of = |group: &Group| {
        // x̄ᵀ (w e) ȳᵀ
        let sums = group.left.ad_mul(&weighted) * group.right.adjoint();
        sums.transpose().as_slice().to_vec()
    };
    let all: Vec<Complex64> = groups.iter().flat_map(of).collect();
    DVector::from_vec(all)
}

/// Σ w |e|².
pub(crate) fn squares(grid: &Grid, errors: &DMatrix<Complex64>) -> f64 {
    let terms = errors.iter().zip(&grid.weights);
    terms.map(|(error, weight)| weight * error.norm_sqr()).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By the table of derivatives.
    #[test]
    fn sums_are_those_of_the_derivatives() {
        let mut seed = 3_u32;
        let mut number = || {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            f64::from(seed >> 8) / f64::from(1 << 23) - 1.0
        };
        let mut matrix =
            |n: usize, m: usize| DMatrix::from_fn(n, m, |_, _| Complex64::new(number(), number()));
        let groups = [(2, 3), (4, 2), (6, 6)].map(|(left, right)| Group {
            left: matrix(5, left),
            right: matrix(right, 7),
        });
        let errors = matrix(5, 7);
        let weights = matrix(5, 7).map(|x| if x.re > -0.5 { x.re + 1.0 } else { 0.0 });
        let count: usize = groups.iter().map(Group::count).sum();
        let mut table = DMatrix::zeros(35, count);
        for o in 0..5 {
            for i in 0..7 {
                let mut n = 0;
                for group in &groups {
                    for p in 0..group.left.ncols() {
                        for q in 0..group.right.nrows() {
                            table[(7 * o + i, n)] = group.left[(o, p)] * group.right[(q, i)];
                            n += 1;
                        }
                    }
                }
            }
        }
        let weight = DMatrix::from_fn(35, 35, |i, j| {
            Complex64::from(if i == j { weights[(i / 7, i % 7)] } else { 0.0 })
        });
        let error = DVector::from_fn(35, |n, _| errors[(n / 7, n % 7)]);
        let grid = Grid::new(weights);
        let expected = table.adjoint() * &weight * &table;
        let found = information(&grid, &groups);
        assert!((&found - &expected).norm() < 1e-12 * expected.norm());
        let expected = table.adjoint() * &weight * &error;
        assert!((descent(&grid, &groups, &errors) - &expected).norm() < 1e-12 * expected.norm());
        let expected = (error.adjoint() * weight * error)[0].re;
        assert!((squares(&grid, &errors) - expected).abs() < 1e-12 * expected);
    }
}
