//! Sums over functions whose derivatives are dyads: what changes of the joint and of the substructures do to a function is a
//! row's motion times a column's motion. The sums over rows and columns are taken one after the other, which costs a small
//! part of what the table of derivatives would.
//!
//! Groups of unknowns θ_pq act as f_oi = Σ x_op θ_pq y_qi, with x and y of their own.

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

/// Real and imaginary parts apart: what is summed up then runs through the processor's registers side by side.
#[derive(Clone, Default)]
struct Parts {
    re: Vec<f64>,
    im: Vec<f64>,
}

impl Parts {
    fn zeros(count: usize) -> Self {
        Self {
            re: vec![0.0; count],
            im: vec![0.0; count],
        }
    }

    fn at(&self, place: usize) -> Complex64 {
        Complex64::new(self.re[place], self.im[place])
    }
}

/// target += factor · values
fn add(target: (&mut [f64], &mut [f64]), factor: Complex64, values: (&[f64], &[f64])) {
    let targets = target.0.iter_mut().zip(target.1);
    for ((re, im), (x, y)) in targets.zip(values.0.iter().zip(values.1)) {
        *re += factor.re * x - factor.im * y;
        *im += factor.re * y + factor.im * x;
    }
}

/// Σ w conj(∂f/∂θ) ∂f/∂θ′ over all functions, for all pairs of unknowns.
pub(crate) fn information(grid: &Grid, groups: &[Group]) -> DMatrix<Complex64> {
    let (rows, columns) = grid.weights.shape();
    let right: usize = groups.iter().map(|group| group.right.nrows()).sum();
    // y of all groups, column by column
    let mut y = Parts::zeros(right * columns);
    let mut first = 0;
    for group in groups {
        for i in 0..columns {
            for q in 0..group.right.nrows() {
                let value = group.right[(q, i)];
                (y.re[i * right + first + q], y.im[i * right + first + q]) = (value.re, value.im);
            }
        }
        first += group.right.nrows();
    }
    let pairs: Vec<(usize, usize)> = (0..groups.len())
        .flat_map(|s| (s..groups.len()).map(move |t| (s, t)))
        .collect();
    let mut sums: Vec<Parts> = pairs
        .iter()
        .map(|&(s, t)| Parts::zeros(groups[s].count() * groups[t].count()))
        .collect();
    let firsts: Vec<usize> = groups
        .iter()
        .scan(0, |next, group| {
            let first = *next;
            *next += group.right.nrows();
            Some(first)
        })
        .collect();
    let mut partial = Parts::zeros(right * right);
    let mut block = Parts::default();
    for o in 0..rows {
        // Σ_i w conj(y_q) y_u, q ≤ u
        partial.re.fill(0.0);
        partial.im.fill(0.0);
        for i in 0..columns {
            let weight = grid.weights[(o, i)];
            if weight == 0.0 {
                continue;
            }
            let own = i * right..(i + 1) * right;
            let (re, im) = (&y.re[own.clone()], &y.im[own]);
            for q in 0..right {
                let factor = Complex64::new(weight * re[q], -weight * im[q]);
                if factor == Complex64::ZERO {
                    continue;
                }
                let tail = q * right + q..(q + 1) * right;
                add(
                    (&mut partial.re[tail.clone()], &mut partial.im[tail]),
                    factor,
                    (&re[q..], &im[q..]),
                );
            }
        }
        for q in 0..right {
            for u in 0..q {
                partial.re[q * right + u] = partial.re[u * right + q];
                partial.im[q * right + u] = -partial.im[u * right + q];
            }
        }
        for (&(s, t), sum) in pairs.iter().zip(&mut sums) {
            let (one, other) = (&groups[s], &groups[t]);
            let (height, width) = (one.right.nrows(), other.right.nrows());
            block.re.clear();
            block.im.clear();
            for q in 0..height {
                let from = (firsts[s] + q) * right + firsts[t];
                block.re.extend_from_slice(&partial.re[from..from + width]);
                block.im.extend_from_slice(&partial.im[from..from + width]);
            }
            let size = height * width;
            for p in 0..one.left.ncols() {
                let conjugate = one.left[(o, p)].conj();
                if conjugate == Complex64::ZERO {
                    continue;
                }
                // of a group with itself the other half follows
                let least = if s == t { p } else { 0 };
                for r in least..other.left.ncols() {
                    let factor = conjugate * other.left[(o, r)];
                    if factor == Complex64::ZERO {
                        continue;
                    }
                    let own = (p * other.left.ncols() + r) * size;
                    add(
                        (&mut sum.re[own..own + size], &mut sum.im[own..own + size]),
                        factor,
                        (&block.re, &block.im),
                    );
                }
            }
        }
    }
    gathered(groups, &pairs, &sums)
}

/// The sums of each pair of groups as one matrix.
fn gathered(groups: &[Group], pairs: &[(usize, usize)], sums: &[Parts]) -> DMatrix<Complex64> {
    let count = groups.iter().map(Group::count).sum();
    let mut all = DMatrix::zeros(count, count);
    let first = |group: usize| -> usize { groups[..group].iter().map(Group::count).sum() };
    for (&(s, t), sum) in pairs.iter().zip(sums) {
        let (one, other) = (&groups[s], &groups[t]);
        let (height, width) = (one.right.nrows(), other.right.nrows());
        let (row, column) = (first(s), first(t));
        for p in 0..one.left.ncols() {
            let least = if s == t { p } else { 0 };
            for r in least..other.left.ncols() {
                let own = (p * other.left.ncols() + r) * height * width;
                for q in 0..height {
                    for u in 0..width {
                        let value = sum.at(own + q * width + u);
                        let (i, j) = (row + p * height + q, column + r * width + u);
                        all[(i, j)] = value;
                        all[(j, i)] = value.conj();
                    }
                }
            }
        }
    }
    all
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
