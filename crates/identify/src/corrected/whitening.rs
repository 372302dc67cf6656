//! Lines divided by their errors, Σ = Σ_C + J_ζ Σ_ζ J_ζᴴ = L Lᴴ, and the corrections that are best where they are linearised.

use super::super::lanes::{Complexes, Number, Reals};
use super::super::motions::place;
use super::lines::Corrected;
use super::sums::Whitened;

impl<const N: usize> Corrected<'_, N> {
    /// L⁻¹ r̃ with L Lᴴ = Σ.
    pub(super) fn whiten_residual(&mut self) -> Option<()> {
        let powers = self.computed.iter().zip(&self.variances);
        self.signal = powers.fold(Reals::ZERO, |sum, (h, variance)| {
            sum + h.norm_sqr() / *variance
        });
        self.take_motions_back();
        self.whiten_what_is_left()
    }

    /// r̃ = y − H^C + J_ζ ζ: what would be left if the substructures were as measured.
    pub(super) fn take_motions_back(&mut self) {
        self.whitened.copy_from_slice(&self.residual);
        let mut columns = self.by_motion.as_slice();
        for cluster in &self.piece.group.motions.clusters {
            for motion in cluster.first..cluster.first + cluster.motions.len() {
                let (own, others) = columns.split_at(cluster.rows.len());
                columns = others;
                let by = self.motions[motion];
                if let ([row], [j]) = (cluster.rows.as_slice(), own) {
                    self.whitened[*row] += *j * by;
                    continue;
                }
                for (&row, j) in cluster.rows.iter().zip(own) {
                    self.whitened[row] += *j * by;
                }
            }
        }
    }

    /// Whitens that.
    pub(super) fn whiten_what_is_left(&mut self) -> Option<()> {
        self.covariance_of_entries();
        self.factorise()?;
        forward(&self.factor, &self.reciprocals, &mut self.whitened);
        Some(())
    }

    /// Σ = Σ_C + J_ζ Σ_ζ J_ζᴴ
    pub(super) fn covariance_of_entries(&mut self) {
        self.factor.fill(Complexes::ZERO);
        for (e, variance) in self.variances.iter().enumerate() {
            self.factor[place(e, e)].re = *variance;
        }
        let (mut columns, mut covariance) = (self.by_motion.as_slice(), self.covariance.as_slice());
        for cluster in &self.piece.group.motions.clusters {
            let (rows, motions) = (cluster.rows.as_slice(), cluster.motions.len());
            let (own, others) = columns.split_at(motions * rows.len());
            columns = others;
            let (of_cluster, others) = covariance.split_at(place(motions, 0));
            covariance = others;
            if let ([row], [j], [variance]) = (rows, own, of_cluster) {
                self.factor[place(*row, *row)].re += j.norm_sqr() * *variance;
                continue;
            }
            let column = |i: usize| &own[i * rows.len()..][..rows.len()];
            for i in 0..motions {
                // column i of J_ζ Σ_ζ
                let weighted = &mut self.weighted[..rows.len()];
                let by = of_cluster[place(i, 0)];
                for (sum, value) in weighted.iter_mut().zip(column(0)) {
                    *sum = value.scaled(by);
                }
                for j in 1..motions {
                    let by = of_cluster[place(i, j)];
                    for (sum, value) in weighted.iter_mut().zip(column(j)) {
                        *sum += value.scaled(by);
                    }
                }
                for (a, (&row, left)) in rows.iter().zip(weighted.iter()).enumerate() {
                    let sums = &mut self.factor[place(row, 0)..][..=row];
                    let right = column(i).iter();
                    if cluster.is_dense {
                        for (sum, right) in sums.iter_mut().zip(right) {
                            *sum += right.conj_times(*left);
                        }
                    } else {
                        for (&other, right) in rows[..=a].iter().zip(right) {
                            sums[other] += right.conj_times(*left);
                        }
                    }
                }
            }
        }
    }

    fn factorise(&mut self) -> Option<()> {
        for row in 0..self.residual.len() {
            let (before, rest) = self.factor.split_at_mut(place(row, 0));
            let own = &mut rest[..=row];
            for column in 0..row {
                let other = &before[place(column, 0)..place(column, column)];
                let mut value = own[column];
                for (left, right) in own.iter().zip(other) {
                    value -= right.conj_times(*left);
                }
                own[column] = value.scaled(self.reciprocals[column]);
            }
            let mut pivot = own[row].re;
            for left in &own[..row] {
                pivot = pivot - left.norm_sqr();
            }
            // infinite where the entry is left out
            if pivot
                .lanes()
                .iter()
                .any(|pivot| pivot.is_nan() || *pivot <= 0.0)
            {
                return None;
            }
            self.reciprocals[row] = pivot.sqrt().reciprocal();
        }
        Some(())
    }

    /// λ = J_ζᴴ Σ⁻¹ r̃ and ζ = Σ_ζ λ
    pub(super) fn find_best(&mut self) {
        let solved = &mut self.weighted;
        solved.copy_from_slice(&self.whitened);
        backward(&self.factor, &self.reciprocals, solved);
        let (mut columns, mut covariance) = (self.by_motion.as_slice(), self.covariance.as_slice());
        let best = &mut self.best;
        (best.penalty, best.cross) = (Reals::ZERO, Reals::ZERO);
        for cluster in &self.piece.group.motions.clusters {
            let count = cluster.motions.len();
            let own = cluster.first..cluster.first + count;
            let pulls = &mut best.pulls[own.clone()];
            for pull in pulls.iter_mut() {
                let (column, others) = columns.split_at(cluster.rows.len());
                columns = others;
                let rows = cluster.rows.iter().zip(column);
                *pull = rows.fold(Complexes::ZERO, |sum, (&row, j)| {
                    sum + j.conj_times(solved[row])
                });
            }
            let (of_cluster, others) = covariance.split_at(place(count, 0));
            covariance = others;
            for (i, motion) in own.enumerate() {
                let mut sum = Complexes::ZERO;
                for (j, pull) in pulls.iter().enumerate() {
                    sum += pull.scaled(of_cluster[place(i, j)]);
                }
                best.motions[motion] = sum;
                best.penalty += pulls[i].conj_times(sum).re;
                best.cross += pulls[i].conj_times(self.motions[motion]).re;
            }
        }
    }

    /// L⁻¹ ∂H^C/∂K*
    pub(super) fn whiten_derivatives(&mut self) {
        self.derive_by_joint();
        for column in self.by_joint.chunks_exact_mut(self.residual.len()) {
            forward(&self.factor, &self.reciprocals, column);
        }
    }

    pub(super) fn whitened(&self) -> Whitened<'_> {
        Whitened {
            omega: self.omega,
            used: self.used,
            residual: &self.whitened,
            by_joint: &self.by_joint,
            signal: self.signal,
        }
    }
}

/// L⁻¹ v
#[inline(always)]
fn forward(factor: &[Complexes], reciprocals: &[Reals], v: &mut [Complexes]) {
    for row in 0..v.len() {
        let (before, rest) = v.split_at_mut(row);
        let mut value = rest[0];
        for (l, v) in factor[place(row, 0)..].iter().zip(before.iter()) {
            value -= *l * *v;
        }
        rest[0] = value.scaled(reciprocals[row]);
    }
}

/// L⁻ᴴ v
#[inline(always)]
fn backward(factor: &[Complexes], reciprocals: &[Reals], v: &mut [Complexes]) {
    for row in (0..v.len()).rev() {
        let (before, rest) = v.split_at_mut(row);
        let value = rest[0].scaled(reciprocals[row]);
        rest[0] = value;
        for (l, v) in factor[place(row, 0)..].iter().zip(before.iter_mut()) {
            *v -= l.conj_times(value);
        }
    }
}
