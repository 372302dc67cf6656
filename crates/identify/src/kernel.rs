//! H^C_ss of a joint at one line, or at several side by side, with what its derivatives are made of.
//!
//! With symmetric matrices (Tol 3.17), Q = (I + F K*)⁻¹ H_ks, X = Z⁻¹ H_ks = K* Q and F = H_jj + H_kk:
//! H^C_ss = H_ss − H_sk X, its derivative by K* is −Qᵀ dK* Q, by F it is +Xᵀ dF X, by H_ks −(dH_skᵀ X + Xᵀ dH_ks).

use num_complex::Complex64;

use super::block::{Entry, Small};
use super::group::Pattern;
use super::lanes::Number;
use super::layout::Place;

/// Q and X of one line, a column for each point.
#[derive(Clone, Debug, Default)]
pub(super) struct Kernel<const N: usize, T = Complex64> {
    transfer: Vec<[T; N]>,
    /// Q = (I + F K*)⁻¹ H_ks
    q: Vec<[T; N]>,
    /// X = K* Q
    x: Vec<[T; N]>,
}

impl<const N: usize, T: Number> Kernel<N, T> {
    pub(super) fn new() -> Self {
        Self {
            transfer: Vec::new(),
            q: Vec::new(),
            x: Vec::new(),
        }
    }

    /// Solves one line, whose H_ks has these columns; `None` where I + F K* is singular.
    #[inline(always)]
    pub(super) fn solve(
        &mut self,
        free: &Small<N, T>,
        transfer: impl ExactSizeIterator<Item = [T; N]>,
        stiffness: &Small<N, T>,
    ) -> Option<()> {
        let mut loop_gain = product(free, stiffness);
        for (i, row) in loop_gain.iter_mut().enumerate() {
            row[i] += T::ONE;
        }
        let inverse = inverse(loop_gain)?;
        let zero = [T::ZERO; N];
        for columns in [&mut self.transfer, &mut self.q, &mut self.x] {
            columns.resize(transfer.len(), zero);
        }
        let own = self.transfer.iter_mut().zip(&mut self.q).zip(&mut self.x);
        for (column, ((own, q), x)) in transfer.zip(own) {
            *own = column;
            *q = times(&inverse, &column);
            *x = times(stiffness, q);
        }
        Some(())
    }

    /// Q of one point.
    #[inline(always)]
    pub(super) fn q(&self, point: usize) -> &[T; N] {
        &self.q[point]
    }

    /// H^C at an entry from H_ss there.
    #[inline(always)]
    pub(super) fn receptance(&self, own: T, entry: Entry) -> T {
        own - dot(&self.transfer[entry.row], &self.x[entry.column])
    }

    /// Qᵀ E Q at `entry`, E having ones at (i, j) and (j, i).
    #[inline(always)]
    pub(super) fn through(&self, entry: Entry, (i, j): (usize, usize)) -> T {
        let (p, q) = (&self.q[entry.row], &self.q[entry.column]);
        if i == j {
            p[i] * q[i]
        } else {
            p[i] * q[j] + p[j] * q[i]
        }
    }
}

impl<const N: usize> Kernel<N> {
    /// Derivative of H^C at `entry` by an unknown entry of K*, in every block that has it.
    #[inline]
    pub(super) fn by_stiffness(&self, entry: Entry, place: Place) -> Complex64 {
        -place
            .all()
            .map(|at| self.through(entry, at))
            .sum::<Complex64>()
    }

    /// Derivative of H^C at `entry` by a measured receptance that enters F, H_ks and H_ss as the pattern says.
    pub(super) fn by_source(&self, entry: Entry, pattern: &Pattern<N>, own: f64) -> Complex64 {
        let (x, y) = (&self.x[entry.row], &self.x[entry.column]);
        let mut derivative = Complex64::from(own);
        for &(i, j, share) in &pattern.entries_of_free {
            derivative += x[i] * y[j] * share;
        }
        for &i in &pattern.dofs_of_transfer {
            let share = |point: usize| pattern.transfer[point][i];
            derivative -= share(entry.row) * y[i] + share(entry.column) * x[i];
        }
        derivative
    }
}

#[inline(always)]
pub(super) fn product<const N: usize, T: Number>(
    left: &Small<N, T>,
    right: &Small<N, T>,
) -> Small<N, T> {
    let mut product = [[T::ZERO; N]; N];
    for i in 0..N {
        for j in 0..N {
            for k in 0..N {
                product[i][j] += left[i][k] * right[k][j];
            }
        }
    }
    product
}

#[inline(always)]
fn times<const N: usize, T: Number>(matrix: &Small<N, T>, vector: &[T; N]) -> [T; N] {
    std::array::from_fn(|i| dot(&matrix[i], vector))
}

/// Σ left·right, without conjugation.
#[inline(always)]
pub(super) fn dot<const N: usize, T: Number>(left: &[T; N], right: &[T; N]) -> T {
    let mut sum = T::ZERO;
    for (l, r) in left.iter().zip(right) {
        sum += *l * *r;
    }
    sum
}

/// Inverse of a small matrix; `None` if it is singular, at any of several lines.
#[inline(always)]
pub(super) fn inverse<const N: usize, T: Number>(matrix: Small<N, T>) -> Option<Small<N, T>> {
    if N != 2 {
        return eliminated(matrix);
    }
    // [a b; c d]⁻¹ = [d −b; −c a]/(ad − bc)
    let determinant = matrix[0][0] * matrix[1][1] - matrix[0][1] * matrix[1][0];
    let reciprocal = determinant.reciprocal()?;
    let mut inverse = matrix;
    inverse[0][0] = matrix[1][1] * reciprocal;
    inverse[1][1] = matrix[0][0] * reciprocal;
    inverse[0][1] = -matrix[0][1] * reciprocal;
    inverse[1][0] = -matrix[1][0] * reciprocal;
    Some(inverse)
}

/// Inverse by Gauss–Jordan elimination with row exchanges.
fn eliminated<const N: usize, T: Number>(mut matrix: Small<N, T>) -> Option<Small<N, T>> {
    let mut inverse: Small<N, T> =
        std::array::from_fn(|i| std::array::from_fn(|j| if i == j { T::ONE } else { T::ZERO }));
    for column in 0..N {
        let mut pivot = column;
        for row in column + 1..N {
            if matrix[row][column].outweighs(matrix[pivot][column]) {
                pivot = row;
            }
        }
        let reciprocal = matrix[pivot][column].reciprocal()?;
        matrix.swap(column, pivot);
        inverse.swap(column, pivot);
        for j in 0..N {
            matrix[column][j] = matrix[column][j] * reciprocal;
            inverse[column][j] = inverse[column][j] * reciprocal;
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
    let mut stiffness = [[Complex64::ZERO; N]; N];
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
        assert_eq!(inverse([[Complex64::ZERO; 2]; 2]), None);
        assert_eq!(inverse([[Complex64::ZERO; 1]; 1]), None);
    }
}
