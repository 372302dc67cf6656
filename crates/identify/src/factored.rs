//! I + F K* of a line, or of several side by side, factored to be solved for many columns.
//!
//! Below the first elastic mode F is nearly singular beside its rigid motions, and what the joint's sides move against each other is a
//! small difference of large numbers. An explicit inverse would leave few of its digits.

use super::kernel::{Small, filled, inverse, product, times};
use super::lanes::Number;

/// LU factors with row exchanges; of one and two DOFs the inverse.
pub(super) struct Factored<const N: usize, T> {
    /// Below the diagonal L, which has ones there; from the diagonal on U.
    rows: Small<N, T>,
    /// 1/U_ii
    reciprocals: [T; N],
    /// Which row came to each place.
    order: [usize; N],
}

impl<const N: usize, T: Number> Factored<N, T> {
    /// Of I + F K*; `None` where that is singular.
    #[inline(always)]
    pub(super) fn of(dofs: usize, free: &Small<N, T>, stiffness: &Small<N, T>) -> Option<Self> {
        let mut rows = product(dofs, free, stiffness);
        for (i, row) in rows.iter_mut().enumerate() {
            row[i] += T::ONE;
        }
        let mut factored = Self {
            rows,
            reciprocals: [T::ONE; N],
            order: std::array::from_fn(|i| i),
        };
        if N <= 2 {
            factored.rows = inverse(dofs, factored.rows)?;
        } else {
            factored.eliminate(filled::<N>(dofs))?;
        }
        Some(factored)
    }

    fn eliminate(&mut self, dofs: usize) -> Option<()> {
        let rows = &mut self.rows;
        for k in 0..dofs {
            let mut pivot = k;
            for i in k + 1..dofs {
                if rows[i][k].outweighs(rows[pivot][k]) {
                    pivot = i;
                }
            }
            rows.swap(k, pivot);
            self.order.swap(k, pivot);
            let reciprocal = rows[k][k].reciprocal()?;
            self.reciprocals[k] = reciprocal;
            let row = rows[k];
            for below in &mut rows[k + 1..dofs] {
                let factor = below[k] * reciprocal;
                below[k] = factor;
                for j in k + 1..dofs {
                    below[j] -= factor * row[j];
                }
            }
        }
        Some(())
    }

    /// (I + F K*)⁻¹ times a column.
    #[inline(always)]
    pub(super) fn solve(&self, dofs: usize, column: &[T; N]) -> [T; N] {
        if N <= 2 {
            return times(dofs, &self.rows, column);
        }
        let dofs = filled::<N>(dofs);
        let mut solved = [T::ZERO; N];
        for i in 0..dofs {
            let mut value = column[self.order[i]];
            for j in 0..i {
                value -= self.rows[i][j] * solved[j];
            }
            solved[i] = value;
        }
        for i in (0..dofs).rev() {
            let mut value = solved[i];
            for j in i + 1..dofs {
                value -= self.rows[i][j] * solved[j];
            }
            solved[i] = value * self.reciprocals[i];
        }
        solved
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::DMatrix;
    use num_complex::Complex64;

    fn some(seed: usize) -> impl Fn(usize, usize) -> Complex64 {
        move |i, j| {
            let (i, j) = (i.min(j) + seed, i.max(j));
            let at = (7 * i + 3 * j + i * j) as f64;
            Complex64::new(at.sin(), (2.0 * at).cos())
        }
    }

    fn small<const N: usize>(dofs: usize, of: impl Fn(usize, usize) -> Complex64) -> Small<N> {
        super::super::kernel::matrix(dofs, of)
    }

    /// nalgebra's own LU factors solve the same.
    fn agrees<const N: usize>(dofs: usize) {
        let (free, stiffness) = (some(1), some(5));
        let matrix = DMatrix::from_fn(dofs, dofs, |i, j| {
            let sum: Complex64 = (0..dofs).map(|k| free(i, k) * stiffness(k, j)).sum();
            sum + if i == j { 1.0 } else { 0.0 }
        });
        let column: Vec<Complex64> = (0..dofs).map(|i| some(9)(i, 3)).collect();
        let expected = matrix
            .lu()
            .solve(&nalgebra::DVector::from(column.clone()))
            .unwrap();
        let small_column = super::super::kernel::vector(dofs, |i| column[i]);
        let factored = Factored::<N, _>::of(dofs, &small(dofs, free), &small(dofs, stiffness));
        let found = factored.unwrap().solve(dofs, &small_column);
        for i in 0..dofs {
            assert!(
                (found[i] - expected[i]).norm() < 1e-12 * expected.norm(),
                "{dofs}: {i}"
            );
        }
        assert!(found[dofs..].iter().all(|value| *value == Complex64::ZERO));
    }

    #[test]
    fn it_solves_what_other_factors_solve() {
        agrees::<1>(1);
        agrees::<2>(2);
        agrees::<4>(3);
        agrees::<8>(8);
        agrees::<16>(11);
    }

    #[test]
    fn what_is_singular_is_refused() {
        let free = small::<4>(3, |i, j| {
            if i == j {
                Complex64::ONE
            } else {
                Complex64::ZERO
            }
        });
        let stiffness = free.map(|row| row.map(|value| -value));
        assert!(Factored::of(3, &free, &stiffness).is_none());
    }

    #[test]
    fn relative_motions_beside_large_rigid_ones_keep_their_digits() {
        // two points of a rigid body that weighs little, with a compliance of 1e-9 of it between them
        let (rigid, elastic) = (1.0, 1e-9);
        let free = small::<4>(3, |i, j| {
            Complex64::from(rigid + if i == j { elastic } else { 0.0 })
        });
        let k = 1e5;
        let stiffness = small::<4>(3, |i, j| {
            if i == j {
                Complex64::from(k)
            } else {
                Complex64::ZERO
            }
        });
        let column = [rigid, rigid, rigid, 0.0].map(Complex64::from);
        let found = Factored::of(3, &free, &stiffness)
            .unwrap()
            .solve(3, &column);
        // all move alike: q = 1/(1 + k (3 + 1e-9))
        let expected = 1.0 / (1.0 + k * (3.0 * rigid + elastic));
        for value in &found[..3] {
            assert!(
                (value - expected).norm() < 1e-9 * expected,
                "{value} {expected}"
            );
        }
    }
}
