//! The course of one DOF over a period: where it is, where it turns, and when it passes a place.

use std::f64::consts::{PI, TAU};

use num_complex::Complex64;

use super::Harmonics;

/// Samples for each period of the highest harmonic, between which turns are looked for.
const SAMPLES: usize = 8;
/// Fewest samples of a period.
const FEWEST_SAMPLES: usize = 32;
/// Most steps of a search for a root, which takes about ten.
const MOST_STEPS: usize = 100;

/// A periodic motion r(τ) of one DOF, τ = ωt.
#[derive(Clone, Copy, Debug)]
pub(super) struct Course<'a> {
    harmonics: &'a Harmonics,
    coefficients: &'a [f64],
}

impl<'a> Course<'a> {
    /// That of these coefficients, in the layout of the harmonics.
    pub(super) fn new(harmonics: &'a Harmonics, coefficients: &'a [f64]) -> Self {
        Self {
            harmonics,
            coefficients,
        }
    }

    /// Whether its second half is the first with the opposite sign.
    pub(super) fn is_odd(&self) -> bool {
        self.harmonics.are_odd()
    }

    /// τ after which it repeats, with the opposite sign where it is odd.
    pub(super) fn span(&self) -> f64 {
        if self.is_odd() { PI } else { TAU }
    }

    /// The highest order.
    pub(super) fn highest(&self) -> f64 {
        self.harmonics.highest() as f64
    }

    /// Number of coefficients.
    pub(super) fn slots(&self) -> usize {
        self.harmonics.slots()
    }

    /// Factor of a mean that makes a coefficient of it: 2, and 1 for the constant term.
    pub(super) fn norm(&self, slot: usize) -> f64 {
        if slot == 0 && self.harmonics.has_constant() {
            1.0
        } else {
            2.0
        }
    }

    /// r by the values of the harmonics.
    pub(super) fn place(&self, waves: &[f64]) -> f64 {
        let products = self.coefficients.iter().zip(waves);
        products.map(|(coefficient, wave)| coefficient * wave).sum()
    }

    /// Values of the harmonics at τ, in the layout of the coefficients.
    pub(super) fn waves(&self, phase: f64, waves: &mut [f64]) {
        if self.harmonics.has_constant() {
            waves[0] = 1.0;
        }
        for (wave, (_, place)) in self.turning(phase).zip(self.harmonics.places()) {
            waves[place] = wave.re;
            waves[place + 1] = wave.im;
        }
    }

    /// e^{jhτ} of each harmonic, by repeated turns.
    fn turning(&self, phase: f64) -> impl Iterator<Item = Complex64> {
        let turn = Complex64::cis(phase);
        let (mut wave, mut last) = (Complex64::ONE, 0);
        self.harmonics.orders().iter().map(move |&order| {
            for _ in last..order {
                wave *= turn;
            }
            last = order;
            wave
        })
    }

    /// r and dr/dτ.
    pub(super) fn motion(&self, phase: f64) -> [f64; 2] {
        let constant = if self.harmonics.has_constant() {
            self.coefficients[0]
        } else {
            0.0
        };
        let mut motion = [constant, 0.0];
        for (wave, (order, place)) in self.turning(phase).zip(self.harmonics.places()) {
            let (a, b) = (self.coefficients[place], self.coefficients[place + 1]);
            motion[0] += a * wave.re + b * wave.im;
            motion[1] += order as f64 * (b * wave.re - a * wave.im);
        }
        motion
    }

    /// dr/dτ and d²r/dτ².
    fn rates(&self, phase: f64) -> [f64; 2] {
        let mut rates = [0.0; 2];
        for (wave, (order, place)) in self.turning(phase).zip(self.harmonics.places()) {
            let (a, b) = (self.coefficients[place], self.coefficients[place + 1]);
            let h = order as f64;
            rates[0] += h * (b * wave.re - a * wave.im);
            rates[1] -= h * h * (a * wave.re + b * wave.im);
        }
        rates
    }

    /// τ at which it turns, ascending from 0 to its span; none where it rests.
    pub(super) fn turns(&self) -> Vec<f64> {
        let moving = &self.coefficients[usize::from(self.harmonics.has_constant())..];
        if moving.iter().all(|&coefficient| coefficient == 0.0) {
            return Vec::new();
        }
        let parts = if self.is_odd() { 2 } else { 1 };
        let count = (SAMPLES * self.harmonics.highest()).max(FEWEST_SAMPLES) / parts;
        let phase = |n: usize| self.span() * n as f64 / count as f64;
        let mut rates: Vec<[f64; 2]> = (0..count).map(|n| self.rates(phase(n))).collect();
        let sign = if self.is_odd() { -1.0 } else { 1.0 };
        rates.push(rates[0].map(|rate| sign * rate));
        // the end is the begin, so that a turn just there is found once
        let mut are_up: Vec<bool> = rates.iter().map(|rate| is_up(rate[0])).collect();
        are_up[count] = are_up[0] != self.is_odd();
        let rate = |at: f64| self.rates(at)[0];
        let mut turns = Vec::new();
        for n in 0..count {
            let ([first, bend], [last, last_bend]) = (rates[n], rates[n + 1]);
            let (from, to) = (phase(n), phase(n + 1));
            if are_up[n] != are_up[n + 1] {
                turns.push(root(rate, [from, to], [first, last]));
            } else if first * bend < 0.0 && last * last_bend > 0.0 {
                // it slows down and speeds up again: it may turn twice between
                let slowest = root(|at| self.rates(at)[1], [from, to], [bend, last_bend]);
                let least = rate(slowest);
                if is_up(least) != are_up[n] {
                    turns.push(root(rate, [from, slowest], [first, least]));
                    turns.push(root(rate, [slowest, to], [least, last]));
                }
            }
        }
        turns
    }

    /// τ at which it passes this place on its way between two turns; `None` where it does not.
    pub(super) fn passes(&self, place: f64, between: [f64; 2], waves: &mut [f64]) -> Option<f64> {
        let mut away = |phase: f64| {
            self.waves(phase, waves);
            self.place(waves) - place
        };
        let ends = between.map(&mut away);
        (ends[0] * ends[1] < 0.0).then(|| root(away, between, ends))
    }
}

fn is_up(rate: f64) -> bool {
    rate > 0.0
}

/// Where a function changes its sign between two places at which it has these values: regula falsi with halved weights
/// ("Illinois").
fn root(mut of: impl FnMut(f64) -> f64, between: [f64; 2], values: [f64; 2]) -> f64 {
    let ([mut low, mut high], [mut at_low, mut at_high]) = (between, values);
    if at_low == 0.0 || at_high == 0.0 {
        return if at_low == 0.0 { low } else { high };
    }
    let within = f64::EPSILON * (high - low);
    let mut last_side = 0;
    for _ in 0..MOST_STEPS {
        if at_low == at_high {
            break;
        }
        let middle = (low * at_high - high * at_low) / (at_high - at_low);
        if !(middle - low > within && high - middle > within) {
            // nothing is left between
            return middle.clamp(low, high);
        }
        let value = of(middle);
        let side = if is_up(value) == is_up(at_high) {
            1
        } else {
            -1
        };
        if side > 0 {
            (high, at_high) = (middle, value);
            if last_side == side {
                at_low *= 0.5;
            }
        } else {
            (low, at_low) = (middle, value);
            if last_side == side {
                at_high *= 0.5;
            }
        }
        last_side = side;
        if value == 0.0 {
            return middle;
        }
    }
    0.5 * (low + high)
}
