//! Free decays of one mode: amplitude, frequency and damping over time, by complex demodulation.
//!
//! A record is multiplied by a rotating phasor and averaged under a Gaussian window. What is left is the mode's complex
//! amplitude; its logarithm falls and turns as the mode decays and oscillates. Other modes are told from the spectrum:
//! where one is in the way, the record is refused.

use std::f64::consts::{PI, TAU};

use num_complex::Complex64;
use rustfft::FftPlanner;

use super::backbone::BackboneLine;

/// Half-periods that a point of the backbone is read over.
const HALF_PERIODS: usize = 10;
/// Distances between samples may differ by this part of their mean: files round their times.
const UNEVEN: f64 = 0.02;
/// What is left of a mode at the edge of the band.
const AT_THE_EDGE: f64 = 1e-4;
/// Half the width of the band around a record's only mode, in its frequency.
const HALF_WIDTH: f64 = 0.5;
/// Half the width of the window in standard deviations.
const WINDOW: f64 = 4.0;
/// A second peak of the spectrum that is higher than this part of the first is a mode …
const SECOND: f64 = 0.03;
/// … if the valley between them is lower than this part of it, …
const VALLEY: f64 = 0.5;
/// … and it is so many times the noise.
const ABOVE_NOISE: f64 = 6.0;
/// Multiples of the frequency belong to the mode itself, within this part of it.
const HARMONIC: f64 = 0.05;
/// Amplitudes below so many times their noise, or what the window lets through of other modes, are left out.
const LEAST: f64 = 20.0;
/// How often the phasor is tuned to the mode.
const TUNINGS: usize = 3;

/// Why a record has no backbone.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum DecayProblem {
    /// Times do not ascend evenly.
    Uneven,
    /// Nothing stands out of the noise.
    NoMode,
    /// Several modes, with their frequencies, Hz, the highest first.
    Several(Vec<f64>),
    /// So many points of a backbone.
    TooShort(usize),
}

/// The backbone of a free decay: samples of time (s) and of the `order`-th derivative of displacement, of which the relative motion
/// has the part `share`. `band_hz` holds the mode and no other; without it the record must have one mode alone.
pub(super) fn backbone_of(
    samples: &[(f64, f64)],
    band_hz: Option<[f64; 2]>,
    order: i32,
    share: f64,
) -> Result<Vec<BackboneLine>, DecayProblem> {
    let record = Record::of(samples)?;
    let spectrum = Spectrum::of(&record);
    let mode = spectrum.only_mode(band_hz)?;
    let lines = record.lines(mode, band_hz, spectrum.noise, order, share);
    if lines.len() < 2 {
        return Err(DecayProblem::TooShort(lines.len()));
    }
    Ok(lines)
}

/// Samples at equal distances.
struct Record {
    interval_s: f64,
    values: Vec<f64>,
}

impl Record {
    fn of(samples: &[(f64, f64)]) -> Result<Self, DecayProblem> {
        let (Some(first), Some(last)) = (samples.first(), samples.last()) else {
            return Err(DecayProblem::NoMode);
        };
        let interval_s = (last.0 - first.0) / (samples.len().max(2) - 1) as f64;
        let is_even = |pair: &[(f64, f64)]| {
            let own = pair[1].0 - pair[0].0;
            (own - interval_s).abs() <= UNEVEN * interval_s
        };
        if !(interval_s > 0.0 && samples.windows(2).all(is_even)) {
            return Err(DecayProblem::Uneven);
        }
        let mean = samples.iter().map(|(_, value)| value).sum::<f64>() / samples.len() as f64;
        Ok(Self {
            interval_s,
            values: samples.iter().map(|(_, value)| value - mean).collect(),
        })
    }

    /// Points of the backbone of the mode at `mode_hz`.
    fn lines(
        &self,
        mode_hz: f64,
        band_hz: Option<[f64; 2]>,
        noise: f64,
        order: i32,
        share: f64,
    ) -> Vec<BackboneLine> {
        let mut omega = TAU * mode_hz;
        let edge_hz = band_hz.map_or(HALF_WIDTH * mode_hz, |[from, to]| {
            (mode_hz - from).min(to - mode_hz)
        });
        // exp(−½ (Δω σ)²) at the edge
        let sigma_s = (-2.0 * AT_THE_EDGE.ln()).sqrt() / (TAU * edge_hz);
        let mut stretches = Vec::new();
        for _ in 0..TUNINGS {
            stretches = self.stretches(omega, sigma_s, noise);
            let Some(first) = stretches.first() else {
                break;
            };
            // where the amplitude is large there is most to lose
            omega += first.detuning;
        }
        let natural: Vec<f64> = stretches
            .iter()
            .map(|stretch| (omega + stretch.detuning).hypot(stretch.decay))
            .collect();
        let line = |(n, stretch): (usize, &Stretch)| {
            // Ȧ/A = −D ω/2π/(A dE/dA) with D = 2πζω²MA² and dE/dA, the restoring force at the turn, about
            // ω²MA (1 + ⅓ d ln ω/d ln A): exact for a cubic spring; for powers of 2 and 5 the third is 0.36 and 0.30
            let stiffening = hardening(&stretches, &natural, n);
            let ratio = stretch.decay / natural[n] * (1.0 + stiffening / 3.0);
            (ratio > 0.0).then(|| BackboneLine {
                amplitude_m: stretch.amplitude / natural[n].powi(order) / share.abs(),
                omega: natural[n],
                damping_ratio: Some(ratio),
                force_n: None,
            })
        };
        stretches.iter().enumerate().filter_map(line).collect()
    }

    /// What the record is over ten half-periods at a time, as seen from a phasor that turns with `omega`.
    fn stretches(&self, omega: f64, sigma_s: f64, noise: f64) -> Vec<Stretch> {
        let half_period_s = 0.5 * TAU / omega;
        let reach_s = WINDOW * sigma_s;
        let duration_s = self.interval_s * (self.values.len() - 1) as f64;
        let count = ((duration_s - 2.0 * reach_s) / half_period_s).floor();
        if count.is_nan() || count < HALF_PERIODS as f64 {
            return Vec::new();
        }
        let points: Vec<Point> = (0..=count as usize)
            .map(|index| {
                let time_s = reach_s + half_period_s * index as f64;
                self.demodulated(time_s, omega, sigma_s)
            })
            .collect();
        // of white noise under the window: 2σ √(Δt/(2√π σ_t))
        let of_noise = 2.0 * noise * (self.interval_s / (2.0 * PI.sqrt() * sigma_s)).sqrt();
        let is_clear =
            |point: &Point| point.z.norm() > LEAST * of_noise.max(AT_THE_EDGE * point.largest);
        points
            .chunks(HALF_PERIODS)
            .filter(|chunk| chunk.len() == HALF_PERIODS)
            .take_while(|chunk| chunk.iter().all(is_clear))
            .map(|chunk| Stretch::of(chunk, sigma_s))
            .collect()
    }

    /// 2 Σ x w e^{−jωt}/Σ w about a time, with a Gaussian w.
    fn demodulated(&self, time_s: f64, omega: f64, sigma_s: f64) -> Point {
        let reach_s = WINDOW * sigma_s;
        let from = ((time_s - reach_s) / self.interval_s).ceil().max(0.0) as usize;
        let to = ((time_s + reach_s) / self.interval_s).floor() as usize;
        let (mut sum, mut weights, mut largest) = (Complex64::ZERO, 0.0, 0.0_f64);
        for (index, value) in self.values.iter().enumerate().take(to + 1).skip(from) {
            let t = self.interval_s * index as f64;
            let distance = (t - time_s) / sigma_s;
            let weight = (-0.5 * distance * distance).exp();
            sum += Complex64::cis(-omega * t) * (weight * value);
            weights += weight;
            largest = largest.max(value.abs());
        }
        Point {
            time_s,
            z: 2.0 * sum / weights,
            largest,
        }
    }
}

/// A mode's complex amplitude at one time, and the largest sample about it.
struct Point {
    time_s: f64,
    z: Complex64,
    largest: f64,
}

/// Ten half-periods: amplitude, by how much the mode turns faster than the phasor (rad/s), and how it decays (1/s).
struct Stretch {
    amplitude: f64,
    detuning: f64,
    decay: f64,
}

impl Stretch {
    fn of(points: &[Point], sigma_s: f64) -> Self {
        let count = points.len() as f64;
        let middle_s = points.iter().map(|point| point.time_s).sum::<f64>() / count;
        // ln z = ln A − δt + j Δω t: a straight line by least squares; the phase is unwrapped from point to point
        let mut before = points.first().map_or(Complex64::ONE, |point| point.z);
        let mut logarithm = before.ln();
        let (mut mean, mut slope, mut square) = (Complex64::ZERO, Complex64::ZERO, 0.0);
        for &Point { time_s, z, .. } in points {
            logarithm += (z / before).ln();
            before = z;
            mean += logarithm / count;
            slope += logarithm * (time_s - middle_s);
            square += (time_s - middle_s).powi(2);
        }
        let slope = slope / square;
        // the window averages e^{(−δ + jΔω)t} to exp(½ (−δ + jΔω)² σ²) of it
        let averaged = 0.5 * slope * slope * sigma_s * sigma_s;
        Self {
            amplitude: (mean - averaged).re.exp(),
            detuning: slope.im,
            decay: -slope.re,
        }
    }
}

/// d ln ω/d ln A about a stretch, from its neighbours.
fn hardening(stretches: &[Stretch], omega: &[f64], n: usize) -> f64 {
    let (before, after) = (n.saturating_sub(1), (n + 1).min(stretches.len() - 1));
    let of_frequency = (omega[after] / omega[before]).ln();
    let of_amplitude = (stretches[after].amplitude / stretches[before].amplitude).ln();
    // where the amplitude hardly falls nothing can be told
    if of_amplitude.abs() > of_frequency.abs() {
        of_frequency / of_amplitude
    } else {
        0.0
    }
}

/// Moduli of a record's spectrum under Hann's window.
struct Spectrum {
    step_hz: f64,
    moduli: Vec<f64>,
    /// Standard deviation of white noise of the samples that would have the spectrum's median.
    noise: f64,
}

impl Spectrum {
    fn of(record: &Record) -> Self {
        let count = record.values.len();
        let hann = |n: usize| (0.5 * TAU * (n as f64 + 0.5) / count as f64).sin().powi(2);
        let windowed = record.values.iter().enumerate();
        let mut values: Vec<Complex64> = windowed
            .map(|(n, value)| Complex64::from(value * hann(n)))
            .collect();
        FftPlanner::new()
            .plan_fft_forward(count)
            .process(&mut values);
        let moduli: Vec<f64> = values[..count / 2].iter().map(|v| v.norm()).collect();
        let mut sorted = moduli.clone();
        sorted.sort_by(f64::total_cmp);
        let median = sorted.get(sorted.len() / 2).copied().unwrap_or(0.0);
        Self {
            step_hz: 1.0 / (count as f64 * record.interval_s),
            moduli,
            // |X| is Rayleigh's with a variance of σ² Σ w² = ⅜ N σ²; its median is √ln 2 of the root mean square
            noise: median / (0.375 * count as f64 * std::f64::consts::LN_2).sqrt(),
        }
    }

    /// Frequency of the one mode in the band, Hz.
    fn only_mode(&self, band_hz: Option<[f64; 2]>) -> Result<f64, DecayProblem> {
        let place = |hz: f64| ((hz / self.step_hz).round() as usize).min(self.moduli.len());
        let [from, to] = band_hz.map_or([3, self.moduli.len()], |band| band.map(place));
        let peaks = self.peaks(from.max(3), to);
        let Some(&highest) = peaks.first() else {
            return Err(DecayProblem::NoMode);
        };
        let hz = |peak: usize| self.step_hz * peak as f64;
        let is_harmonic = |peak: usize| {
            let multiple = hz(peak) / hz(highest);
            multiple > 1.5 && (multiple - multiple.round()).abs() < HARMONIC
        };
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

    /// Peaks that stand out, the highest first.
    fn peaks(&self, from: usize, to: usize) -> Vec<usize> {
        let mut sorted = self.moduli.clone();
        sorted.sort_by(f64::total_cmp);
        let floor = ABOVE_NOISE * sorted.get(sorted.len() / 2).copied().unwrap_or(0.0);
        let is_peak = |n: &usize| {
            let own = self.moduli[*n];
            own >= self.moduli[n - 1] && own > *self.moduli.get(n + 1).unwrap_or(&0.0)
        };
        let mut candidates: Vec<usize> = (from.max(1)..to.max(from))
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
                valley.fold(f64::INFINITY, f64::min) < VALLEY * own
            };
            if peaks.iter().all(stands_alone) {
                peaks.push(peak);
            }
        }
        peaks
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// x = e^(−ζω₀t) cos ω_d t, sampled; amplitude, ζ, frequency in Hz.
    fn decaying(modes: &[(f64, f64, f64)], count: u32, interval_s: f64) -> Vec<(f64, f64)> {
        let value = |t: f64| -> f64 {
            let of_mode = |&(amplitude, ratio, hz): &(f64, f64, f64)| {
                let omega = TAU * hz;
                let damped = omega * f64::sqrt(1.0 - ratio * ratio);
                amplitude * (-ratio * omega * t).exp() * (damped * t).cos()
            };
            modes.iter().map(of_mode).sum()
        };
        let times = (0..count).map(|n| f64::from(n) * interval_s);
        times.map(|t| (t, value(t))).collect()
    }

    #[test]
    fn a_linear_decay_has_its_frequency_and_damping() {
        let samples = decaying(&[(2e-4, 0.004, 81.2)], 20_000, 1e-4);
        let lines = backbone_of(&samples, None, 0, 1.0).unwrap();
        assert!(lines.len() > 20, "{}", lines.len());
        for line in &lines {
            assert!(
                (line.omega / (TAU * 81.2) - 1.0).abs() < 1e-6,
                "{}",
                line.omega
            );
            let ratio = line.damping_ratio.unwrap();
            assert!((ratio / 0.004 - 1.0).abs() < 1e-3, "{ratio}");
        }
        // A falls by e^(−ζωT) over five periods T
        for pair in lines.windows(2) {
            let fall = pair[1].amplitude_m / pair[0].amplitude_m;
            assert!(
                (fall / (-0.004 * TAU * 5.0_f64).exp() - 1.0).abs() < 1e-4,
                "{fall}"
            );
        }
    }

    #[test]
    fn amplitudes_are_those_of_the_displacement_whatever_was_measured() {
        let samples = decaying(&[(3.0, 0.002, 50.0)], 40_000, 1e-4);
        let lines = backbone_of(&samples, None, 2, 0.5).unwrap();
        let first = lines[0];
        // back to time zero: the first stretch is in the middle of ten half-periods behind the window
        let omega = TAU * 50.0;
        let sigma_s = (-2.0 * AT_THE_EDGE.ln()).sqrt() / (TAU * 25.0);
        let at_s = WINDOW * sigma_s + 4.5 * 0.01;
        let expected = 3.0 * (-0.002 * omega * at_s).exp() / omega.powi(2) / 0.5;
        assert!(
            (first.amplitude_m / expected - 1.0).abs() < 2e-3,
            "{first:?} {expected}"
        );
    }

    #[test]
    fn two_modes_are_told_and_a_band_takes_one_of_them() {
        let modes = [(2e-4, 0.004, 81.2), (5e-5, 0.003, 204.0)];
        let samples = decaying(&modes, 20_000, 1e-4);
        let Err(DecayProblem::Several(found)) = backbone_of(&samples, None, 0, 1.0) else {
            panic!("two modes pass for one");
        };
        assert!(
            (found[0] - 81.2).abs() < 0.5 && (found[1] - 204.0).abs() < 0.5,
            "{found:?}"
        );
        for ((_, ratio, hz), band) in modes.into_iter().zip([[50.0, 112.0], [150.0, 260.0]]) {
            for line in backbone_of(&samples, Some(band), 0, 1.0).unwrap() {
                assert!(
                    (line.omega / (TAU * hz) - 1.0).abs() < 2e-4,
                    "{}",
                    line.omega / TAU
                );
                let found = line.damping_ratio.unwrap();
                assert!((found / ratio - 1.0).abs() < 0.02, "{found}");
            }
        }
        // both in the band, or neither
        let both = backbone_of(&samples, Some([50.0, 300.0]), 0, 1.0);
        assert!(matches!(both, Err(DecayProblem::Several(_))));
        let samples = decaying(&modes[..1], 20_000, 1e-4);
        let none = backbone_of(&samples, Some([300.0, 400.0]), 0, 1.0);
        assert!(none.is_err());
    }

    #[test]
    fn what_is_no_decay_is_refused() {
        let samples = decaying(&[(2e-4, 0.004, 81.2)], 20_000, 1e-4);
        let short = backbone_of(&samples[..500], None, 0, 1.0);
        assert!(matches!(short, Err(DecayProblem::TooShort(_))), "{short:?}");
        let mut uneven = samples;
        uneven[7].0 += 3e-5;
        assert_eq!(
            backbone_of(&uneven, None, 0, 1.0),
            Err(DecayProblem::Uneven)
        );
    }
}
