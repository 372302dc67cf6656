//! By which minima are ranked that rest on lines of their own: what all lines say of each.
//!
//! The sum that is minimised does not rank them. Corrections of the substructures can explain anything where a joint lets them act
//! strongly enough, and such a joint leaves out the lines at which they act too strongly. Here every line counts: what the errors of
//! the substructures do to a value is part of its variance, and a joint that lets them do much pays for it with Σ ln σ².

use nalgebra::DVector;
use num_complex::Complex64;

use super::estimator::Estimate;
use super::noise::{Levels, Noise, Size};
use super::objective::Objective;

/// Times that a level of noise that is not stated is renewed, at most …
const ROUNDS: usize = 4;
/// … and the change of its square that is none.
const SETTLED: f64 = 0.1;

/// What is left of all values beside what is expected.
struct Left {
    /// Mean of |r|²/σ².
    mean_square: f64,
    /// Σ ln σ².
    log_variances: f64,
}

impl Objective<'_> {
    /// −2 log-likelihood of an estimate on all lines, up to a constant; noise is as stated or more. Infinite where a line cannot be
    /// computed.
    pub(super) fn standing(&self, estimate: &Estimate, noise: &Noise) -> f64 {
        let stands = || {
            let residuals = self.residuals_as_measured(&estimate.unknowns)?;
            let mut levels = estimate.levels;
            let mut left = self.left(&residuals, levels, &estimate.unknowns)?;
            for _ in 0..ROUNDS {
                if noise.is_stated() || (left.mean_square - 1.0).abs() < SETTLED {
                    break;
                }
                let by = left.mean_square.sqrt();
                let Size { relative, floor } = levels.assembly;
                levels = noise.levels(Size {
                    relative: by * relative,
                    floor: by * floor,
                });
                left = self.left(&residuals, levels, &estimate.unknowns)?;
            }
            let of_each = match left.mean_square {
                ..=1.0 => left.mean_square,
                more => 1.0 + more.ln(),
            };
            let count = self.measurements() as f64;
            Some(2.0 * (count * of_each + left.log_variances))
        };
        stands().unwrap_or(f64::INFINITY)
    }

    /// y − H^C with the substructures as measured, line by line of each block.
    fn residuals_as_measured(&self, unknowns: &DVector<f64>) -> Option<Vec<Vec<Complex64>>> {
        let mut blocks: Vec<Vec<Vec<Complex64>>> = self
            .groups
            .iter()
            .map(|group| vec![Vec::new(); group.blocks.len()])
            .collect();
        let state = self.unweighted(unknowns.clone(), None);
        self.visit(&state, &mut |number, line| {
            let mut residual = line.residual.as_slice();
            let of_group = self.groups[number].blocks.iter();
            for (block, values) in of_group.zip(&mut blocks[number]) {
                let (own, others) = residual.split_at(block.entries.len());
                values.extend_from_slice(own);
                residual = others;
            }
        })?;
        Some(blocks.concat())
    }

    fn left(
        &self,
        residuals: &[Vec<Complex64>],
        levels: Levels,
        unknowns: &DVector<f64>,
    ) -> Option<Left> {
        let weights = self.marginal_weights(levels, unknowns)?;
        let moved = self.moved(levels, unknowns).concat();
        let (mut cost, mut log_variances) = (0.0, 0.0);
        for ((residuals, weights), moved) in residuals.iter().zip(&weights).zip(moved) {
            let entries = residuals.len() / moved.len().max(1);
            for (line, moved) in moved.iter().enumerate() {
                // An error of the substructures acts as A/(1 + A), of which A is the linear part: however large it is, it moves
                // a value by no more than about the value that it acts on.
                let saturation = 1.0 + moved * moved;
                let of_line = line * entries..(line + 1) * entries;
                let pairs = residuals[of_line.clone()]
                    .iter()
                    .zip(&weights.entries[of_line]);
                for (residual, variance) in pairs.filter(|(_, variance)| variance.is_finite()) {
                    let variance = variance / saturation;
                    cost += residual.norm_sqr() / variance;
                    log_variances += variance.ln();
                }
            }
        }
        let mean_square = cost / self.measurements() as f64;
        (mean_square.is_finite() && log_variances.is_finite()).then_some(Left {
            mean_square,
            log_variances,
        })
    }
}
