//! Modes beside the one that is read. They are linear as far as they are small: each is an exponential, by least squares over what
//! the signal of the one leaves of the record, and can be taken out of it from the first sample on.

use std::f64::consts::TAU;

use nalgebra::{DMatrix, DVector};
use num_complex::Complex64;

use super::in_time::MOST_STEPS;
use super::spectrum::Spectrum;
use super::{Record, Stretches};

/// So many at most.
const MOST: usize = 8;
/// Numbers of each that a fit takes: real and imaginary parts of its amplitude and of its pole.
pub(super) const NUMBERS: usize = 4;
/// Steps of Gauss and Newton at most, and the change of a pole over the record's length (rad) that is none.
const STEPS: usize = 30;
const SETTLED: f64 = 1e-6;
/// Longest change of a pole, in its own decay.
const LONGEST: f64 = 0.5;
/// Damping ratio where a mode is too short or too weak to be read.
const USUAL: f64 = 3e-3;

/// Re(A e^(st)) from the first sample on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::response) struct Other {
    amplitude: Complex64,
    /// 1/s
    pole: Complex64,
}

/// The other modes of a record, of which the mode in the band makes `own` from sample `from` on: the strongest first, each beside
/// those before it, until nothing stands out of the noise. `None` where they, or the samples, are too many.
pub(super) fn others(
    record: &Record,
    (band_hz, own_hz): ([f64; 2], f64),
    (from, own): (usize, &[f64]),
) -> Option<Vec<Other>> {
    // what is longer is not fitted sample by sample
    if record.values.len() > MOST_STEPS {
        return None;
    }
    let beyond = record.values.get(from..)?.iter().zip(own);
    let beyond: Vec<f64> = beyond.map(|(value, own)| value - own).collect();
    let times = Times {
        first_s: record.interval_s * from as f64,
        interval_s: record.interval_s,
        count: beyond.len(),
    };
    let mut modes: Vec<Other> = Vec::new();
    loop {
        let own = beyond.iter().zip(times.each());
        let left = Record {
            interval_s: record.interval_s,
            values: own
                .map(|(value, time_s)| value - at(&modes, time_s))
                .collect(),
        };
        let spectrum = Spectrum::of(&left);
        let Some(hz) = spectrum.strongest_outside(band_hz, own_hz) else {
            return Some(modes);
        };
        if modes.len() == MOST {
            return None;
        }
        let more = with_amplitude(Complex64::ZERO, pole(&left, spectrum.noise, (hz, &modes)));
        let starts = modes.iter().copied().chain([more]).collect();
        match fitted(&beyond, times, starts) {
            Some(better) => modes = better,
            // what is no decay is left where it is
            None => return Some(modes),
        }
    }
}

/// As it is read in a band that reaches half of the way to the nearest of those that are known.
fn pole(left: &Record, noise: f64, (hz, known): (f64, &[Other])) -> Complex64 {
    let apart = |other: &Other| (other.pole.im / TAU - hz).abs();
    let half = 0.5 * known.iter().map(apart).fold(0.5 * hz, f64::min);
    let Stretches {
        omega, stretches, ..
    } = left.tuned(hz, Some([hz - half, hz + half]), noise);
    let read = stretches.first().filter(|own| own.decay > 0.0);
    read.map_or(Complex64::new(-USUAL, 1.0) * (TAU * hz), |own| {
        Complex64::new(-own.decay, omega + own.detuning)
    })
}

fn with_amplitude(amplitude: Complex64, pole: Complex64) -> Other {
    Other { amplitude, pole }
}

/// Sample times.
#[derive(Clone, Copy)]
struct Times {
    first_s: f64,
    interval_s: f64,
    count: usize,
}

impl Times {
    fn span_s(self) -> f64 {
        self.interval_s * self.count as f64
    }

    /// Time of each.
    fn each(self) -> impl Iterator<Item = f64> {
        (0..self.count).map(move |n| self.first_s + self.interval_s * n as f64)
    }
}

/// Exponentials with an offset by Gauss's and Newton's steps from these on; `None` where one of them is no decay.
fn fitted(values: &[f64], times: Times, mut modes: Vec<Other>) -> Option<Vec<Other>> {
    for _ in 0..STEPS {
        let size = 1 + NUMBERS * modes.len();
        let (mut normal, mut right) = (DMatrix::zeros(size, size), DVector::zeros(size));
        for (value, time_s) in values.iter().zip(times.each()) {
            let row = row(&modes, times, time_s);
            let of_mode = |(k, mode): (usize, &Other)| {
                let first = 1 + NUMBERS * k;
                row[first] * mode.amplitude.re + row[first + 1] * mode.amplitude.im
            };
            let own: f64 = modes.iter().enumerate().map(of_mode).sum();
            right.axpy(value - own, &row, 1.0);
            normal.ger(1.0, &row, &row, 1.0);
        }
        let solved = bolted_joint_singular::solution(normal, &right, f64::MIN_POSITIVE)?;
        if solved.len() != size || !solved.iter().all(|own| own.is_finite()) {
            return None;
        }
        let mut moved = 0.0_f64;
        for (k, mode) in modes.iter_mut().enumerate() {
            let number = |place: usize| solved[1 + NUMBERS * k + place];
            // Re(B e^(st)) has the columns Re e^(st) and −Im e^(st)
            let amplitude = Complex64::new(number(0), number(1));
            let along = Complex64::new(number(2), number(3)) / times.span_s();
            if mode.amplitude != Complex64::ZERO {
                let change = along / mode.amplitude;
                let longest = LONGEST * mode.pole.re.abs();
                let change = change * (longest / change.norm()).min(1.0);
                mode.pole += change;
                moved = moved.max(change.norm() * times.span_s());
            } else {
                moved = f64::INFINITY;
            }
            mode.amplitude += amplitude;
        }
        let are_decays = modes
            .iter()
            .all(|own| own.pole.re < 0.0 && own.pole.im > 0.0);
        if !are_decays {
            return None;
        }
        if moved < SETTLED {
            break;
        }
    }
    Some(modes)
}

/// What the modes have at a time.
fn at(modes: &[Other], time_s: f64) -> f64 {
    let each = modes.iter();
    each.map(|own| (own.amplitude * (own.pole * time_s).exp()).re)
        .sum()
}

/// An offset, and what each mode has at a time with another amplitude and, to first order, with another pole.
fn row(modes: &[Other], times: Times, time_s: f64) -> DVector<f64> {
    let part = time_s / times.span_s();
    let of_modes = modes.iter().flat_map(|mode| {
        let own = (mode.pole * time_s).exp();
        [own.re, -own.im, part * own.re, -part * own.im]
    });
    let all = std::iter::once(1.0).chain(of_modes);
    DVector::from_iterator(1 + NUMBERS * modes.len(), all)
}

/// Samples less what these modes have of them.
pub(super) fn without(values: &[f64], modes: &[Other], interval_s: f64) -> Vec<f64> {
    let all = values.iter().enumerate();
    all.map(|(n, value)| value - at(modes, interval_s * n as f64))
        .collect()
}

/// An orthonormal basis of what an offset and errors of these modes are in so many samples.
pub(super) fn basis(modes: &[Other], samples: usize, interval_s: f64) -> DMatrix<f64> {
    let times = Times {
        first_s: 0.0,
        interval_s,
        count: samples,
    };
    let mut columns = DMatrix::zeros(samples, 1 + NUMBERS * modes.len());
    for (n, time_s) in times.each().enumerate() {
        columns.set_row(n, &row(modes, times, time_s).transpose());
    }
    columns.qr().q()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// From poles that are a tenth of their decay and half a bin off, beside an offset.
    #[test]
    fn exponentials_come_back() {
        let truth = [(310.0, 4.0, 0.7), (820.0, 11.0, -1.2)].map(|(omega, decay, phase)| Other {
            amplitude: Complex64::from_polar(0.3, phase),
            pole: Complex64::new(-decay, omega),
        });
        let times = Times {
            first_s: 0.05,
            interval_s: 1e-3,
            count: 900,
        };
        let values: Vec<f64> = times.each().map(|time| 0.2 + at(&truth, time)).collect();
        let poles = truth.iter().map(|own| {
            let Complex64 { re, im } = own.pole;
            let pole = Complex64::new(1.1 * re, im + 0.5 * TAU / times.span_s());
            with_amplitude(Complex64::ZERO, pole)
        });
        let found = fitted(&values, times, poles.collect()).unwrap();
        for (own, truth) in found.iter().zip(&truth) {
            assert!((own.pole - truth.pole).norm() < 1e-7, "{own:?}");
            assert!((own.amplitude - truth.amplitude).norm() < 1e-8, "{own:?}");
        }
        // from the first sample on, which lies before those that were fitted
        let all = Times {
            first_s: 0.0,
            ..times
        };
        let values: Vec<f64> = all.each().map(|time| at(&truth, time)).collect();
        let left = without(&values, &found, 1e-3);
        assert!(left.iter().all(|own| own.abs() < 1e-7));
        // what is nearly them is in the basis
        let basis = basis(&found, values.len(), 1e-3);
        let own = DVector::from_vec(values);
        let rest = &own - &basis * (basis.transpose() * &own);
        assert!(rest.norm() < 1e-9 * own.norm());
    }
}
