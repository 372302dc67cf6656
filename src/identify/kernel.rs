//! H^C_ss of a joint at one line, with what its derivatives are made of.
//!
//! With symmetric matrices (Tol 3.17), Q = (I + F K*)⁻¹ H_ks, X = Z⁻¹ H_ks = K* Q and F = H_jj + H_kk:
//! H^C_ss = H_ss − H_sk X, its derivative by K* is −Qᵀ dK* Q, by F it is +Xᵀ dF X, by H_ks −(dH_skᵀ X + Xᵀ dH_ks).

use num_complex::Complex64;

use super::block::{Entry, Small};

/// Q and X of one line, a column for each point.
#[derive(Clone, Debug, Default)]
pub(super) struct Kernel<const N: usize> {
    transfer: Vec<[Complex64; N]>,
    /// Q = (I + F K*)⁻¹ H_ks
    q: Vec<[Complex64; N]>,
    /// X = K* Q
    x: Vec<[Complex64; N]>,
}

const ZERO: Complex64 = Complex64::new(0.0, 0.0);

impl<const N: usize> Kernel<N> {
    pub(super) fn new() -> Self {
        Self {
            transfer: Vec::new(),
            q: Vec::new(),
            x: Vec::new(),
        }
    }

    /// Solves one line; `None` where I + F K* is singular.
    pub(super) fn solve(
        &mut self,
        free: &Small<N>,
        transfer: &[[Complex64; N]],
        stiffness: &Small<N>,
    ) -> Option<()> {
        let mut loop_gain = product(free, stiffness);
        for (i, row) in loop_gain.iter_mut().enumerate() {
            row[i] += 1.0;
        }
        let inverse = inverse(loop_gain)?;
        self.transfer.clear();
        self.q.clear();
        self.x.clear();
        for column in transfer {
            let q = times(&inverse, column);
            self.x.push(times(stiffness, &q));
            self.q.push(q);
            self.transfer.push(*column);
        }
        Some(())
    }

    /// Q of one point.
    pub(super) fn q(&self, point: usize) -> &[Complex64; N] {
        &self.q[point]
    }

    /// H^C at an entry from H_ss there.
    pub(super) fn receptance(&self, own: Complex64, entry: Entry) -> Complex64 {
        own - dot(&self.transfer[entry.row], &self.x[entry.column])
    }

    /// Derivative of H^C at `entry` by the symmetric entry (i, j) of K*.
    pub(super) fn by_stiffness(&self, entry: Entry, (i, j): (usize, usize)) -> Complex64 {
        let (p, q) = (&self.q[entry.row], &self.q[entry.column]);
        if i == j {
            -(p[i] * q[i])
        } else {
            -(p[i] * q[j] + p[j] * q[i])
        }
    }

    /// Derivative of H^C at `entry` by a measured receptance that enters F, H_ks and H_ss in the given proportions.
    pub(super) fn by_source(
        &self,
        entry: Entry,
        free: Option<&[[f64; N]; N]>,
        transfer: &[[f64; N]],
        own: f64,
    ) -> Complex64 {
        let (x, y) = (&self.x[entry.row], &self.x[entry.column]);
        let mut derivative = Complex64::from(own);
        if let Some(free) = free {
            for i in 0..N {
                for j in 0..N {
                    derivative += x[i] * y[j] * free[i][j];
                }
            }
        }
        if !transfer.is_empty() {
            for i in 0..N {
                derivative -= transfer[entry.row][i] * y[i] + transfer[entry.column][i] * x[i];
            }
        }
        derivative
    }
}

fn product<const N: usize>(left: &Small<N>, right: &Small<N>) -> Small<N> {
    std::array::from_fn(|i| std::array::from_fn(|j| (0..N).map(|k| left[i][k] * right[k][j]).sum()))
}

fn times<const N: usize>(matrix: &Small<N>, vector: &[Complex64; N]) -> [Complex64; N] {
    std::array::from_fn(|i| dot(&matrix[i], vector))
}

fn dot<const N: usize>(left: &[Complex64; N], right: &[Complex64; N]) -> Complex64 {
    let mut sum = ZERO;
    for (l, r) in left.iter().zip(right) {
        sum += l * r;
    }
    sum
}

/// Inverse by Gauss–Jordan elimination with row exchanges.
pub(super) fn inverse<const N: usize>(mut matrix: Small<N>) -> Option<Small<N>> {
    let mut inverse: Small<N> = std::array::from_fn(|i| {
        std::array::from_fn(|j| Complex64::from(if i == j { 1.0 } else { 0.0 }))
    });
    for column in 0..N {
        let mut pivot = column;
        for row in column + 1..N {
            if matrix[row][column].norm_sqr() > matrix[pivot][column].norm_sqr() {
                pivot = row;
            }
        }
        let size = matrix[pivot][column].norm_sqr();
        if !(size.is_finite() && size > 0.0) {
            return None;
        }
        matrix.swap(column, pivot);
        inverse.swap(column, pivot);
        let reciprocal = matrix[column][column].inv();
        for j in 0..N {
            matrix[column][j] *= reciprocal;
            inverse[column][j] *= reciprocal;
        }
        for row in 0..N {
            if row != column {
                let factor = matrix[row][column];
                for j in 0..N {
                    let (m, i) = (matrix[column][j], inverse[column][j]);
                    matrix[row][j] -= factor * m;
                    inverse[row][j] -= factor * i;
                }
            }
        }
    }
    Some(inverse)
}

/// K* = K + jωC from the unknowns: the stiffness of each entry, then the damping of each.
pub(super) fn complex_stiffness<const N: usize>(
    entries: &[(usize, usize)],
    unknowns: &[f64],
    omega: f64,
) -> Small<N> {
    let mut stiffness = [[ZERO; N]; N];
    for (index, &(i, j)) in entries.iter().enumerate() {
        let value = Complex64::new(unknowns[index], omega * unknowns[entries.len() + index]);
        stiffness[i][j] = value;
        stiffness[j][i] = value;
    }
    stiffness
}
