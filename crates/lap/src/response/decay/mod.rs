//! Free decays of one mode: amplitude, frequency and damping over time, by complex demodulation.
//!
//! A record is multiplied by a rotating phasor and averaged under a Gaussian window. What is left is the mode's complex
//! amplitude; its logarithm falls and turns as the mode decays and oscillates. Other modes are told from the spectrum, from beats
//! of the amplitude, and from what the signal leaves of the record: where one is in the way, the record is refused.

mod clipped;
mod errors;
mod in_time;
mod motion;
mod one_mode;
mod others;
mod recorded;
mod simulated;
mod spectrum;
mod stretch;

use std::f64::consts::{PI, TAU};

use num_complex::Complex64;

use self::one_mode::Signal;
use self::spectrum::Spectrum;
use self::stretch::{Part, Point, Stretch, covariance};
use super::backbone::BackboneLine;

pub(super) use self::errors::ReadingErrors;
pub use self::in_time::{Coloured, InTime, NotInTime};
pub(super) use self::in_time::{Effort, Rows, fitted};
pub(super) use self::recorded::{Quantity, Recorded};
pub(super) use self::simulated::{Following, beside, corrected, followed};

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
/// Amplitudes below so many times their noise, or what the window lets through of other modes, are left out.
const LEAST: f64 = 20.0;
/// What reading over ten half-periods leaves uncertain without any noise: part of the frequency and of the damping ratio.
const READING: [f64; 2] = [1e-5, 2e-3];
/// How often the phasor is tuned to the mode.
const TUNINGS: usize = 3;

/// Why a record has no backbone.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum DecayProblem {
    /// Times do not ascend evenly.
    Uneven,
    /// So many samples at the end of a range, the last of them at this time.
    Clipped {
        limit: f64,
        samples: usize,
        last_s: f64,
    },
    /// Nothing stands out of the noise.
    NoMode,
    /// Several modes, with their frequencies, Hz, the highest first.
    Several(Vec<f64>),
    /// An amplitude that rises after this time to so many times of it, as two modes make it that are so far apart.
    Rises {
        at_s: f64,
        times: f64,
        apart_hz: f64,
        mode_hz: f64,
    },
    /// What is in the record beside the mode: its strongest frequency, and its size as a part of the mode's.
    Leaves {
        mode_hz: f64,
        other_hz: f64,
        part: f64,
    },
    /// So many points of a backbone.
    TooShort(usize),
}

/// The backbone of a free decay, with its errors: samples of time (s) and of the `order`-th derivative of displacement, of which
/// the relative motion has the part `share`. `band_hz` holds the mode and no other; without it the record must have one mode alone.
/// Beside the noise of the record frequencies and damping ratios have errors of the parts `beside`.
pub(super) fn backbone_of(
    samples: &[(f64, f64)],
    band_hz: Option<[f64; 2]>,
    order: i32,
    share: f64,
    beside: [f64; 2],
) -> Result<Decay, DecayProblem> {
    let record = Record::of(samples)?;
    clipped::refuse(samples)?;
    let spectrum = Spectrum::of(&record);
    let mode_hz = spectrum.only_mode(band_hz)?;
    let stretches = record.tuned(mode_hz, band_hz, spectrum.noise);
    let Stretches {
        omega,
        sigma_s,
        of_noise,
        ..
    } = stretches;
    let course: Vec<Point> = record.course(omega, sigma_s).collect();
    let signal = |points| Signal {
        points,
        omega,
        sigma_s,
        of_noise,
    };
    signal(&course).falls()?;
    if band_hz.is_none() {
        let read = course.iter().take_while(|point| point.is_clear(of_noise));
        let read = signal(&course[..read.count()]);
        read.leaves_noise(&record, order, spectrum.noise)?;
    }
    let others = band_hz.map_or(Some(Vec::new()), |band_hz| {
        let read = course.iter().take_while(|point| point.is_clear(of_noise));
        let (from, own) = signal(&course[..read.count()]).samples(record.interval_s)?;
        others::others(&record, (band_hz, omega / TAU), (from, &own))
    });
    let lines = stretches.lines(order, share);
    if lines.len() < 2 {
        return Err(DecayProblem::TooShort(lines.len()));
    }
    let read = stretches.stretches.iter().map(|stretch| stretch.amplitude);
    let read = read.fold(0.0, f64::max);
    let largest = record.values.iter().map(|value| value.abs());
    let read_part = read / largest.fold(f64::MIN_POSITIVE, f64::max);
    let errors = stretches.errors(&lines, beside);
    let errors = errors.ok_or(DecayProblem::TooShort(lines.len()))?;
    Ok(Decay {
        lines,
        errors,
        recorded: Recorded {
            interval_s: record.interval_s,
            values: record.values,
            quantity: Quantity::of_order(order),
            share,
            noise: spectrum.noise,
            read_part,
            has_band: band_hz.is_some(),
            others,
        },
    })
}

/// A free decay: the points of its backbone with their errors, and the record that they were read from.
pub(super) struct Decay {
    pub(super) lines: Vec<BackboneLine>,
    pub(super) errors: ReadingErrors,
    pub(super) recorded: Recorded,
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

    /// The stretches of the mode at `mode_hz`, seen from a phasor that turns with it.
    fn tuned(&self, mode_hz: f64, band_hz: Option<[f64; 2]>, noise: f64) -> Stretches {
        let mut omega = TAU * mode_hz;
        let edge_hz = band_hz.map_or(HALF_WIDTH * mode_hz, |[from, to]| {
            (mode_hz - from).min(to - mode_hz)
        });
        // exp(−½ (Δω σ)²) at the edge
        let sigma_s = (-2.0 * AT_THE_EDGE.ln()).sqrt() / (TAU * edge_hz);
        // of white noise under the window: 2σ √(Δt/(2√π σ_t))
        let of_noise = 2.0 * noise * (self.interval_s / (2.0 * PI.sqrt() * sigma_s)).sqrt();
        for _ in 1..TUNINGS {
            // where the amplitude is large there is most to lose
            let stretches = self.stretches(omega, sigma_s, of_noise);
            omega += stretches.first().map_or(0.0, |first| first.detuning);
        }
        let stretches = self.stretches(omega, sigma_s, of_noise);
        Stretches {
            omega,
            sigma_s,
            of_noise,
            stretches,
        }
    }

    /// What the record is over ten half-periods at a time, as seen from a phasor that turns with `omega`.
    fn stretches(&self, omega: f64, sigma_s: f64, of_noise: f64) -> Vec<Stretch> {
        let points = self.points(omega, sigma_s, of_noise);
        let whole = points.chunks_exact(HALF_PERIODS);
        whole.map(|chunk| Stretch::of(chunk, sigma_s)).collect()
    }

    /// The mode's complex amplitudes at half-periods, as long as they are clear of noise and of other modes.
    fn points(&self, omega: f64, sigma_s: f64, of_noise: f64) -> Vec<Point> {
        let all = self.course(omega, sigma_s);
        all.take_while(|point| point.is_clear(of_noise)).collect()
    }

    /// The mode's complex amplitudes at all half-periods.
    fn course(&self, omega: f64, sigma_s: f64) -> impl Iterator<Item = Point> {
        let half_period_s = 0.5 * TAU / omega;
        let reach_s = WINDOW * sigma_s;
        let duration_s = self.interval_s * (self.values.len() - 1) as f64;
        let count = ((duration_s - 2.0 * reach_s) / half_period_s).floor();
        let count = match count >= HALF_PERIODS as f64 {
            true => count as usize + 1,
            false => 0,
        };
        (0..count).map(move |index| {
            let time_s = reach_s + half_period_s * index as f64;
            self.demodulated(time_s, omega, sigma_s)
        })
    }

    /// 2 Σ x w e^{−jωt}/Σ w about a time, with a Gaussian w.
    fn demodulated(&self, time_s: f64, omega: f64, sigma_s: f64) -> Point {
        let reach_s = WINDOW * sigma_s;
        let from = ((time_s - reach_s) / self.interval_s).ceil().max(0.0) as usize;
        let to = ((time_s + reach_s) / self.interval_s).floor() as usize;
        let first_s = self.interval_s * from as f64;
        // From sample to sample the phasor turns by the same angle, and the logarithm of the Gaussian changes by an even series.
        let (apart, step) = ((first_s - time_s) / sigma_s, self.interval_s / sigma_s);
        let mut weight = (-0.5 * apart * apart).exp();
        let mut growth = (-step * (apart + 0.5 * step)).exp();
        let falls = (-step * step).exp();
        let mut phasor = Complex64::cis(-omega * first_s);
        let turns = Complex64::cis(-omega * self.interval_s);
        let (mut sum, mut weights, mut largest) = (Complex64::ZERO, 0.0, 0.0_f64);
        let last = (to + 1).min(self.values.len());
        for value in self.values.get(from..last).unwrap_or_default() {
            sum += phasor * (weight * value);
            weights += weight;
            largest = largest.max(value.abs());
            weight *= growth;
            growth *= falls;
            phasor *= turns;
        }
        Point {
            time_s,
            z: 2.0 * sum / weights,
            largest,
        }
    }
}

/// A mode's decay, stretch by stretch, as seen from a phasor that turns with `omega`.
struct Stretches {
    omega: f64,
    /// Of the window.
    sigma_s: f64,
    /// Root mean square of the noise of a complex amplitude.
    of_noise: f64,
    stretches: Vec<Stretch>,
}

impl Stretches {
    /// Points of the backbone.
    fn lines(&self, order: i32, share: f64) -> Vec<BackboneLine> {
        let line = |stretch: &Stretch| {
            let natural = (self.omega + stretch.detuning).hypot(stretch.decay);
            BackboneLine {
                amplitude_m: stretch.amplitude / natural.powi(order) / share.abs(),
                omega: natural,
                damping_ratio: Some(stretch.decay / natural),
                force_n: None,
                time_s: Some(stretch.middle_s),
            }
        };
        self.stretches.iter().map(line).collect()
    }

    /// Errors of these points; `None` where they have no definite covariance.
    fn errors(&self, lines: &[BackboneLine], beside: [f64; 2]) -> Option<ReadingErrors> {
        let noise = (self.sigma_s, self.of_noise);
        let of = |parts: [Part; 2]| covariance(&self.stretches, noise, parts);
        let parts = [
            of([Part::Slope, Part::Slope]),
            of([Part::Mean, Part::Mean]),
            of([Part::Mean, Part::Slope]),
        ];
        let beside = [0, 1].map(|kind| READING[kind].hypot(beside[kind]));
        ReadingErrors::of(lines, self.sigma_s, parts, beside)
    }
}

#[cfg(test)]
mod tests;
