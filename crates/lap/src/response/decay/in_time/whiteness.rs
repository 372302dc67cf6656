//! Whether what a fit in time leaves of a record is white noise: only then is the likelihood the right one, and only then are
//! its deviations those of the estimate. Each test looks for what a wrong law, a second mode or a sensor would leave.

use std::fmt;

use bolted_joint_statistics::chi_squared_tail;
use nalgebra::DVector;
use num_complex::Complex64;

use super::release::Course;
use crate::response::decay::motion::{Grid, sampled};
use crate::response::decay::recorded::Recorded;
use crate::response::model::Values;

/// Probability below which a value is no chance.
const CHANCE: f64 = 1e-3;
/// Neighbours of a sample that are looked at.
const NEIGHBOURS: usize = 20;
/// Parts of the time.
const PARTS: usize = 12;
/// Multiples of the frequency beside the motion itself, and the highest frequency, as a part of the samples'.
const MULTIPLES: [i32; 3] = [2, 3, 5];
const HIGHEST: f64 = 0.45;
/// Mean square of the residual, in that of the noise at all other frequencies, beyond which it is more than noise.
const LARGE: f64 = 1.5;

/// What is not white of a residual.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Coloured {
    /// It is so many times the noise that the rest of the spectrum has.
    Large(f64),
    /// Neighbouring samples are alike.
    Neighbours,
    /// Its size changes with time, and so with the amplitude.
    OverTime,
    /// It follows the motion.
    AlongMotion,
    /// It has multiples of the motion's frequency.
    Multiples,
}

impl fmt::Display for Coloured {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Large(times) => write!(f, "it is {times:.1} times the noise of the record"),
            Self::Neighbours => f.write_str("neighbouring samples are alike"),
            Self::OverTime => f.write_str("its size changes with the amplitude"),
            Self::AlongMotion => f.write_str("it follows the motion"),
            Self::Multiples => f.write_str("it has multiples of the motion's frequency"),
        }
    }
}

/// A sum of squares that has the distribution of χ² where the residual is white.
#[derive(Clone, Copy, Debug, Default)]
struct Squares {
    sum: f64,
    degrees_of_freedom: usize,
}

impl Squares {
    fn is_chance(self) -> bool {
        self.degrees_of_freedom == 0 || chi_squared_tail(self.sum, self.degrees_of_freedom) > CHANCE
    }

    fn and(self, other: Self) -> Self {
        Self {
            sum: self.sum + other.sum,
            degrees_of_freedom: self.degrees_of_freedom + other.degrees_of_freedom,
        }
    }
}

/// What the tests are about: a record, how its samples are computed, and what the fit leaves of them.
pub(super) type Left<'a> = (&'a Recorded, &'a Grid, &'a Course);

/// What is not white of what is left of all records, with so many unknowns that were fitted to them.
pub(super) fn coloured(values: &Values, all: &[Left<'_>], unknowns: usize) -> Option<Coloured> {
    let mut sums = [Squares::default(); 4];
    let (mut squares, mut count) = (0.0, 0);
    for &(record, grid, course) in all {
        let left = &course.residual;
        let size = left.norm() / (left.len().max(1) as f64).sqrt();
        squares += left.norm_squared();
        count += left.len();
        let scaled = left / size.max(f64::MIN_POSITIVE);
        let [along, multiples] = of_motion(values, record, grid, course, &scaled)?;
        let own = [neighbours(&scaled), over_time(&scaled), along, multiples];
        for (sum, own) in sums.iter_mut().zip(own) {
            *sum = sum.and(own);
        }
    }
    let [neighbours, over_time, mut along, multiples] = sums;
    // the fit has taken out what follows the unknowns and each release
    let fitted = unknowns + 2 * all.len();
    along.degrees_of_freedom = along.degrees_of_freedom.saturating_sub(fitted);
    let mean_square = squares / count.max(1) as f64;
    match () {
        () if mean_square.is_nan() || mean_square > LARGE => {
            Some(Coloured::Large(mean_square.sqrt()))
        }
        () if !along.is_chance() => Some(Coloured::AlongMotion),
        () if !multiples.is_chance() => Some(Coloured::Multiples),
        () if !over_time.is_chance() => Some(Coloured::OverTime),
        () if !neighbours.is_chance() => Some(Coloured::Neighbours),
        () => None,
    }
}

/// Q = N(N+2) Σ r_k²/(N−k)   (Ljung and Box, Biometrika 65 (1978) 297)
fn neighbours(left: &DVector<f64>) -> Squares {
    let count = left.len();
    let lags = NEIGHBOURS.min(count / 4);
    let values = left.as_slice();
    let whole = left.norm_squared();
    let of_lag = |lag: usize| {
        let pairs = values.iter().zip(&values[lag..]);
        let alike = pairs.map(|(one, other)| one * other).sum::<f64>() / whole;
        alike * alike / (count - lag) as f64
    };
    Squares {
        sum: (count * (count + 2)) as f64 * (1..=lags).map(of_lag).sum::<f64>(),
        degrees_of_freedom: lags,
    }
}

/// Mean squares of parts of the time, in the deviations √(2/n) that normal noise gives them.
fn over_time(left: &DVector<f64>) -> Squares {
    let parts = parts(left.len());
    let sum = parts.iter().map(|&(from, to)| {
        let own = left.rows(from, to - from).norm_squared() / (to - from) as f64;
        0.5 * (to - from) as f64 * (own - 1.0).powi(2)
    });
    Squares {
        sum: sum.sum(),
        // their mean is one
        degrees_of_freedom: parts.len() - 1,
    }
}

/// Beginnings and ends of parts of the time.
fn parts(count: usize) -> Vec<(usize, usize)> {
    let ends = (0..=PARTS).map(|n| n * count / PARTS);
    let ends: Vec<usize> = ends.collect();
    ends.windows(2).map(|pair| (pair[0], pair[1])).collect()
}

/// What is left along the motion and along multiples of its frequency, part of the time by part: in phase and a quarter of a
/// period behind.
fn of_motion(
    values: &Values,
    record: &Recorded,
    grid: &Grid,
    course: &Course,
    left: &DVector<f64>,
) -> Option<[Squares; 2]> {
    // the same motion a little later tells its rate
    let angle = 1e-3;
    let mut later = course.release;
    later.time_s -= angle / grid.omega;
    let [own, later] =
        [course.release, later].map(|release| sampled(values, &release, record, grid));
    let (own, later) = (own?, later?);
    let turned = own.iter().zip(&later).map(|(own, later)| {
        // x = Re z, ẋ/ω = −Im z
        Complex64::new(*own, (own - later) / angle)
    });
    let turned: Vec<Complex64> = turned.collect();
    let along = along(left, &turned);
    let mut multiples = Squares::default();
    let of_samples = grid.omega * record.interval_s / std::f64::consts::TAU;
    for multiple in MULTIPLES {
        if f64::from(multiple) * of_samples < HIGHEST {
            let carrier = turned.iter().map(|z| (z / z.norm()).powi(multiple));
            multiples = multiples.and(self::along(left, &carrier.collect::<Vec<_>>()));
        }
    }
    Some([along, multiples])
}

/// Squares of the parts along real and imaginary part of a carrier, in each part of the time.
fn along(left: &DVector<f64>, carrier: &[Complex64]) -> Squares {
    let mut all = Squares::default();
    for (from, to) in parts(left.len()) {
        let real = DVector::from_iterator(to - from, carrier[from..to].iter().map(|z| z.re));
        let imaginary = DVector::from_iterator(to - from, carrier[from..to].iter().map(|z| z.im));
        let own = left.rows(from, to - from);
        let first = real.dot(&own).powi(2) / real.norm_squared();
        let across = &imaginary - &real * (real.dot(&imaginary) / real.norm_squared());
        let second = across.dot(&own).powi(2) / across.norm_squared();
        if first.is_finite() && second.is_finite() {
            all = all.and(Squares {
                sum: first + second,
                degrees_of_freedom: 2,
            });
        }
    }
    all
}

#[cfg(test)]
mod tests;
