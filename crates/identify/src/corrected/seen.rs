//! Lines as an estimate leaves them, one by one: for the judgement of the residual, levels of noise, scores and draws.

use num_complex::Complex64;

use super::super::lanes::{Complexes, Number, Reals};
use super::super::line::Line;
use super::lines::Corrected;

impl<const N: usize> Corrected<'_, N> {
    /// Σ|r̃|²/|H^C|² of each line.
    pub(super) fn relative_power(&self) -> Reals {
        let pairs = self.whitened.iter().zip(&self.computed);
        pairs.fold(Reals::ZERO, |sum, (r, h)| sum + r.norm_sqr() / h.norm_sqr())
    }

    /// Lets `line` be the one in this lane.
    pub(super) fn show(&self, lane: usize, relative_power: Reals, line: &mut Line<'_>) {
        line.index = self.index[lane];
        line.relative_power = relative_power.lane(lane);
        let of = |own: &mut [Complex64], all: &[Complexes]| {
            for (own, all) in own.iter_mut().zip(all) {
                *own = all.lane(lane);
            }
        };
        of(&mut line.computed, &self.computed);
        of(&mut line.residual, &self.whitened);
    }

    /// J of each source, from J_ζ of the motions that it makes.
    pub(super) fn show_sources(&self, lane: usize, line: &mut Line<'_>) {
        let (size, group) = (self.residual.len(), self.piece.group);
        line.by_source.clear();
        line.by_source
            .resize(size * group.sources.len(), Complex64::ZERO);
        let mut columns = self.by_motion.as_slice();
        for cluster in &group.motions.clusters {
            for motion in cluster.first..cluster.first + cluster.motions.len() {
                let (column, others) = columns.split_at(cluster.rows.len());
                columns = others;
                for &(source, share) in &group.motions.shares[motion] {
                    for (&row, j) in cluster.rows.iter().zip(column) {
                        line.by_source[source * size + row] += j.lane(lane) * share;
                    }
                }
            }
        }
    }

    /// Jᵀr of the whitened line by the unknowns: ∂K*/∂k = E, ∂K*/∂c = jωE.
    pub(super) fn show_score(&self, lane: usize, line: &mut Line<'_>) {
        let (size, count) = (self.residual.len(), self.piece.entries.len());
        line.score.clear();
        let omega = self.omega.lane(lane);
        for of_joint in self.by_joint.chunks_exact(size * count) {
            let products = of_joint.chunks_exact(size).map(|column| {
                let pairs = column.iter().zip(&self.whitened);
                let product = pairs.fold(Complexes::ZERO, |sum, (j, r)| sum + j.conj_times(*r));
                product.lane(lane)
            });
            let products: Vec<Complex64> = products.collect();
            line.score.extend(products.iter().map(|product| product.re));
            line.score
                .extend(products.iter().map(|product| omega * product.im));
        }
    }
}
