//! Means of a spectrum over bands of equal ratio, and their covariance.

use super::{Spectrum, Welch};

/// Lines of the spectrum in each band, with the part of the band that each one stands for.
#[derive(Debug, Clone)]
pub(super) struct Bands {
    /// By band: line and ∫ d ln f over what the line shares with the band, over that of the band.
    weights: Vec<Vec<(usize, f64)>>,
    /// Mean of ln f over each band.
    centre: Vec<f64>,
    /// Ends of the first and the last band, per metre.
    ends_per_m: [f64; 2],
}

impl Bands {
    /// As many bands of the ratio `ratio` as there are between the two frequencies, the last ending at the higher one.
    pub(super) fn new(spectrum: &Spectrum, [low, high]: [f64; 2], ratio: f64) -> Self {
        // Rounding must not cost a band that fits exactly.
        let count = ((high / low).ln() / ratio.ln() + 1e-9).floor().max(0.0);
        let mut bands = Self {
            weights: Vec::new(),
            centre: Vec::new(),
            ends_per_m: [high * ratio.powf(-count), high],
        };
        let frequencies = spectrum.frequency_per_m();
        let half = 0.5 * frequencies.get(1).copied().unwrap_or(0.0);
        let mut below = count;
        while below > 0.5 {
            let ends = [high * ratio.powf(-below), high * ratio.powf(1.0 - below)];
            let lines = frequencies.iter().enumerate().skip(1);
            let weights = lines.filter_map(|(line, frequency)| {
                let (from, to) = (
                    (frequency - half).max(ends[0]),
                    (frequency + half).min(ends[1]),
                );
                (to > from).then(|| (line, (to / from).ln() / ratio.ln()))
            });
            bands.weights.push(weights.collect());
            bands.centre.push(0.5 * (ends[0] * ends[1]).ln());
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

    /// Means of `value(line)` over each band, all of ln f counting alike.
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
