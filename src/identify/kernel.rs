//! H^C_ss of a joint at one line, with what its derivatives are made of.
//!
//! With symmetric matrices (Tol 3.17), Q = (I + F K*)⁻¹ H_ks, X = Z⁻¹ H_ks = K* Q and F = H_jj + H_kk:
//! H^C_ss = H_ss − H_sk X, its derivative by K* is −Qᵀ dK* Q, by F it is +Xᵀ dF X, by H_ks −(dH_skᵀ X + Xᵀ dH_ks).

use num_complex::Complex64;

use super::block::{Entry, Small};
use super::layout::Place;

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
        self.transfer.resize(transfer.len(), [ZERO; N]);
        self.q.resize(transfer.len(), [ZERO; N]);
        self.x.resize(transfer.len(), [ZERO; N]);
        self.transfer.copy_from_slice(transfer);
        for ((column, q), x) in transfer.iter().zip(&mut self.q).zip(&mut self.x) {
            *q = times(&inverse, column);
            *x = times(stiffness, q);
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

    /// Derivative of H^C at `entry` by an unknown entry of K*, in every block that has it.
    #[inline]
    pub(super) fn by_stiffness(&self, entry: Entry, place: Place) -> Complex64 {
        let (p, q) = (&self.q[entry.row], &self.q[entry.column]);
        let mut derivative = ZERO;
        for (i, j) in place.all() {
            derivative -= p[i] * q[j];
            if i != j {
                derivative -= p[j] * q[i];
            }
        }
        derivative
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

#[inline]
fn product<const N: usize>(left: &Small<N>, right: &Small<N>) -> Small<N> {
    let mut product = [[ZERO; N]; N];
    for i in 0..N {
        for j in 0..N {
            for k in 0..N {
                product[i][j] += left[i][k] * right[k][j];
            }
        }
    }
    product
}

#[inline]
fn times<const N: usize>(matrix: &Small<N>, vector: &[Complex64; N]) -> [Complex64; N] {
    let mut product = [ZERO; N];
    for i in 0..N {
        product[i] = dot(&matrix[i], vector);
    }
    product
}

#[inline]
fn dot<const N: usize>(left: &[Complex64; N], right: &[Complex64; N]) -> Complex64 {
    let mut sum = ZERO;
    for (l, r) in left.iter().zip(right) {
        sum += l * r;
    }
    sum
}

/// Inverse of a small matrix; `None` if it is singular.
pub(super) fn inverse<const N: usize>(matrix: Small<N>) -> Option<Small<N>> {
    if N != 2 {
        return eliminated(matrix);
    }
    // [a b; c d]⁻¹ = [d −b; −c a]/(ad − bc)
    let determinant = matrix[0][0] * matrix[1][1] - matrix[0][1] * matrix[1][0];
    let size = determinant.norm_sqr();
    if !(size.is_finite() && size > 0.0) {
        return None;
    }
    let reciprocal = determinant.conj() / size;
    let mut inverse = matrix;
    inverse[0][0] = matrix[1][1] * reciprocal;
    inverse[1][1] = matrix[0][0] * reciprocal;
    inverse[0][1] = -matrix[0][1] * reciprocal;
    inverse[1][0] = -matrix[1][0] * reciprocal;
    Some(inverse)
}

/// Inverse by Gauss–Jordan elimination with row exchanges.
fn eliminated<const N: usize>(mut matrix: Small<N>) -> Option<Small<N>> {
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
    entries: &[Place],
    unknowns: &[f64],
    omega: f64,
) -> Small<N> {
    let mut stiffness = [[ZERO; N]; N];
    for (index, place) in entries.iter().enumerate() {
        let value = Complex64::new(unknowns[index], omega * unknowns[entries.len() + index]);
        for (i, j) in place.all() {
            stiffness[i][j] = value;
            stiffness[j][i] = value;
        }
    }
    stiffness
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_inverses_agree_with_the_definition() {
        let c = Complex64::new;
        let matrix = [[c(1.0, 2.0), c(-3.0, 0.5)], [c(0.25, -1.0), c(2.0, 0.0)]];
        for inverse in [inverse(matrix).unwrap(), eliminated(matrix).unwrap()] {
            let unit = product(&matrix, &inverse);
            for i in 0..2 {
                for j in 0..2 {
                    let expected = if i == j { 1.0 } else { 0.0 };
                    assert!((unit[i][j] - expected).norm() < 1e-15);
                }
            }
        }
        assert_eq!(inverse([[ZERO; 2]; 2]), None);
        assert_eq!(inverse([[ZERO; 1]; 1]), None);
    }
}
