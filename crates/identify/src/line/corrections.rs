//! How the corrections of one line's substructures follow the unknowns.

use nalgebra::DVector;
use num_complex::Complex64;

use super::{Line, backward, forward};

/// Gauss–Newton steps of one line's corrections for each step of the unknowns …
const CORRECTION_ROUNDS: usize = 40;
/// … as long as they promise to lower its cost by this fraction …
const CORRECTION_GAIN: f64 = 1e-3;
/// (by this one where the full step does not lower it) …
const CORRECTION_GAIN_OF_SHORT_STEPS: f64 = 1e-12;
/// … each shortened to a quarter at most so many times …
const CORRECTION_QUARTERINGS: usize = 8;
/// … until it lowers the cost by this part of what the linear model promises of it. At a sharp resonance a step can end beyond
/// the pole, where the receptance is next to nothing and from where no small step leads back.
const CORRECTION_KEPT_PROMISE: f64 = 0.1;

impl<const N: usize> Line<'_, N> {
    /// Lets the corrections follow the unknowns, and linearises the line there: δ first as the step's own linear model says,
    /// then by Gauss–Newton on this line alone, no step of which may raise its cost. Near a resonance the errors of the
    /// substructures act far from linearly.
    pub(in super::super) fn settle(
        &mut self,
        index: usize,
        variances: (&[f64], &[f64]),
        from: Option<&DVector<f64>>,
        to: &DVector<f64>,
        delta: &mut [Complex64],
    ) -> Option<()> {
        let mut trial = std::mem::take(&mut self.trial);
        let mut negligible = CORRECTION_GAIN;
        if let Some(from) = from {
            trial.clear();
            trial.extend_from_slice(delta);
            if self.linearise(index, from.as_slice(), &trial).is_some() {
                self.follow(variances, from, to, &mut trial)?;
            }
            let before = self.cost_at(index, variances, to, delta);
            let after = self.cost_at(index, variances, to, &trial);
            if after <= before {
                delta.copy_from_slice(&trial);
            } else {
                // Full steps overshoot here, and would for ever.
                negligible = CORRECTION_GAIN_OF_SHORT_STEPS;
            }
        }
        for _ in 0..CORRECTION_ROUNDS {
            self.linearise(index, to.as_slice(), delta)?;
            let before = self.whole_cost(variances, delta);
            trial.clear();
            trial.extend_from_slice(delta);
            self.follow(variances, to, to, &mut trial)?;
            let promised = before - self.residual_cost;
            if promised <= negligible * before {
                break;
            }
            let mut accepted = false;
            let mut share = 1.0;
            for _ in 0..CORRECTION_QUARTERINGS {
                let gained = before - self.cost_at(index, variances, to, &trial);
                // Along a step S falls by (2α − α²) of what the whole step promises.
                if gained >= CORRECTION_KEPT_PROMISE * share * (2.0 - share) * promised {
                    accepted = true;
                    break;
                }
                share *= 0.25;
                for (trial, delta) in trial.iter_mut().zip(delta.iter()) {
                    *trial = *delta + (*trial - *delta) * 0.25;
                }
            }
            if !accepted {
                break;
            }
            delta.copy_from_slice(&trial);
        }
        self.trial = trial;
        self.linearise(index, to.as_slice(), delta)
    }

    /// What this line adds to the cost with these corrections; infinite where it cannot be computed.
    fn cost_at(
        &mut self,
        index: usize,
        variances: (&[f64], &[f64]),
        unknowns: &DVector<f64>,
        delta: &[Complex64],
    ) -> f64 {
        if self
            .compute(index, unknowns.as_slice(), delta, false)
            .is_none()
        {
            return f64::INFINITY;
        }
        let cost = self.whole_cost(variances, delta);
        if cost.is_finite() {
            cost
        } else {
            f64::INFINITY
        }
    }

    /// δ ← Σ_H Jᴴ Σ⁻¹ (r̃ − ∂H^C/∂θ Δθ): the corrections that go with a step of the unknowns.
    fn follow(
        &mut self,
        (variances, of_sources): (&[f64], &[f64]),
        from: &DVector<f64>,
        to: &DVector<f64>,
        delta: &mut [Complex64],
    ) -> Option<()> {
        let size = self.residual.len();
        self.add_corrections(delta);
        let step = to - from;
        let count = self.joint_entries.len();
        for (slot, &joint) in self.joints.iter().enumerate() {
            let first = self.first_unknown(joint);
            for e in 0..size {
                for t in 0..count {
                    let (k, c) = (step[first + t], step[first + count + t]);
                    let change = Complex64::new(k, self.omega * c);
                    self.residual[e] -= self.by_joint[slot * size + e][t] * change;
                }
            }
        }
        self.factorise(variances, of_sources)?;
        forward(&self.factor, size, &mut self.residual);
        self.residual_cost = self.residual.iter().map(|r| r.norm_sqr()).sum();
        backward(&self.factor, size, &mut self.residual);
        for (s, delta) in delta.iter_mut().enumerate() {
            let column = &self.by_source[s * size..(s + 1) * size];
            let pairs = column.iter().zip(&self.residual);
            *delta = of_sources[s] * pairs.map(|(j, r)| j.conj() * r).sum::<Complex64>();
        }
        Some(())
    }
}
