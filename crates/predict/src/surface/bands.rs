//! Means of a spectrum over smooth bands of equal ratio, and their covariance.

use std::f64::consts::PI;

use super::{Spectrum, Welch};

/// Smooth bands over ln f, cos² of a full width of twice the logarithm of their ratio, one such logarithm apart: together they
/// count every frequency alike.
///
/// Waves that are a constant ratio apart, as the Weierstrass–Mandelbrot function has them, weigh in each such band as much as
/// a continuous spectrum does, wherever they lie in it, if the ratio is γ or a power of it.
#[derive(Debug, Clone)]
pub(super) struct Bands {
    /// By band: line, and the integral of the band's weight over ln f from half a line below to half a line above.
    weights: Vec<Vec<(usize, f64)>>,
    /// Mean of ln f over each band.
    centre: Vec<f64>,
    /// Ends of the first and the last band, per metre.
    ends_per_m: [f64; 2],
}

impl Bands {
    /// As many bands of the ratio `ratio` as there are between the two frequencies, the last ending at the higher one.
    pub(super) fn new(spectrum: &Spectrum, [low, high]: [f64; 2], ratio: f64) -> Self {
        let spacing = ratio.ln();
        // Rounding must not cost a band that fits exactly.
        let count = ((high / low).ln() / spacing - 1.0 + 1e-9).floor().max(0.0);
        let mut bands = Self {
            weights: Vec::new(),
            centre: Vec::new(),
            ends_per_m: [high * ratio.powf(-count - 1.0), high],
        };
        let frequencies = &spectrum.frequency_per_m;
        let half = 0.5 * frequencies.get(1).copied().unwrap_or(0.0);
        let mut below = count;
        while below > 0.5 {
            let centre = high.ln() - spacing * below;
            let part = |frequency: f64| {
                // ∫ cos²(πu/2) du from −1, u = (ln f − centre)/spacing
                let u = ((frequency.ln() - centre) / spacing).clamp(-1.0, 1.0);
                0.5 * (u + 1.0) + (PI * u).sin() / (2.0 * PI)
            };
            let lines = frequencies.iter().enumerate().skip(1);
            let weights = lines.filter_map(|(line, frequency)| {
                let weight = part(frequency + half) - part(frequency - half);
                (weight > 0.0).then_some((line, weight))
            });
            bands.weights.push(weights.collect());
            bands.centre.push(centre);
            below -= 1.0;
        }
        bands
    }

    pub(super) fn count(&self) -> usize {
        self.centre.len()
    }

    /// Mean of ln f (f per metre) over each band.
    pub(super) fn centre(&self) -> &[f64] {
        &self.centre
    }

    /// Lowest and highest frequency of all bands.
    pub(super) fn ends_per_m(&self) -> [f64; 2] {
        self.ends_per_m
    }

    /// Means of `value(line)` over each band.
    pub(super) fn means(&self, value: impl Fn(usize) -> f64) -> Vec<f64> {
        let mean = |weights: &Vec<(usize, f64)>| {
            weights.iter().map(|&(line, part)| part * value(line)).sum()
        };
        self.weights.iter().map(mean).collect()
    }

    /// Covariance of the relative errors of the means, row by row.
    pub(super) fn covariance(&self, welch: &Welch, points: &[usize]) -> Vec<Vec<f64>> {
        // Lines further apart than this share nothing of either window's lobe.
        let lines = welch.covariance(points, 12.min(welch.segment / 2));
        let product = |a: &[(usize, f64)], b: &[(usize, f64)]| {
            let mut sum = 0.0;
            for &(line, part) in a {
                for &(other, share) in b {
                    if let Some(covariance) = lines.get(line.abs_diff(other)) {
                        sum += part * share * covariance;
                    }
                }
            }
            sum
        };
        self.weights
            .iter()
            .map(|a| self.weights.iter().map(|b| product(a, b)).collect())
            .collect()
    }
}
