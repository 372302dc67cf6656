//! H^C_ss of a joint at one line, or at several side by side, with what its derivatives are made of.
//!
//! With symmetric matrices (Tol 3.17), Q = (I + F K*)⁻¹ H_ks, X = Z⁻¹ H_ks = K* Q and F = H_jj + H_kk:
//! H^C_ss = H_ss − H_sk X, its derivative by K* is −Qᵀ dK* Q.

use num_complex::Complex64;

use super::block::Entry;
use super::lanes::Number;
use super::layout::Place;

/// Room for a matrix of the joint's DOFs at one line, or at several side by side. What a joint with fewer DOFs leaves of it
/// is zero.
pub(super) type Small<const N: usize, T = Complex64> = [[T; N]; N];

/// The instance of a generic function with room for so many joint DOFs; `None` where there is no such joint.
macro_rules! for_dofs {
    ($dofs:expr, $function:ident) => {
        match $dofs {
            1 => Some($function::<1> as _),
            2 => Some($function::<2> as _),
            3..=4 => Some($function::<4> as _),
            5..=8 => Some($function::<8> as _),
            9..=16 => Some($function::<16> as _),
            _ => None,
        }
    };
}
pub(super) use for_dofs;

/// How many of N rows a joint with so many DOFs fills. Of one and two DOFs, which have instances of their own, the compiler
/// knows it.
#[inline(always)]
pub(super) const fn filled<const N: usize>(dofs: usize) -> usize {
    if N <= 2 || dofs > N { N } else { dofs }
}

/// A vector with these first entries, the others zero.
#[inline(always)]
pub(super) fn vector<const N: usize, T: Number>(dofs: usize, value: impl Fn(usize) -> T) -> [T; N] {
    let mut vector = [T::ZERO; N];
    for (i, entry) in vector[..filled::<N>(dofs)].iter_mut().enumerate() {
        *entry = value(i);
    }
    vector
}

/// A matrix with these first rows and columns, the others zero.
#[inline(always)]
pub(super) fn matrix<const N: usize, T: Number>(
    dofs: usize,
    value: impl Fn(usize, usize) -> T,
) -> Small<N, T> {
    let mut matrix = [[T::ZERO; N]; N];
    for (i, row) in matrix[..filled::<N>(dofs)].iter_mut().enumerate() {
        *row = vector(dofs, |j| value(i, j));
    }
    matrix
}

/// Q and X of one line, a column for each point.
#[derive(Clone, Debug)]
pub(super) struct Kernel {
    dofs: usize,
    solve: Option<Solve>,
    transfer: Vec<Complex64>,
    /// Q = (I + F K*)⁻¹ H_ks
    q: Vec<Complex64>,
    /// X = K* Q
    x: Vec<Complex64>,
}

/// A joint at one line: the places of its K*, its unknowns, and ω.
type Joint<'u> = (&'u [Place], &'u [f64], f64);
type Solve = fn(&mut Kernel, &[Complex64], &[Complex64], Joint<'_>) -> Option<()>;

impl Kernel {
    /// For a joint with so many DOFs.
    pub(super) fn new(dofs: usize) -> Self {
        Self {
            dofs,
            solve: for_dofs!(dofs, solve),
            transfer: Vec::new(),
            q: Vec::new(),
            x: Vec::new(),
        }
    }

    /// Solves one line with F, by rows, and the columns of H_ks; `None` where I + F K* is singular.
    pub(super) fn solve(
        &mut self,
        free: &[Complex64],
        transfer: &[Complex64],
        joint: Joint<'_>,
    ) -> Option<()> {
        self.solve?(self, free, transfer, joint)
    }

    /// The column of one point.
    fn column<'c>(&self, columns: &'c [Complex64], point: usize) -> &'c [Complex64] {
        &columns[point * self.dofs..(point + 1) * self.dofs]
    }

    /// H^C at an entry from H_ss there.
    pub(super) fn receptance(&self, own: Complex64, entry: Entry) -> Complex64 {
        let transfer = self.column(&self.transfer, entry.row);
        own - dot(transfer, self.column(&self.x, entry.column))
    }

    /// Derivative of H^C at `entry` by an unknown entry of K*, in every block that has it.
    pub(super) fn by_stiffness(&self, entry: Entry, place: Place) -> Complex64 {
        let p = self.column(&self.q, entry.row);
        let q = self.column(&self.q, entry.column);
        -place.all().map(|at| through(p, q, at)).sum::<Complex64>()
    }
}

fn solve<const N: usize>(
    kernel: &mut Kernel,
    free: &[Complex64],
    transfer: &[Complex64],
    (entries, unknowns, omega): Joint<'_>,
) -> Option<()> {
    let dofs = filled::<N>(kernel.dofs);
    let stiffness = complex_stiffness::<N>(entries, unknowns, omega);
    let free = matrix(dofs, |i, j| free[i * dofs + j]);
    let inverse = coupled(dofs, &free, &stiffness)?;
    kernel.transfer.clear();
    kernel.transfer.extend_from_slice(transfer);
    kernel.q.clear();
    kernel.x.clear();
    for column in transfer.chunks_exact(dofs) {
        let q = times(dofs, &inverse, &vector(dofs, |i| column[i]));
        let x = times(dofs, &stiffness, &q);
        kernel.q.extend_from_slice(&q[..dofs]);
        kernel.x.extend_from_slice(&x[..dofs]);
    }
    Some(())
}

/// (I + F K*)⁻¹; `None` where it is singular.
#[inline(always)]
pub(super) fn coupled<const N: usize, T: Number>(
    dofs: usize,
    free: &Small<N, T>,
    stiffness: &Small<N, T>,
) -> Option<Small<N, T>> {
    inverse(dofs, closed_loop(dofs, free, stiffness))
}

/// I + F K*
#[inline(always)]
pub(super) fn closed_loop<const N: usize, T: Number>(
    dofs: usize,
    free: &Small<N, T>,
    stiffness: &Small<N, T>,
) -> Small<N, T> {
    let mut closed = product(dofs, free, stiffness);
    for (i, row) in closed.iter_mut().enumerate() {
        row[i] += T::ONE;
    }
    closed
}

/// pᵀ E q, E having ones at (i, j) and (j, i).
#[inline(always)]
pub(super) fn through<T: Number>(p: &[T], q: &[T], (i, j): (usize, usize)) -> T {
    if i == j {
        p[i] * q[i]
    } else {
        p[i] * q[j] + p[j] * q[i]
    }
}

#[inline(always)]
pub(super) fn product<const N: usize, T: Number>(
    dofs: usize,
    left: &Small<N, T>,
    right: &Small<N, T>,
) -> Small<N, T> {
    let dofs = filled::<N>(dofs);
    let mut product = [[T::ZERO; N]; N];
    for i in 0..dofs {
        for j in 0..dofs {
            for k in 0..dofs {
                product[i][j] += left[i][k] * right[k][j];
            }
        }
    }
    product
}

#[inline(always)]
pub(super) fn times<const N: usize, T: Number>(
    dofs: usize,
    matrix: &Small<N, T>,
    column: &[T; N],
) -> [T; N] {
    let dofs = filled::<N>(dofs);
    vector(dofs, |i| dot(&matrix[i][..dofs], &column[..dofs]))
}

/// Σ left·right, without conjugation.
#[inline(always)]
pub(super) fn dot<T: Number>(left: &[T], right: &[T]) -> T {
    let mut sum = T::ZERO;
    for (l, r) in left.iter().zip(right) {
        sum += *l * *r;
    }
    sum
}

/// Inverse of a small matrix; `None` if it is singular, at any of several lines.
#[inline(always)]
pub(super) fn inverse<const N: usize, T: Number>(
    dofs: usize,
    matrix: Small<N, T>,
) -> Option<Small<N, T>> {
    if N != 2 {
        return eliminated(dofs, matrix);
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
fn eliminated<const N: usize, T: Number>(
    dofs: usize,
    mut matrix: Small<N, T>,
) -> Option<Small<N, T>> {
    let dofs = filled::<N>(dofs);
    let mut inverse = [[T::ZERO; N]; N];
    for (i, row) in inverse.iter_mut().enumerate() {
        row[i] = T::ONE;
    }
    for column in 0..dofs {
        let mut pivot = column;
        for row in column + 1..dofs {
            if matrix[row][column].outweighs(matrix[pivot][column]) {
                pivot = row;
            }
        }
        let reciprocal = matrix[pivot][column].reciprocal()?;
        matrix.swap(column, pivot);
        inverse.swap(column, pivot);
        for j in 0..dofs {
            matrix[column][j] = matrix[column][j] * reciprocal;
            inverse[column][j] = inverse[column][j] * reciprocal;
        }
        for row in 0..dofs {
            if row != column {
                let factor = matrix[row][column];
                for j in 0..dofs {
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
        for inverse in [inverse(2, matrix).unwrap(), eliminated(2, matrix).unwrap()] {
            let unit = product(2, &matrix, &inverse);
            for i in 0..2 {
                for j in 0..2 {
                    let expected = if i == j { 1.0 } else { 0.0 };
                    assert!((unit[i][j] - expected).norm() < 1e-15);
                }
            }
        }
        assert_eq!(inverse(2, [[Complex64::ZERO; 2]; 2]), None);
        assert_eq!(inverse(1, [[Complex64::ZERO; 1]; 1]), None);
    }

    #[test]
    fn room_that_a_joint_does_not_fill_changes_nothing() {
        let c = Complex64::new;
        let own = [
            [c(1.0, 2.0), c(-3.0, 0.5), c(0.1, 0.0)],
            [c(0.25, -1.0), c(2.0, 0.0), c(0.0, 4.0)],
            [c(-0.5, 0.0), c(1.0, 1.0), c(3.0, -2.0)],
        ];
        let exact = inverse(3, own).unwrap();
        let roomy: Small<8> = matrix(3, |i, j| own[i][j]);
        let found = inverse(3, roomy).unwrap();
        let unit = product(3, &roomy, &found);
        for i in 0..3 {
            assert_eq!(found[i][..3], exact[i]);
            assert_eq!(found[i][3..], [Complex64::ZERO; 5]);
            for j in 0..3 {
                let expected = if i == j { 1.0 } else { 0.0 };
                assert!((unit[i][j] - expected).norm() < 1e-15);
            }
        }
    }
}
