//! Which modes a record has, and how much noise: its spectrum.

use std::f64::consts::TAU;
use std::ops::Range;

use bolted_joint_fourier::Transform;
use bolted_joint_statistics::upper_median;
use num_complex::Complex64;

use super::{DecayProblem, Record};

/// A second peak of the spectrum that is higher than this part of the first is a mode …
const SECOND: f64 = 0.03;
/// … if the valley between them is lower than this part of it, …
const VALLEY: f64 = 0.5;
/// … and it is so many times the noise.
const ABOVE_NOISE: f64 = 6.0;
/// How far noise alone may make a dip in the spectrum of one mode, in medians of the spectrum.
const DIP: f64 = 2.0;
/// Bins of a spectrum below which there is what a sensor drifts by.
pub(super) const LOWEST: usize = 3;
/// Multiples of the frequency belong to the mode itself, within this part of it.
pub(super) const HARMONIC: f64 = 0.05;

/// Moduli of a record's spectrum under Hann's window.
pub(super) struct Spectrum {
    step_hz: f64,
    moduli: Vec<f64>,
    /// Standard deviation of white noise of the samples that would have the spectrum's median.
    pub(super) noise: f64,
}

impl Spectrum {
    pub(super) fn of(record: &Record) -> Self {
        let count = record.values.len();
        let hann = |n: usize| (0.5 * TAU * (n as f64 + 0.5) / count as f64).sin().powi(2);
        let windowed = record.values.iter().enumerate();
        let mut values: Vec<Complex64> = windowed
            .map(|(n, value)| Complex64::from(value * hann(n)))
            .collect();
        Transform::forward(count).apply(&mut values);
        let moduli: Vec<f64> = values[..count / 2].iter().map(|v| v.norm()).collect();
        let median = median(&moduli);
        Self {
            step_hz: 1.0 / (count as f64 * record.interval_s),
            moduli,
            // |X| is Rayleigh's with a variance of σ² Σ w² = ⅜ N σ²; its median is √ln 2 of the root mean square
            noise: median / (0.375 * count as f64 * std::f64::consts::LN_2).sqrt(),
        }
    }

    /// Frequency of the one mode in the band, Hz.
    pub(super) fn only_mode(&self, band_hz: Option<[f64; 2]>) -> Result<f64, DecayProblem> {
        let place = |hz: f64| ((hz / self.step_hz).round() as usize).min(self.moduli.len());
        let [from, to] = band_hz.map_or([LOWEST, self.moduli.len()], |band| band.map(place));
        let peaks = self.peaks(from.max(LOWEST)..to);
        let Some(&highest) = peaks.first() else {
            return Err(DecayProblem::NoMode);
        };
        let hz = |peak: usize| self.step_hz * peak as f64;
        let is_harmonic = |peak: usize| is_multiple(hz(peak), hz(highest));
        let mut others = peaks[1..]
            .iter()
            .copied()
            .filter(|&peak| !is_harmonic(peak));
        if others.next().is_none() {
            return Ok(hz(highest));
        }
        let modes = peaks.iter().copied().filter(|&peak| !is_harmonic(peak));
        Err(DecayProblem::Several(modes.map(hz).collect()))
    }

    /// Frequency of what stands out most outside of a band, beside multiples of the frequency of the mode in it, Hz.
    pub(super) fn strongest_outside(&self, band_hz: [f64; 2], own_hz: f64) -> Option<f64> {
        let hz = |bin: usize| self.step_hz * bin as f64;
        let is_other = |&bin: &usize| {
            let is_inside = hz(bin) >= band_hz[0] && hz(bin) <= band_hz[1];
            !is_inside && !is_multiple(hz(bin), own_hz)
        };
        let all = (LOWEST..self.moduli.len()).filter(is_other);
        let highest = all.max_by(|&a, &b| self.moduli[a].total_cmp(&self.moduli[b]))?;
        (self.moduli[highest] > ABOVE_NOISE * median(&self.moduli)).then(|| hz(highest))
    }

    /// Peaks that stand out, the highest first.
    fn peaks(&self, range: Range<usize>) -> Vec<usize> {
        let median = median(&self.moduli);
        let floor = ABOVE_NOISE * median;
        let is_peak = |n: &usize| {
            let own = self.moduli[*n];
            own >= self.moduli[n - 1] && own > *self.moduli.get(n + 1).unwrap_or(&0.0)
        };
        let mut candidates: Vec<usize> = (range.start.max(1)..range.end)
            .filter(|n| *n < self.moduli.len())
            .filter(is_peak)
            .collect();
        candidates.sort_by(|&a, &b| self.moduli[b].total_cmp(&self.moduli[a]));
        let highest = candidates.first().map_or(0.0, |&peak| self.moduli[peak]);
        let mut peaks: Vec<usize> = Vec::new();
        for peak in candidates {
            let own = self.moduli[peak];
            if own < (SECOND * highest).max(floor) {
                break;
            }
            let stands_alone = |other: &usize| {
                let between = peak.min(*other)..=peak.max(*other);
                let valley = self.moduli[between].iter().copied();
                // the least of many values is low by noise alone
                valley.fold(f64::INFINITY, f64::min) + DIP * median < VALLEY * own
            };
            if peaks.iter().all(stands_alone) {
                peaks.push(peak);
            }
        }
        peaks
    }
}

fn median(moduli: &[f64]) -> f64 {
    upper_median(moduli.iter().copied()).unwrap_or(0.0)
}

/// Whether a frequency is a multiple of the mode's own.
fn is_multiple(hz: f64, own_hz: f64) -> bool {
    let multiple = hz / own_hz;
    multiple > 1.5 && (multiple - multiple.round()).abs() < HARMONIC
}
