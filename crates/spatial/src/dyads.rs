//! Sums over functions whose derivatives are dyads: what changes of the joint and of the substructures do to a function is a
//! row's motion times a column's motion. The sums over rows and columns are taken one after the other, which costs a small
//! part of what the table of derivatives would.
//!
//! Groups of unknowns θ_pq act as f_oi = Σ x_op θ_pq y_qi, with x and y of their own.

use std::borrow::Cow;

use nalgebra::{DMatrix, DVector};
use num_complex::Complex64;

use crate::problem::Problem;

/// Which functions there are, rows × columns, and how much each counts.
#[derive(Clone)]
pub(crate) struct Grid {
    /// 1/σ², 0 for what was not measured; of the rows and columns in which anything was.
    weights: DMatrix<f64>,
    /// These rows and columns, where there are others.
    measured: Option<[Vec<usize>; 2]>,
}

impl Grid {
    /// Of 1/σ², 0 for what was not measured.
    pub(crate) fn new(weights: DMatrix<f64>) -> Self {
        let is_measured = |weight: &f64| *weight > 0.0;
        let rows = (0..weights.nrows()).filter(|&row| weights.row(row).iter().any(is_measured));
        let columns = 0..weights.ncols();
        let columns = columns.filter(|&column| weights.column(column).iter().any(is_measured));
        let measured = [rows.collect::<Vec<_>>(), columns.collect()];
        match measured.each_ref().map(Vec::len) == [weights.nrows(), weights.ncols()] {
            true => Self {
                weights,
                measured: None,
            },
            false => Self {
                weights: weights
                    .select_rows(&measured[0])
                    .select_columns(&measured[1]),
                measured: Some(measured),
            },
        }
    }

    /// Where the functions are that were measured, and how much each counts.
    pub(crate) fn functions(&self) -> impl Iterator<Item = ([usize; 2], f64)> {
        let count = self.weights.nrows();
        let place = move |n: usize| match &self.measured {
            None => [n % count, n / count],
            Some([rows, columns]) => [rows[n % count], columns[n / count]],
        };
        let weights = self.weights.iter().enumerate();
        let weights = weights.map(move |(n, weight)| (place(n), *weight));
        weights.filter(|(_, weight)| *weight > 0.0)
    }

    /// What a group does to the rows and columns in which anything was measured.
    fn of_group<'g>(&self, group: &'g Group) -> Cow<'g, Group> {
        match &self.measured {
            None => Cow::Borrowed(group),
            Some([rows, columns]) => Cow::Owned(Group {
                left: group.left.select_rows(rows),
                right: group.right.select_columns(columns),
            }),
        }
    }

    /// Likewise values of all functions.
    fn of_values<'v>(&self, values: &'v DMatrix<Complex64>) -> Cow<'v, DMatrix<Complex64>> {
        match &self.measured {
            None => Cow::Borrowed(values),
            Some([rows, columns]) => Cow::Owned(values.select_rows(rows).select_columns(columns)),
        }
    }
}

/// The grid of the assembly's functions at each line.
pub(crate) struct Lines<'p> {
    problem: &'p Problem,
    deviations: &'p [f64],
    /// That of all lines, where these are alike.
    all: Option<Grid>,
}

impl<'p> Lines<'p> {
    pub(crate) fn of(problem: &'p Problem, deviations: &'p [f64]) -> Self {
        let is_even = problem.observed.iter().all(|one| one.uneven.is_empty());
        Self {
            problem,
            deviations,
            all: is_even.then(|| Grid::new(problem.weights(deviations))),
        }
    }

    pub(crate) fn at(&self, line: usize) -> Cow<'_, Grid> {
        match &self.all {
            Some(all) => Cow::Borrowed(all),
            None => Cow::Owned(Grid::new(self.problem.weights_at(self.deviations, line))),
        }
    }
}

/// x (rows × left) and y (right × columns) of one group.
#[derive(Clone)]
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

/// Groups, and where the unknowns of each begin among all.
pub(crate) type Placed<'g> = [(usize, &'g Group)];

/// Σ w conj(∂f/∂θ) ∂f/∂θ′ over all functions, for all pairs of unknowns.
pub(crate) fn information(grid: &Grid, groups: &[Group]) -> DMatrix<Complex64> {
    let (count, placed) = side_by_side(groups);
    let mut all = DMatrix::zeros(count, count);
    add_below(grid, &placed, &mut all);
    mirror(&mut all);
    all
}

/// How many unknowns there are, and the groups one after the other.
pub(crate) fn side_by_side(groups: &[Group]) -> (usize, Vec<(usize, &Group)>) {
    let mut next = 0;
    let placed = groups.iter().map(|group| {
        let place = next;
        next += group.count();
        (place, group)
    });
    let placed = placed.collect();
    (next, placed)
}

/// What [`information`] gives, added to the lower triangle of `all`; groups stand in the order of their places. [`mirror`] does the
/// rest when all is summed up.
///
/// Both sums are products of real matrices: over the columns H = Σ_i w conj(y_q) y_u for all rows at once, and over the rows
/// Σ_o conj(x_p) x_r H.
pub(crate) fn add_below(grid: &Grid, groups: &Placed<'_>, all: &mut DMatrix<Complex64>) {
    let weights = grid.weights.transpose();
    let groups = groups.iter();
    let groups: Vec<_> = groups
        .map(|(place, group)| (*place, grid.of_group(group)))
        .collect();
    for (s, (first, one)) in groups.iter().enumerate() {
        for (t, (second, other)) in groups.iter().enumerate().skip(s) {
            let [of_columns, turned] = over_columns(&one.right, &other.right, &weights);
            let pairs = pairs([one, other], s == t);
            let [of_rows, sideways] = by_rows([one, other], &pairs);
            let mut even = &of_columns * &of_rows;
            even.gemm(-1.0, &turned, &sideways, 1.0);
            let mut odd = &of_columns * &sideways;
            odd.gemm(1.0, &turned, &of_rows, 1.0);
            let (height, width) = (one.right.nrows(), other.right.nrows());
            for (pair, &[p, r]) in pairs.iter().enumerate() {
                for q in 0..height {
                    let mut column = all.column_mut(first + p * height + q);
                    let own = column.rows_range_mut(second + r * width..second + (r + 1) * width);
                    let of = |matrix: &DMatrix<f64>| q * width + pair * matrix.nrows();
                    let (even, odd) = (&even.as_slice()[of(&even)..], &odd.as_slice()[of(&odd)..]);
                    for ((own, even), odd) in own.into_iter().zip(even).zip(odd) {
                        *own += Complex64::new(*even, -odd);
                    }
                }
            }
        }
    }
}

/// What is above the diagonal, of a matrix that is Hermitian.
pub(crate) fn mirror(all: &mut DMatrix<Complex64>) {
    for j in 0..all.ncols() {
        for i in 0..j {
            all[(i, j)] = all[(j, i)].conj();
        }
    }
}

/// Re H and Im H, (q, u) × rows.
fn over_columns(
    one: &DMatrix<Complex64>,
    other: &DMatrix<Complex64>,
    weights: &DMatrix<f64>,
) -> [DMatrix<f64>; 2] {
    let width = other.nrows();
    let products = parts(one.nrows() * width, one.ncols(), |place, column| {
        one[(place / width, column)].conj() * other[(place % width, column)]
    });
    products.map(|own| own * weights)
}

/// The pairs (p, r) of two groups; of a group with itself the other half follows.
fn pairs([one, other]: [&Group; 2], is_one: bool) -> Vec<[usize; 2]> {
    let (height, width) = (one.left.ncols(), other.left.ncols());
    let from = move |p: usize| if is_one { p } else { 0 };
    (0..height)
        .flat_map(move |p| (from(p)..width).map(move |r| [p, r]))
        .collect()
}

/// Re and Im of conj(x_p) x_r of all rows, rows × pairs.
fn by_rows([one, other]: [&Group; 2], pairs: &[[usize; 2]]) -> [DMatrix<f64>; 2] {
    parts(one.left.nrows(), pairs.len(), |row, pair| {
        let [p, r] = pairs[pair];
        one.left[(row, p)].conj() * other.left[(row, r)]
    })
}

/// Real and imaginary parts of a matrix.
fn parts(
    rows: usize,
    columns: usize,
    value: impl Fn(usize, usize) -> Complex64,
) -> [DMatrix<f64>; 2] {
    let whole = DMatrix::from_fn(rows, columns, value);
    [whole.map(|value| value.re), whole.map(|value| value.im)]
}

/// Σ w conj(∂f/∂θ) e over all functions, for residuals e (rows × columns).
pub(crate) fn descent(
    grid: &Grid,
    groups: &[Group],
    errors: &DMatrix<Complex64>,
) -> DVector<Complex64> {
    let (count, placed) = side_by_side(groups);
    let mut all = DVector::zeros(count);
    add_descent(grid, &placed, errors, &mut all);
    all
}

/// What [`descent`] gives, added to `all`.
pub(crate) fn add_descent(
    grid: &Grid,
    groups: &Placed<'_>,
    errors: &DMatrix<Complex64>,
    all: &mut DVector<Complex64>,
) {
    let weighted = grid.of_values(errors);
    let weighted = weighted.zip_map(&grid.weights, |error, weight| weight * error);
    for (first, group) in groups {
        let group = grid.of_group(group);
        // x̄ᵀ (w e) ȳᵀ, row by row
        let sums = group.left.ad_mul(&weighted) * group.right.adjoint();
        for (own, sum) in all.iter_mut().skip(*first).zip(sums.transpose().iter()) {
            *own += sum;
        }
    }
}

/// Σ w Re conj(d) e.
pub(crate) fn product(grid: &Grid, d: &DMatrix<Complex64>, e: &DMatrix<Complex64>) -> f64 {
    let (d, e) = (grid.of_values(d), grid.of_values(e));
    let terms = d.iter().zip(e.iter()).zip(&grid.weights);
    terms
        .map(|((d, e), weight)| weight * (d.conj() * e).re)
        .sum()
}

/// Σ w |e|².
pub(crate) fn squares(grid: &Grid, errors: &DMatrix<Complex64>) -> f64 {
    let errors = grid.of_values(errors);
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
