//! What a fit leaves of the lines, summed up for the judgement whether it is noise.

use nalgebra::DVector;
use num_complex::Complex64;

use super::group::{Side, Source};
use super::line::Line;
use super::noise::Noise;
use super::objective::{Objective, State, Weights};

/// Sums over the whitened residuals of consecutive lines.
#[derive(Default)]
pub(super) struct Residuals {
    /// Σ|r|²/|H|² of the residuals as they were before.
    pub(super) relative_power: f64,
    /// Σ|r|²
    pub(super) power: f64,
    pub(super) count: usize,
    /// Σ Re r̄ r' over neighbouring lines.
    pub(super) product: f64,
    pub(super) pairs: usize,
    /// Those of the first line and of the last.
    ends: Option<[Vec<Complex64>; 2]>,
}

impl Residuals {
    pub(super) fn add(&mut self, line: &Line<'_>) {
        self.relative_power += line.relative_power;
        self.count += line.measurements();
        self.power += line.residual.iter().map(|z| z.norm_sqr()).sum::<f64>();
        let Some([_, last]) = &mut self.ends else {
            self.ends = Some([line.residual.clone(), line.residual.clone()]);
            return;
        };
        self.product += product(last, &line.residual);
        self.pairs += line.measurements();
        last.copy_from_slice(&line.residual);
    }

    /// The sums over both, `next` being those of the lines that follow.
    pub(super) fn followed_by(self, next: Self) -> Self {
        let both = self.beside(&next);
        let (Some([first, last]), Some([next_first, next_last])) = (self.ends, next.ends) else {
            return both;
        };
        Self {
            product: both.product + product(&last, &next_first),
            pairs: both.pairs + last.len(),
            ends: Some([first, next_last]),
            ..both
        }
    }

    /// The sums over both, which have no neighbours among each other.
    pub(super) fn beside(&self, other: &Self) -> Self {
        Self {
            relative_power: self.relative_power + other.relative_power,
            power: self.power + other.power,
            count: self.count + other.count,
            product: self.product + other.product,
            pairs: self.pairs + other.pairs,
            ends: None,
        }
    }
}

/// Σ Re r̄ r'
fn product(one: &[Complex64], other: &[Complex64]) -> f64 {
    let both = one.iter().zip(other);
    both.map(|(a, b)| (a.conj() * b).re).sum()
}

impl Objective<'_> {
    /// For each group, the derivative of the sum by the unknowns, line by line.
    pub(super) fn scores(
        &self,
        weights: &[Weights],
        state: &State,
    ) -> Option<Vec<Vec<DVector<f64>>>> {
        let mut scores: Vec<Vec<DVector<f64>>> = vec![Vec::new(); weights.len()];
        self.visit_scores(weights, state, &mut |group, line| {
            scores[group].push(DVector::from_column_slice(&line.score));
        })?;
        Some(scores)
    }

    /// Whether no variance depends on a level that is estimated.
    pub(super) fn is_known(&self, noise: &Noise) -> bool {
        let of_source = |source: &Source| {
            !source.known.is_empty()
                || match source.side {
                    Side::A => noise.a.is_stated(),
                    Side::B => noise.b.is_stated(),
                }
        };
        self.groups.iter().all(|group| {
            let mut blocks = group.blocks.iter();
            blocks.all(|block| !block.known.is_empty()) && group.sources.iter().all(of_source)
        })
    }
}
