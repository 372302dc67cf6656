//! Parts of the likelihood beside the sum that is minimised: the logarithms of all variances.

use num_complex::Complex64;

use super::block::Block;
use super::group::Group;
use super::objective::{Objective, Weights};

impl Objective<'_> {
    /// Σ ln σ² over measurements beyond the first of each entry.
    pub(super) fn log_variances_of_scatter(&self, weights: &[Weights]) -> f64 {
        let of_group = |(group, weights): (&Group, &Weights)| {
            let entries = group.blocks.iter().flat_map(|block| &block.entries);
            let counts: Vec<f64> = entries.map(|entry| f64::from(entry.count)).collect();
            let lines = weights.entries.chunks_exact(counts.len().max(1));
            let of_line = |variances: &[f64]| -> f64 {
                let pairs = counts.iter().zip(variances);
                let repeated =
                    pairs.filter(|(count, variance)| **count > 1.0 && variance.is_finite());
                repeated
                    .map(|(n, of_mean)| (n - 1.0) * (n * of_mean).ln())
                    .sum()
            };
            lines.map(of_line).sum::<f64>()
        };
        self.groups.iter().zip(weights).map(of_group).sum()
    }

    /// Σ ln|y|² over the assemblies' measurements: variances count as fractions of it, so that likelihoods of different lines can be
    /// compared. Zero where every line is used anyway.
    pub(super) fn log_powers(&self) -> f64 {
        if self.is_independent() {
            return 0.0;
        }
        let of_block = |block: &Block| -> f64 {
            let lines = block.measured.chunks_exact(block.entries.len().max(1));
            let lines = lines.enumerate();
            let lines = lines.filter(|(line, _)| block.takes_part(*line));
            let of_line = |(_, values): (usize, &[Complex64])| -> f64 {
                let powers = values.iter().zip(&block.entries);
                let powers = powers.filter(|(value, _)| value.norm_sqr() > 0.0);
                powers
                    .map(|(value, entry)| f64::from(entry.count) * value.norm_sqr().ln())
                    .sum()
            };
            lines.map(of_line).sum()
        };
        let blocks = self.groups.iter().flat_map(|group| &group.blocks);
        blocks.map(of_block).sum()
    }
}

/// Σ ln σ² of the means of the assemblies' entries. The variances of the substructures follow from what was measured, so that no
/// joint changes them.
pub(super) fn log_variances(weights: &[Weights]) -> f64 {
    let of = |weights: &Weights| log_sum(&weights.entries);
    weights.iter().map(of).sum()
}

/// Σ ln v over those above zero that are finite. The logarithm of a product takes the time of one.
fn log_sum(values: &[f64]) -> f64 {
    let each = |values: &[f64]| -> f64 {
        let positive = values
            .iter()
            .filter(|value| **value > 0.0 && value.is_finite());
        positive.map(|value| value.ln()).sum()
    };
    let together = |values: &[f64]| {
        let product: f64 = values.iter().product();
        if product.is_normal() {
            product.ln()
        } else {
            each(values)
        }
    };
    values.chunks(8).map(together).sum()
}
