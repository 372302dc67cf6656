//! Alternating between frequency and time: harmonics become samples over a period, samples become harmonics.
//!
//! T. M. Cameron and J. H. Griffin, An alternating frequency/time domain method for calculating the steady-state response of
//! nonlinear dynamic systems, J. Appl. Mech. 56 (1989) 149–154. For polynomial forces nothing is lost on the way: a term of
//! degree p in H harmonics has harmonics up to p H, and those that more than (p + 1) H samples fold back are beyond H.

use std::f64::consts::TAU;

use super::Harmonics;

/// Numbers that sums are taken of side by side.
const LANES: usize = 8;

/// The moments of a period at which forces are evaluated, with the values of the harmonics there.
#[derive(Clone, Debug)]
pub(super) struct Sampling {
    count: usize,
    /// cos kτ and sin kτ for k from 0 to twice the highest harmonic, `count` each.
    waves: Vec<f64>,
    are_odd: bool,
}

/// cos kτ and sin kτ parts of a periodic function: Σ g cos kτ / N and Σ g sin kτ / N over the N samples.
#[derive(Clone, Debug, Default)]
pub(super) struct Spectrum {
    pub(super) cosine: Vec<f64>,
    pub(super) sine: Vec<f64>,
}

impl Sampling {
    /// Enough samples for forces of this degree.
    pub(super) fn new(harmonics: &Harmonics, degree: usize) -> Self {
        let are_odd = harmonics.are_odd();
        // Products of odd harmonics repeat after half a period: half the samples do.
        let parts = if are_odd { 2 } else { 1 };
        let needed = (degree + 1) * harmonics.highest() + 1;
        let count = needed.div_ceil(parts).next_multiple_of(LANES);
        let step = TAU / (parts * count) as f64;
        let highest = 2 * harmonics.highest();
        let mut waves = Vec::with_capacity(2 * (highest + 1) * count);
        for order in 0..=highest {
            let angles = (0..count).map(|n| {
                // the angle within one turn, so that it is exact for high orders too
                ((order * n) % (parts * count)) as f64 * step
            });
            waves.extend(angles.clone().map(f64::cos));
            waves.extend(angles.map(f64::sin));
        }
        Self {
            count,
            waves,
            are_odd,
        }
    }

    pub(super) fn count(&self) -> usize {
        self.count
    }

    pub(super) fn cosine(&self, order: usize) -> &[f64] {
        let from = 2 * order * self.count;
        &self.waves[from..from + self.count]
    }

    pub(super) fn sine(&self, order: usize) -> &[f64] {
        let from = (2 * order + 1) * self.count;
        &self.waves[from..from + self.count]
    }

    /// Values of r and dr/dτ, τ = ωt, at the samples.
    pub(super) fn motion(
        &self,
        harmonics: &Harmonics,
        coefficients: &[f64],
        r: &mut [f64],
        rate: &mut [f64],
    ) {
        r.fill(if harmonics.has_constant() {
            coefficients[0]
        } else {
            0.0
        });
        rate.fill(0.0);
        for (order, place) in harmonics.places() {
            let (a, b) = (coefficients[place], coefficients[place + 1]);
            let h = order as f64;
            let waves = self.cosine(order).iter().zip(self.sine(order));
            for ((r, rate), (cosine, sine)) in r.iter_mut().zip(rate.iter_mut()).zip(waves) {
                *r += a * cosine + b * sine;
                *rate += h * (b * cosine - a * sine);
            }
        }
    }

    /// Adds the harmonics of `samples` to coefficients in the layout of `harmonics`.
    pub(super) fn add_harmonics(
        &self,
        harmonics: &Harmonics,
        samples: &[f64],
        coefficients: &mut [f64],
    ) {
        let weight = 1.0 / self.count as f64;
        if harmonics.has_constant() {
            coefficients[0] += weight * samples.iter().sum::<f64>();
        }
        for (order, place) in harmonics.places() {
            coefficients[place] += 2.0 * weight * dot(samples, self.cosine(order));
            coefficients[place + 1] += 2.0 * weight * dot(samples, self.sine(order));
        }
    }

    /// The spectrum of `samples` up to twice the highest harmonic, as products of two harmonics have it.
    pub(super) fn spectrum(&self, samples: &[f64], spectrum: &mut Spectrum) {
        let weight = 1.0 / self.count as f64;
        let highest = self.waves.len() / (2 * self.count);
        spectrum.cosine.resize(highest, 0.0);
        spectrum.sine.resize(highest, 0.0);
        for order in (0..highest).step_by(if self.are_odd { 2 } else { 1 }) {
            spectrum.cosine[order] = weight * dot(samples, self.cosine(order));
            spectrum.sine[order] = weight * dot(samples, self.sine(order));
        }
    }
}

/// Sum of products, in several partial sums that a processor takes side by side.
fn dot(left: &[f64], right: &[f64]) -> f64 {
    let mut sums = [0.0; LANES];
    for (left, right) in left.chunks_exact(LANES).zip(right.chunks_exact(LANES)) {
        for lane in 0..LANES {
            sums[lane] += left[lane] * right[lane];
        }
    }
    sums.iter().sum()
}
