//! Power spectral density of a profile by Welch's method: the mean of the periodograms of windowed segments that overlap.

use std::f64::consts::TAU;

use bolted_joint_fourier::Transform;
use num_complex::Complex64;

use super::{Detrend, SurfaceError};

/// Weights of a segment's points, which keep the power of long waves from leaking into short ones.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Window {
    /// Hann: leaks fall off as f⁻⁶, faster than any fractal profile's spectrum.
    Hann,
    /// Blackman: a wider main lobe and lower leaks.
    Blackman,
}

/// How a spectrum is estimated.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Welch {
    /// Weights of a segment's points.
    pub window: Window,
    /// Points in a segment.
    pub segment: usize,
    /// Points that neighbouring segments share.
    pub overlap: usize,
    /// What is taken off each segment.
    pub detrend: Detrend,
}

/// One-sided power spectral density over spatial frequency in cycles per metre: its integral is the mean square height.
#[derive(Debug, Clone, PartialEq)]
pub struct Spectrum {
    /// Frequencies in cycles per metre, from 0 to half the sampling frequency.
    pub frequency_per_m: Vec<f64>,
    /// Density at each frequency, in m³: square metres per cycle and metre.
    pub density_m3: Vec<f64>,
    /// Number of segments in the mean.
    pub segments: usize,
}

impl Window {
    /// Weights of `count` points, periodic: the next one would be the first again.
    pub(super) fn weights(self, count: usize) -> Vec<f64> {
        let angle = |point: usize| TAU * point as f64 / count as f64;
        let weight = |point| match self {
            Self::Hann => 0.5 - 0.5 * f64::cos(angle(point)),
            Self::Blackman => {
                0.42 - 0.5 * f64::cos(angle(point)) + 0.08 * f64::cos(2.0 * angle(point))
            }
        };
        (0..count).map(weight).collect()
    }
}

impl Spectrum {
    /// The mean of spectra over the same frequencies, each counting by its segments; `None` of none.
    pub(super) fn mean(spectra: &[Self]) -> Option<Self> {
        let first = spectra.first()?;
        let segments: usize = spectra.iter().map(|spectrum| spectrum.segments).sum();
        let weighted = |line: usize| {
            spectra
                .iter()
                .map(|spectrum| spectrum.density_m3[line] * spectrum.segments as f64)
                .sum::<f64>()
                / segments as f64
        };
        Some(Self {
            frequency_per_m: first.frequency_per_m.clone(),
            density_m3: (0..first.density_m3.len()).map(weighted).collect(),
            segments,
        })
    }
}

impl Welch {
    /// Refuses segments that are too short or longer than `points`, and overlaps of a whole segment.
    pub(super) fn check(&self, points: usize) -> Result<(), SurfaceError> {
        if !(8..=points).contains(&self.segment) {
            return Err(SurfaceError::Segment {
                found: self.segment,
                points,
            });
        }
        match self.overlap < self.segment {
            true => Ok(()),
            false => Err(SurfaceError::Overlap {
                found: self.overlap,
                segment: self.segment,
            }),
        }
    }

    /// Number of segments in `points` points.
    pub(super) fn segments(&self, points: usize) -> usize {
        (points - self.overlap) / (self.segment - self.overlap)
    }

    /// The spectrum of heights (m) at even steps (m).
    ///
    /// # Errors
    /// [`SurfaceError::Segment`] for segments of fewer than 8 points or more than there are, [`SurfaceError::Overlap`] for an overlap
    /// of a whole segment or more.
    pub fn spectrum(&self, height_m: &[f64], step_m: f64) -> Result<Spectrum, SurfaceError> {
        self.check(height_m.len())?;
        let weights = self.window.weights(self.segment);
        let transform = Transform::forward(self.segment);
        let lines = self.segment / 2 + 1;
        let mut power = vec![0.0; lines];
        let segments = self.segments(height_m.len());
        for number in 0..segments {
            let start = number * (self.segment - self.overlap);
            let flat = self.detrend.apply(&height_m[start..start + self.segment]);
            let mut values: Vec<Complex64> = flat
                .iter()
                .zip(&weights)
                .map(|(height, weight)| Complex64::from(height * weight))
                .collect();
            transform.apply(&mut values);
            for (sum, value) in power.iter_mut().zip(&values) {
                *sum += value.norm_sqr();
            }
        }
        // S = 2 |Σ w z e^(−j2πfx)|² Δ/Σw²; zero and the highest frequency of an even count stand for themselves alone.
        let square: f64 = weights.iter().map(|weight| weight * weight).sum();
        let scale = step_m / (square * segments as f64);
        let density_m3 = power.iter().enumerate().map(|(line, power)| {
            let is_alone = line == 0 || 2 * line == self.segment;
            power * scale * if is_alone { 1.0 } else { 2.0 }
        });
        let length_m = step_m * self.segment as f64;
        Ok(Spectrum {
            frequency_per_m: (0..lines).map(|line| line as f64 / length_m).collect(),
            density_m3: density_m3.collect(),
            segments,
        })
    }

    /// Covariance of the relative errors of two lines of the mean spectrum, by the distance of the lines, up to `lines` − 1.
    ///
    /// `points` are those of each profile. For Gaussian heights whose spectrum varies little over the window's main lobe:
    /// the squared modulus of the coherence of two windowed segments, Σ_t w(t) w(t + s) e^(−j2πdt/n)/Σw², summed over all
    /// pairs of segments of a profile.
    pub(super) fn covariance(&self, points: &[usize], lines: usize) -> Vec<f64> {
        let weights = self.window.weights(self.segment);
        let square: f64 = weights.iter().map(|weight| weight * weight).sum();
        let hop = self.segment - self.overlap;
        let counts: Vec<usize> = points.iter().map(|&points| self.segments(points)).collect();
        let all: usize = counts.iter().sum();
        let mut covariance = vec![0.0; lines];
        for (lag, shift) in (0..).zip((0..self.segment).step_by(hop)) {
            // Pairs of segments `lag` apart, in both orders.
            let pairs: usize = counts.iter().map(|count| count.saturating_sub(lag)).sum();
            let pairs = pairs as f64 * if lag == 0 { 1.0 } else { 2.0 };
            if pairs == 0.0 {
                break;
            }
            for (distance, sum) in covariance.iter_mut().enumerate() {
                let turn = TAU * distance as f64 / self.segment as f64;
                let coherence: Complex64 = weights
                    .iter()
                    .zip(&weights[shift..])
                    .enumerate()
                    .map(|(t, (a, b))| Complex64::from_polar(a * b, -turn * t as f64))
                    .sum();
                *sum += pairs * (coherence / square).norm_sqr() / (all as f64).powi(2);
            }
        }
        covariance
    }

    /// Mean square width of the window's main lobe, in lines: a spectrum's curvature is smoothed over it.
    pub(super) fn smoothing(&self) -> f64 {
        // ∫ f² |W|² df/∫ |W|² df = ∫ w'² dt/(4π² ∫ w² dt)
        match self.window {
            // ∫ (π sin 2πt)²/∫ w² = (π²/2)/(3/8)
            Window::Hann => 1.0 / 3.0,
            // 4π² (½ 0.5² + 2² ½ 0.08²)/(0.42² + ½ 0.5² + ½ 0.08²)/4π²
            Window::Blackman => (0.125 + 2.0 * 0.0064) / (0.1764 + 0.125 + 0.0032),
        }
    }
}
