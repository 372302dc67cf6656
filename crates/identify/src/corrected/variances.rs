//! Variances of the assembly's entries at a few lines: those that are held, or those that follow from what is computed.

use super::super::lanes::Reals;
use super::super::weights::{held_powers, of_lanes};
use super::lines::Corrected;

impl<const N: usize> Corrected<'_, N> {
    pub(super) fn take_variances(&mut self, entries: &[f64]) {
        let (size, first) = (self.variances.len(), self.index[0]);
        let line = self.index.map(|index| index - first);
        for (e, variance) in self.variances.iter_mut().enumerate() {
            *variance = Reals::of(|lane| entries[line[lane] * size + e]);
        }
    }

    /// The variances that the level gives at what is computed, which it also puts into `entries`. Returns Σ|y − mean|²/σ² over
    /// repeated measurements; `None` where a variance is not a number above zero.
    pub(super) fn renew_variances(&mut self, entries: &mut [f64]) -> Option<f64> {
        let size = self.variances.len();
        let level = self.piece.levels.assembly;
        let (mut at, mut scatter) = (0, Reals::ZERO);
        for block in &self.piece.group.blocks {
            let takes_part = Reals::of(|lane| match block.takes_part(self.index[lane]) {
                true => 1.0,
                false => 0.0,
            });
            let count = block.entries.len();
            for (e, entry) in block.entries.iter().enumerate() {
                let of_entry =
                    |values: &[f64]| Reals::of(|lane| values[self.index[lane] * count + e]);
                let power = held_powers(self.computed[at], self.measured[at]);
                let known = match block.known.is_empty() {
                    true => None,
                    false => Some(of_entry(&block.known)),
                };
                let variance = of_lanes(level, entry.floor, known, power);
                let seen = takes_part.where_positive(variance, Reals::all(1.0));
                let is_usable = |variance: &f64| variance.is_finite() && *variance > 0.0;
                if !seen.lanes().iter().all(is_usable) {
                    return None;
                }
                let of_mean = variance / Reals::all(f64::from(entry.count));
                self.variances[at] = takes_part.where_positive(of_mean, Reals::all(f64::INFINITY));
                if entry.count > 1 {
                    scatter += self.used * takes_part * of_entry(&block.scatter) / seen;
                }
                at += 1;
            }
        }
        for (lane, of_line) in entries.chunks_exact_mut(size).enumerate() {
            for (entry, variance) in of_line.iter_mut().zip(&self.variances) {
                *entry = variance.lane(lane);
            }
        }
        Some(scatter.sum())
    }
}
