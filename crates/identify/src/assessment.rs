//! Whether what a fit leaves is noise: the gate that tells the joint from a local minimum or a model that is too simple.

use std::sync::Arc;

use nalgebra::{DMatrix, DVector};

use super::estimator::Estimate;
use super::noise::Noise;
use super::objective::{Objective, State, Weights};
use super::residuals::Residuals;

/// Standard deviations beyond which a statistic is not chance.
pub(super) const SIGNIFICANT: f64 = 5.0;

/// Squared residuals of this part of the squared signal are rounding: no measurement is as exact. Stiff joints and sharp resonances
/// make more of it than the last digit.
const ROUNDING_POWER: f64 = 1e-16;

/// Lines below which no test has power.
const FEWEST_LINES: usize = 30;

/// What the residuals of a fit say.
#[derive(Clone, Debug, PartialEq)]
pub struct Assessment {
    /// χ² over degrees of freedom; `None` without degrees of freedom.
    pub reduced_chi_squared: Option<f64>,
    /// Whether the noise was stated, so that χ² is a test.
    pub noise_is_stated: bool,
    /// Whether coherence tells the variance of all of the assembly, and of the substructures where it is not stated. It is an
    /// estimate itself, of neighbouring lines together, so that χ² does not reject: noise may change from line to line.
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
pub(super) fn assess(
    objective: &Objective<'_>,
    estimate: &Estimate,
    noise: &Noise,
) -> Option<Assessment> {
    let corrections = Some(Arc::clone(&estimate.corrections));
    let state = objective.unweighted(estimate.unknowns.clone(), corrections);
    let groups = objective.residuals(estimate.levels, &state)?;
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
    let noise_is_known = objective.is_known(noise);
    Some(Assessment {
        reduced_chi_squared: reduced,
        noise_is_stated: noise.is_stated() && !noise_is_known,
        noise_is_known,
        chi_squared_excess: reduced.map_or(0.0, |chi| (chi - 1.0) / (2.0 / freedom).sqrt()),
        line_correlation,
        line_correlation_excess: line_correlation / deviation,
        has_power: objective.lines() >= FEWEST_LINES,
        is_exact: relative_power / (count.max(1) as f64) < ROUNDING_POWER,
    })
}

/// By how much the standard deviation of each unknown has to grow because the residuals of neighbouring lines are
/// correlated: √ of the variance of the scores beside the one that the information promises (a sandwich with Bartlett's
/// weights; Newey and West), at least one. `unit` times `scale` is the covariance that it promises.
pub(super) fn inflation(
    objective: &Objective<'_>,
    estimate: &Estimate,
    unit: &DMatrix<f64>,
    scale: f64,
) -> Option<DVector<f64>> {
    let (weights, state) = reached(objective, estimate)?;
    let scores = objective.scores(&weights, &state)?;
    let size = estimate.unknowns.len();
    let mut variance = DMatrix::zeros(size, size);
    for scores in &scores {
        let lags = (scores.len() as f64).cbrt().ceil() as usize;
        for lag in 0..=lags {
            let weight = 1.0 - lag as f64 / (lags as f64 + 1.0);
            for (early, late) in scores.iter().zip(&scores[lag.min(scores.len())..]) {
                let product = early * late.transpose() * weight;
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

/// The point at which an estimate came to rest, with its weights.
pub(super) fn reached(
    objective: &Objective<'_>,
    estimate: &Estimate,
) -> Option<(Vec<Weights>, State)> {
    let corrections = Some(Arc::clone(&estimate.corrections));
    let state = objective.unweighted(estimate.unknowns.clone(), corrections);
    Some((objective.weights(estimate.levels, &state)?, state))
}
