//! I + F K* of a line, or of several side by side, factored to be solved for many columns.
//!
//! Below the first elastic mode F is nearly singular beside its rigid motions, and H_sk K* Q multiplies what is left of
//! (I + F K*) Q = H_ks by large numbers. Factors leave rounding of that equation, an explicit inverse as much more as it is badly
//! conditioned.

use super::kernel::{Small, closed_loop, filled, inverse, times};
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
        let mut factored = Self {
            rows: closed_loop(dofs, free, stiffness),
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

    /// One rigid motion a that weighs little beside elastic compliances: of h = R a, hᵀ K (I + F K)⁻¹ h is R s/(1 + s) with
    /// s = R aᵀ K (I + E K)⁻¹ a (Sherman and Morrison). All numbers of F are exact.
    #[test]
    fn what_a_joint_transmits_beside_large_rigid_motions_keeps_its_digits() {
        let (rigid, a) = (128.0, [1.0, 0.5, -0.25]);
        let elastic = [1.0, 3.0, 2.0].map(|part| part / f64::from(1 << 20));
        let k = [1e5, 3e5, 2e5];
        let of_diagonal = |i, j, values: [f64; 3]| if i == j { values[i] } else { 0.0 };
        let free = small::<4>(3, |i, j| {
            Complex64::from(rigid * a[i] * a[j] + of_diagonal(i, j, elastic))
        });
        let stiffness = small::<4>(3, |i, j| Complex64::from(of_diagonal(i, j, k)));
        let column = [0, 1, 2, 3].map(|i| Complex64::from(a.get(i).map_or(0.0, |a| rigid * a)));
        let transmitted = |q: [Complex64; 4]| {
            let parts = (0..3).map(|i| column[i] * k[i] * q[i]);
            parts.sum::<Complex64>()
        };
        let shares = (0..3).map(|i| a[i] * a[i] * k[i] / (1.0 + elastic[i] * k[i]));
        let s = rigid * shares.sum::<f64>();
        let expected = rigid * s / (1.0 + s);
        let off = |q: [Complex64; 4]| (transmitted(q) / expected - 1.0).norm();
        let factored = Factored::of(3, &free, &stiffness).unwrap();
        assert!(off(factored.solve(3, &column)) < 1e-14);
        // what it is for: an inverse has lost a third of the digits
        let inverse = inverse(3, closed_loop(3, &free, &stiffness)).unwrap();
        assert!(off(times(3, &inverse, &column)) > 1e-11);
    }
}
