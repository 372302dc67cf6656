//! Whether a record is that of one mode, by what its demodulated signal does and what it leaves of the record.
//!
//! A spectrum over the whole record tells modes that last as long as each other. One that fades early is hardly in it, but it
//! is in the signal while that is read: within the window it makes beats, and the amplitude of one mode that is left alone never
//! rises; outside of the window it stays in the record when the signal is taken away.

use std::f64::consts::TAU;

use bolted_joint_fourier::Transform;
use num_complex::Complex64;

use super::spectrum::{HARMONIC, LOWEST};
use super::stretch::Point;
use super::{AT_THE_EDGE, DecayProblem, Record};

/// Part of itself by which an amplitude may rise: what a mode far below the others shows in a structure that is measured.
const RISE: f64 = 0.05;
/// The same in root mean squares of the noise, or of what the window lets through of other modes: the largest of thousands.
const NOISE: f64 = 6.0;
/// Root of the energy that the signal may leave of the record, beside noise, as a part of its own.
const LEFT: f64 = 0.05;
/// Deviations of the energy of noise that are chance.
const CHANCE: f64 = 5.0;
/// Amplitude up to which a multiple of the frequency belongs to the mode itself, as a part of the mode's displacement.
const OF_HARMONIC: f64 = 0.05;

/// The signal of the mode: complex amplitudes at half-periods, as seen from a phasor that turns with `omega`.
pub(super) struct Signal<'a> {
    pub(super) points: &'a [Point],
    pub(super) omega: f64,
    /// Of the window.
    pub(super) sigma_s: f64,
    /// Root mean square of the noise of a complex amplitude.
    pub(super) of_noise: f64,
}

impl Signal<'_> {
    /// Refuses a signal whose amplitude rises: a mode that is left alone loses energy.
    pub(super) fn falls(&self) -> Result<(), DecayProblem> {
        let mut least: Option<&Point> = None;
        for (place, point) in self.points.iter().enumerate() {
            let size = point.z.norm();
            let Some(lowest) = least.filter(|least| least.z.norm() < size) else {
                least = Some(point);
                continue;
            };
            let from = lowest.z.norm();
            let other = self
                .of_noise
                .max(AT_THE_EDGE * lowest.largest.max(point.largest));
            if size > (1.0 + RISE) * from + NOISE * other {
                let top = self.top(place);
                return Err(DecayProblem::Rises {
                    at_s: lowest.time_s,
                    times: top.z.norm() / from,
                    // from the least to the most it is half a beat
                    apart_hz: 0.5 / (top.time_s - lowest.time_s),
                    mode_hz: self.omega / TAU,
                });
            }
        }
        Ok(())
    }

    /// The next maximum of the amplitude.
    fn top(&self, from: usize) -> &Point {
        let mut pairs = self.points[from..].windows(2);
        let falls = pairs.position(|pair| pair[1].z.norm() < pair[0].z.norm());
        let last = self.points.len() - 1;
        &self.points[falls.map_or(last, |falls| from + falls)]
    }

    /// Refuses a record of which the signal leaves more than noise and harmonics of its own; samples are of the `order`-th
    /// derivative of the displacement, with white noise of the standard deviation `noise`.
    pub(super) fn leaves_noise(
        &self,
        record: &Record,
        order: i32,
        noise: f64,
    ) -> Result<(), DecayProblem> {
        let Some((from, own)) = self.samples(record.interval_s) else {
            return Ok(());
        };
        let pairs = record.values[from..].iter().zip(&own);
        let mut left: Vec<Complex64> = pairs
            .map(|(value, own)| Complex64::from(value - own))
            .collect();
        let count = left.len();
        Transform::forward(count).apply(&mut left);
        let step_hz = 1.0 / (count as f64 * record.interval_s);
        let powers: Vec<f64> = left[..count / 2].iter().map(|own| own.norm_sqr()).collect();
        // Σ|X|² = N Σx², half of it on either side
        let energy = 0.5 * count as f64 * own.iter().map(|own| own * own).sum::<f64>();
        let of_bin = count as f64 * noise * noise;
        let own_hz = self.omega / TAU;
        let multiple = |bin: usize| (step_hz * bin as f64 / own_hz).round();
        let is_near = |bin: usize| {
            let distance = step_hz * bin as f64 / own_hz - multiple(bin);
            multiple(bin) > 1.5 && distance.abs() < HARMONIC
        };
        let mut others: Vec<usize> = (LOWEST..powers.len()).collect();
        let highest = others.last().map_or(0.0, |&bin| multiple(bin)) as usize;
        for harmonic in 2..=highest {
            let is_own = |bin: &usize| is_near(*bin) && multiple(*bin) as usize == harmonic;
            let of_harmonic: f64 = others
                .iter()
                .filter(|bin| is_own(bin))
                .map(|&bin| powers[bin])
                .sum();
            let most = OF_HARMONIC * (harmonic as f64).powi(order);
            if of_harmonic < most * most * energy {
                others.retain(|bin| !is_own(bin));
            }
        }
        let of_others: f64 = others.iter().map(|&bin| powers[bin]).sum();
        // each of N bins has the mean and the deviation of its noise
        let of_noise = of_bin * (others.len() as f64 + CHANCE * (others.len() as f64).sqrt());
        let part = ((of_others - of_noise).max(0.0) / energy).sqrt();
        if part <= LEFT {
            return Ok(());
        }
        let largest = others
            .iter()
            .max_by(|&&a, &&b| powers[a].total_cmp(&powers[b]));
        Err(DecayProblem::Leaves {
            mode_hz: own_hz,
            other_hz: largest.map_or(0.0, |&bin| step_hz * bin as f64),
            part,
        })
    }

    /// What the mode makes of the samples from the first of its points to the last, and the first sample.
    pub(super) fn samples(&self, interval_s: f64) -> Option<(usize, Vec<f64>)> {
        let logarithms = self.logarithms();
        let (first, last) = (logarithms.first()?, logarithms.last()?);
        let from = (first.0 / interval_s).ceil() as usize;
        let to = (last.0 / interval_s).floor() as usize;
        let mut pairs = logarithms.windows(2);
        let mut pair = pairs.next()?;
        let samples = (from..=to).map(|n| {
            let time_s = interval_s * n as f64;
            while time_s > pair[1].0 {
                let Some(next) = pairs.next() else {
                    break;
                };
                pair = next;
            }
            let [(start_s, before), (end_s, after)] = [pair[0], pair[1]];
            let share = (time_s - start_s) / (end_s - start_s);
            let logarithm = before + share * (after - before);
            (logarithm + Complex64::new(0.0, self.omega * time_s))
                .exp()
                .re
        });
        Some((from, samples.collect()))
    }

    /// Time and ln z at each point, without what the window does to it.
    fn logarithms(&self) -> Vec<(f64, Complex64)> {
        let mut logarithm = Complex64::ZERO;
        let mut before = Complex64::ONE;
        let plain: Vec<(f64, Complex64)> = self
            .points
            .iter()
            .map(|point| {
                logarithm += (point.z / before).ln();
                before = point.z;
                (point.time_s, logarithm)
            })
            .collect();
        let around = |place: usize| {
            let (low, high) = (place.saturating_sub(1), (place + 1).min(plain.len() - 1));
            let (start, end) = (plain[low], plain[high]);
            (end.1 - start.1) / (end.0 - start.0).max(f64::MIN_POSITIVE)
        };
        let bent = |place: usize| {
            let middle = place.clamp(1, plain.len().saturating_sub(2).max(1));
            let Some([(start_s, start), (_, own), (end_s, end)]) =
                plain.get(middle - 1..=middle + 1)
            else {
                return Complex64::ZERO;
            };
            let step_s = 0.5 * (end_s - start_s);
            (end - 2.0 * own + start) / (step_s * step_s).max(f64::MIN_POSITIVE)
        };
        let square = self.sigma_s * self.sigma_s;
        let places = plain.iter().enumerate();
        places
            .map(|(place, &(time_s, logarithm))| {
                // of e^{λt + ½κt²} the window's average has the slope λ' = λ/(1 − κσ²) and bends by κ' = κ/(1 − κσ²); its
                // logarithm is more by ½ λ'² σ²/(1 + κ'σ²) + ½ ln(1 + κ'σ²)
                let (slope, factor) = (around(place), 1.0 + bent(place) * square);
                let averaged = 0.5 * (slope * slope * square / factor + factor.ln());
                (time_s, logarithm - averaged)
            })
            .collect()
    }
}
