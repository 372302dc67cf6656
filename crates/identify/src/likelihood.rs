//! Parts of the likelihood beside the sum that is minimised: the logarithms of all variances.

use std::slice;

use super::group::Group;
use super::objective::{Objective, State, Weights};

impl<const N: usize> Objective<'_, N> {
    /// Σ ln σ² over measurements beyond the first of each entry.
    pub(super) fn log_variances_of_scatter(&self, weights: &[Weights]) -> f64 {
        let of_group = |(group, weights): (&Group<N>, &Weights)| {
            let entries = group.blocks.iter().flat_map(|block| &block.entries);
            let counts: Vec<f64> = entries.map(|entry| f64::from(entry.count)).collect();
            let lines = weights.entries.chunks_exact(counts.len().max(1));
            let of_line = |variances: &[f64]| -> f64 {
                let pairs = counts.iter().zip(variances);
                let repeated = pairs.filter(|(count, _)| **count > 1.0);
                repeated
                    .map(|(n, of_mean)| (n - 1.0) * (n * of_mean).ln())
                    .sum()
            };
            lines.map(of_line).sum::<f64>()
        };
        self.groups.iter().zip(weights).map(of_group).sum()
    }

    /// Σ ln det Σ: the likelihood with the corrections integrated out, in which the level of the noise can be estimated.
    pub(super) fn log_determinant(&self, weights: &[Weights], state: &State) -> Option<f64> {
        let pairs = self.groups.iter().zip(weights);
        let independent = pairs.filter(|(group, _)| group.sources.is_empty());
        let mut sum: f64 = independent
            .map(|(_, weights)| log_variances(slice::from_ref(weights)))
            .sum();
        if !self.is_independent() {
            self.visit(Some(weights), state, &mut |group, line| {
                if !self.groups[group].sources.is_empty() {
                    sum += line.log_determinant();
                }
            })?;
        }
        Some(sum)
    }
}

/// Σ ln σ² of the means of everything measured: the likelihood with the corrections as unknowns.
pub(super) fn log_variances(weights: &[Weights]) -> f64 {
    let of = |weights: &Weights| -> f64 { log_sum(&weights.entries) + log_sum(&weights.sources) };
    weights.iter().map(of).sum()
}

/// Σ ln v over those above zero. The logarithm of a product takes the time of one.
fn log_sum(values: &[f64]) -> f64 {
    let each = |values: &[f64]| -> f64 {
        let positive = values.iter().filter(|value| **value > 0.0);
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
