//! What whitened lines with corrections add to the normal equations, lane by lane.

use super::super::lanes::{Complexes, Number, Reals};
use super::super::normal::Normal;
use super::Piece;

/// What a strip adds to the normal equations: each entry of all blocks divided by its error.
pub(super) struct Whitened<'s> {
    pub(super) omega: Reals,
    /// One in lanes that are in use, else zero.
    pub(super) used: Reals,
    pub(super) residual: &'s [Complexes],
    /// ∂H/∂K* of each unknown entry of each joint, one after the other.
    pub(super) by_joint: &'s [Complexes],
    pub(super) signal: Reals,
}

/// Sums over lines.
pub(super) struct Sums {
    /// Unknown entries of the K* of one joint.
    entries: usize,
    cost: Reals,
    signal: Reals,
    /// Of each two columns of ∂H/∂K*, j ≤ i: Σ Re conj(i) j, the same times ω², and ω Im.
    products: Vec<[Reals; 3]>,
    /// Of each column Σ Re conj(i) r and ω Im.
    right: Vec<[Reals; 2]>,
}

impl Sums {
    pub(super) fn new(piece: &Piece<'_>) -> Self {
        let columns = piece.unknowns.len() / 2;
        Self {
            entries: piece.entries.len(),
            cost: Reals::ZERO,
            signal: Reals::ZERO,
            products: vec![[Reals::ZERO; 3]; columns * (columns + 1) / 2],
            right: vec![[Reals::ZERO; 2]; columns],
        }
    }

    pub(super) fn add(&mut self, lines: Whitened<'_>) {
        let Whitened {
            omega,
            used,
            residual,
            by_joint,
            signal,
        } = lines;
        self.signal += used * signal;
        let cost = residual
            .iter()
            .fold(Reals::ZERO, |sum, r| sum + r.norm_sqr());
        self.cost += used * cost;
        let product = |one: &[Complexes], other: &[Complexes]| {
            let pairs = one.iter().zip(other);
            pairs
                .fold(Complexes::ZERO, |sum, (a, b)| sum + a.conj_times(*b))
                .scaled(used)
        };
        let columns = || by_joint.chunks_exact(residual.len());
        let mut sums = self.products.iter_mut();
        for (i, (column, right)) in columns().zip(&mut self.right).enumerate() {
            let sum = product(column, residual);
            right[0] += sum.re;
            right[1] += omega * sum.im;
            for (other, sums) in columns().take(i + 1).zip(&mut sums) {
                let sum = product(column, other);
                sums[0] += sum.re;
                sums[1] += omega * omega * sum.re;
                sums[2] += omega * sum.im;
            }
        }
    }

    /// Adds the sums to the lower triangle of the normal equations: ∂K*/∂k = E, ∂K*/∂c = jωE.
    pub(super) fn add_to(&self, normal: &mut Normal) {
        normal.cost += self.cost.sum();
        normal.signal += self.signal.sum();
        let stiffness = |i: usize| i / self.entries * 2 * self.entries + i % self.entries;
        let damping = |i: usize| stiffness(i) + self.entries;
        let mut products = self.products.iter().map(|sums| sums.map(Reals::sum));
        for (i, right) in self.right.iter().enumerate() {
            normal.gradient[stiffness(i)] += right[0].sum();
            normal.gradient[damping(i)] += right[1].sum();
            for (j, [real, squared, mixed]) in (0..=i).zip(&mut products) {
                let is_same_joint = i / self.entries == j / self.entries;
                normal.matrix[(stiffness(i), stiffness(j))] += real;
                normal.matrix[(damping(i), damping(j))] += squared;
                normal.matrix[(damping(i), stiffness(j))] += mixed;
                if i == j {
                    continue;
                }
                // The lower triangle has the dampings of one joint below its stiffnesses, and all of it below the joints before.
                if is_same_joint {
                    normal.matrix[(damping(j), stiffness(i))] -= mixed;
                } else {
                    normal.matrix[(stiffness(i), damping(j))] -= mixed;
                }
            }
        }
    }
}
