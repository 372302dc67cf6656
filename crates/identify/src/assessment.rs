//! Whether what a fit leaves is noise: the gate that tells the joint from a local minimum or a model that is too simple.

use std::sync::Arc;

use nalgebra::{DMatrix, DVector};
use num_complex::Complex64;

use super::estimator::Estimate;
use super::group::{Side, Source};
use super::line::Line;
use super::noise::{Noise, StatedLevel};
use super::objective::{Objective, Weights};

/// Standard deviations beyond which a statistic is not chance.
pub(super) const SIGNIFICANT: f64 = 5.0;

/// Squared residuals of this part of the squared signal are rounding.
const ROUNDING_POWER: f64 = 1e-20;

/// Lines below which no test has power.
const FEWEST_LINES: usize = 30;

/// What the residuals of a fit say.
#[derive(Clone, Debug, PartialEq)]
pub struct Assessment {
    /// χ² over degrees of freedom; `None` without degrees of freedom.
    pub reduced_chi_squared: Option<f64>,
    /// Whether the noise was stated, so that χ² is a test.
    pub noise_is_stated: bool,
    /// Whether coherence tells the variance of all of the assembly, and of the substructures where it is not stated. It is an estimate itself, so that
    /// χ² does not reject: with n averages its mean is n/(n − 2).
    pub noise_is_known: bool,
    /// χ² too high, in its standard deviations.
    pub chi_squared_excess: f64,
    /// Correlation of the residuals of neighbouring lines: 0 for noise.
    pub line_correlation: f64,
    /// The same in its standard deviations.
    pub line_correlation_excess: f64,
    /// Whether there were lines enough for a test.
    pub has_power: bool,
    /// Whether the residual is rounding.
    pub is_exact: bool,
}

impl Assessment {
    /// Whether χ², where the noise is stated, and the order of the residuals are those of noise.
    #[must_use]
    pub fn fits(&self) -> bool {
        self.is_exact
            || !(self.noise_is_stated && self.chi_squared_excess > SIGNIFICANT)
                && self.line_correlation_excess <= SIGNIFICANT
    }

    /// Whether the fit is good beyond doubt: no other minimum can be better.
    pub(super) fn is_certain(&self) -> bool {
        self.is_exact || self.has_power && self.fits()
    }

    /// What is wrong, in words.
    #[must_use]
    pub fn complaint(&self) -> Option<String> {
        if self.fits() {
            return None;
        }
        let mut findings = Vec::new();
        if let (true, Some(chi)) = (self.noise_is_stated, self.reduced_chi_squared)
            && self.chi_squared_excess > SIGNIFICANT
        {
            findings.push(format!("χ² per degree of freedom is {chi:.3}"));
        }
        if self.line_correlation_excess > SIGNIFICANT {
            findings.push(format!(
                "the residuals of neighbouring lines are correlated ({:.2})",
                self.line_correlation
            ));
        }
        Some(findings.join(" and "))
    }
}

/// Judges the residuals of `estimate`.
pub(super) fn assess<const N: usize>(
    objective: &Objective<'_, N>,
    estimate: &Estimate,
    noise: &Noise,
) -> Option<Assessment> {
    let corrections = Some(Arc::clone(&estimate.corrections));
    let state = objective.unweighted(estimate.unknowns.clone(), corrections);
    let groups = objective.gather_whitened(estimate.levels, &state, Residuals::add)?;
    let groups = groups.into_iter().map(|pieces| {
        let joined = pieces.into_iter().reduce(Residuals::followed_by);
        joined.unwrap_or_default()
    });
    let Residuals {
        relative_power,
        power,
        count,
        product,
        pairs,
        ..
    } = groups.fold(Residuals::default(), |all, group| all.beside(&group));
    let line_correlation = if power > 0.0 { product / power } else { 0.0 };
    // The real part of a product of two complex circular residuals has half the variance.
    let deviation = (2.0 * pairs.max(1) as f64).sqrt().recip();
    let reduced = estimate.reduced_chi_squared();
    let freedom = estimate.degrees_of_freedom as f64;
    let lines: usize = objective.groups.iter().map(|group| group.lines()).sum();
    let noise_is_known = is_known(objective, noise);
    Some(Assessment {
        reduced_chi_squared: reduced,
        noise_is_stated: noise.is_stated() && !noise_is_known,
        noise_is_known,
        chi_squared_excess: reduced.map_or(0.0, |chi| (chi - 1.0) / (2.0 / freedom).sqrt()),
        line_correlation,
        line_correlation_excess: line_correlation / deviation,
        has_power: lines >= FEWEST_LINES,
        is_exact: relative_power / (count.max(1) as f64) < ROUNDING_POWER,
    })
}

/// Sums over the whitened residuals of consecutive lines.
#[derive(Default)]
struct Residuals {
    /// Σ|r|²/|H|² of the residuals as they were before.
    relative_power: f64,
    /// Σ|r|²
    power: f64,
    count: usize,
    /// Σ Re r̄ r' over neighbouring lines.
    product: f64,
    pairs: usize,
    /// Those of the first line and of the last.
    ends: Option<[Vec<Complex64>; 2]>,
}

impl Residuals {
    fn add<const N: usize>(&mut self, line: &Line<'_, N>) {
        self.relative_power += line.relative_power;
        self.count += line.residual.len();
        self.power += line.residual.iter().map(|z| z.norm_sqr()).sum::<f64>();
        let Some([_, last]) = &mut self.ends else {
            self.ends = Some([line.residual.clone(), line.residual.clone()]);
            return;
        };
        self.product += product(last, &line.residual);
        self.pairs += line.residual.len();
        last.copy_from_slice(&line.residual);
    }

    /// The sums over both, `next` being those of the lines that follow.
    fn followed_by(self, next: Self) -> Self {
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
    fn beside(&self, other: &Self) -> Self {
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

/// Whether no variance depends on a level that is estimated.
fn is_known<const N: usize>(objective: &Objective<'_, N>, noise: &Noise) -> bool {
    let is_stated = |level: StatedLevel| level.relative.is_some() && level.floor.is_some();
    let of_source = |source: &Source<N>| {
        !source.known.is_empty()
            || is_stated(match source.side {
                Side::A => noise.a,
                Side::B => noise.b,
            })
    };
    objective.groups.iter().all(|group| {
        let mut blocks = group.blocks.iter();
        blocks.all(|block| !block.known.is_empty()) && group.sources.iter().all(of_source)
    })
}

/// By how much the standard deviation of each unknown has to grow because the residuals of neighbouring lines are
/// correlated: √ of the variance of the scores beside the one that the information promises (a sandwich with Bartlett's
/// weights; Newey and West), at least one. `unit` times `scale` is the covariance that it promises.
pub(super) fn inflation<const N: usize>(
    objective: &Objective<'_, N>,
    estimate: &Estimate,
    unit: &DMatrix<f64>,
    scale: f64,
) -> Option<DVector<f64>> {
    let (weights, state) = objective.reached(estimate)?;
    let mut scores: Vec<Vec<(usize, DVector<f64>)>> = Vec::new();
    objective.visit_scores(&weights, &state, |group, line| {
        if scores.len() <= group {
            scores.resize_with(group + 1, Vec::new);
        }
        scores[group].push((line.index, DVector::from_vec(line.score())));
    })?;
    let size = estimate.unknowns.len();
    let mut variance = DMatrix::zeros(size, size);
    for scores in &scores {
        let lags = (scores.len() as f64).cbrt().ceil() as usize;
        for lag in 0..=lags {
            let weight = 1.0 - lag as f64 / (lags as f64 + 1.0);
            for (early, late) in scores.iter().zip(&scores[lag.min(scores.len())..]) {
                let product = &early.1 * late.1.transpose() * weight;
                if lag == 0 {
                    variance += product;
                } else {
                    variance += product.transpose();
                    variance += product;
                }
            }
        }
    }
    // cov = A⁻¹ B A⁻¹ with A⁻¹ = 2 cov₀ for cov₀ = ½ A⁻¹, which `unit` is
    let sandwich = 4.0 * unit * variance * unit;
    Some(DVector::from_fn(size, |i, _| {
        (sandwich[(i, i)] / (scale * unit[(i, i)])).max(1.0).sqrt()
    }))
}

impl<const N: usize> Objective<'_, N> {
    /// The point at which an estimate came to rest, with its weights.
    pub(super) fn reached(
        &self,
        estimate: &Estimate,
    ) -> Option<(Vec<Weights>, super::objective::State)> {
        let state = self.unweighted(
            estimate.unknowns.clone(),
            Some(Arc::clone(&estimate.corrections)),
        );
        Some((self.weights(estimate.levels, &state)?, state))
    }
}
