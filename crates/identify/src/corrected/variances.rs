//! Variances of the assembly's entries at a few lines: those that are held, or those that follow from what is computed.

use super::super::lanes::Reals;
use super::super::weights::{held_power, of_one};
use super::lines::Corrected;

impl<const N: usize> Corrected<'_, N> {
    pub(super) fn take_variances(&mut self, entries: &[f64]) {
        let (size, first) = (self.variances.len(), self.index[0]);
        let line = self.index.map(|index| index - first);
        for (e, variance) in self.variances.iter_mut().enumerate() {
            *variance = Reals::of(|lane| entries[line[lane] * size + e]);
        }
    }

    /// The variances that the level gives at what is computed, which it also puts into `entries`.
    pub(super) fn renew_variances(&mut self, entries: &mut [f64]) -> Option<f64> {
        let size = self.variances.len();
        let (mut at, mut scatter) = (0, 0.0);
        for block in &self.piece.group.blocks {
            for (e, entry) in block.entries.iter().enumerate() {
                let (power, measured) =
                    (self.computed[at].norm_sqr(), self.measured[at].norm_sqr());
                let count = f64::from(entry.count);
                for (lane, &line) in self.index.iter().enumerate() {
                    let stored = line * block.entries.len() + e;
                    if !block.takes_part(line) {
                        self.variances[at].0[lane] = f64::INFINITY;
                        continue;
                    }
                    let known = block.known.get(stored).copied();
                    let power = held_power(power.0[lane], measured.0[lane]);
                    let variance = of_one(self.piece.levels.assembly, entry.floor, known, power);
                    if !(variance.is_finite() && variance > 0.0) {
                        return None;
                    }
                    self.variances[at].0[lane] = variance / count;
                    scatter += self.used.0[lane] * block.scatter[stored] / variance;
                }
                at += 1;
            }
        }
        for (lane, of_line) in entries.chunks_exact_mut(size).enumerate() {
            for (entry, variance) in of_line.iter_mut().zip(&self.variances) {
                *entry = variance.0[lane];
            }
        }
        Some(scatter)
    }
}
