//! How the corrections of one line's substructures follow the unknowns.

use nalgebra::DVector;
use num_complex::Complex64;

use super::{Line, Variances, backward};

/// Gauss–Newton steps of one line's corrections for each step of the unknowns …
const ROUNDS: usize = 20;
/// … as long as they promise to lower its cost by more than this part of it …
const SMALL_GAIN: f64 = 1e-3;
/// … each shortened to a quarter so many times at most, until it does lower the cost: near a resonance a whole step can end beyond
/// the pole.
const QUARTERINGS: usize = 8;

impl Line<'_> {
    /// Lets the corrections follow the unknowns by Gauss–Newton steps, most often one, and linearises and whitens the line there:
    /// repeated with each step of the unknowns that leads both to the minimum.
    pub(in super::super) fn settle(
        &mut self,
        index: usize,
        variances: Variances<'_>,
        unknowns: &DVector<f64>,
        delta: &mut [Complex64],
    ) -> Option<()> {
        self.linearise(index, unknowns.as_slice(), delta)?;
        self.settle_linearised(variances, unknowns, delta)
    }

    /// The same of a line that is linearised already.
    pub(in super::super) fn settle_linearised(
        &mut self,
        variances: Variances<'_>,
        unknowns: &DVector<f64>,
        delta: &mut [Complex64],
    ) -> Option<()> {
        let mut trial = std::mem::take(&mut self.trial);
        let mut rounds = 0..ROUNDS;
        loop {
            let before = self.whole_cost(variances, delta);
            self.whiten_residual(variances, delta)?;
            let gain = before - self.residual_cost();
            self.best_corrections(variances, &mut trial);
            if gain <= SMALL_GAIN * before {
                delta.copy_from_slice(&trial);
                break;
            }
            if rounds.next().is_none() {
                break;
            }
            let lowers = (0..QUARTERINGS).any(|_| {
                let lowers = self.cost_at(variances, unknowns, &trial) < before;
                if !lowers {
                    for (trial, delta) in trial.iter_mut().zip(delta.iter()) {
                        *trial = delta + (*trial - delta) * 0.25;
                    }
                }
                lowers
            });
            if lowers {
                delta.copy_from_slice(&trial);
            } else {
                // Nothing lowers it: this is the last time.
                rounds = 0..0;
            }
            self.linearise(self.index, unknowns.as_slice(), delta)?;
        }
        self.trial = trial;
        self.whiten_derivatives();
        Some(())
    }

    /// What this line adds to the cost with these corrections; infinite where it cannot be computed.
    fn cost_at(
        &mut self,
        variances: Variances<'_>,
        unknowns: &DVector<f64>,
        delta: &[Complex64],
    ) -> f64 {
        let computed = self.compute(self.index, unknowns.as_slice(), delta, false);
        let cost = computed.map(|()| self.whole_cost(variances, delta));
        cost.filter(|cost| cost.is_finite())
            .unwrap_or(f64::INFINITY)
    }

    /// Σ|y − H^C|²/σ_C² + Σ|δ|²/σ_H²
    fn whole_cost(&self, variances: Variances<'_>, delta: &[Complex64]) -> f64 {
        let residuals = self.residual.iter().zip(variances.entries);
        let mut cost: f64 = residuals.map(|(r, variance)| r.norm_sqr() / variance).sum();
        for (delta, variance) in delta.iter().zip(variances.sources) {
            if *variance > 0.0 {
                cost += delta.norm_sqr() / variance;
            }
        }
        cost
    }

    /// δ = Σ_H Jᴴ Σ⁻¹ r̃
    fn best_corrections(&self, variances: Variances<'_>, delta: &mut Vec<Complex64>) {
        let size = self.residual.len();
        let mut weighted = self.residual.clone();
        backward(&self.factor, size, &mut weighted);
        delta.clear();
        for (column, variance) in self.by_source.chunks_exact(size).zip(variances.sources) {
            let pairs = column.iter().zip(&weighted);
            delta.push(*variance * pairs.map(|(j, r)| j.conj() * r).sum::<Complex64>());
        }
    }
}
