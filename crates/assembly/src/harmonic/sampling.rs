//! The force of a joint's laws on one degree of freedom over a period of its motion, by alternating frequency and time.
//!
//! T. M. Cameron, J. H. Griffin, J. Appl. Mech. 56 (1989) 149. All laws are odd, f(−r, −ṙ) = −f(r, ṙ), so that odd harmonics are
//! balanced among themselves. With τ = ωt the motion is r = Σ aₖ cos kτ + bₖ sin kτ.

use std::f64::consts::TAU;

use bolted_joint_dynamics::law::{DOF_AT_REST, DofLaws};
use bolted_joint_dynamics::{DofMemory, Dual};
use nalgebra::DMatrix;

/// Samples for each harmonic: those of a force of ninth degree alias only into what is not balanced.
const SAMPLES_A_HARMONIC: usize = 12;
/// Samples of a law that remembers: its corners leave an error of the square of their distance.
const SAMPLES_OF_FRICTION: usize = 2048;
/// Part of the motion by which it is varied for the derivatives of laws that remember.
const VARIED: f64 = 1e-6;

/// The harmonics that are balanced, with cosines and sines of a period.
#[derive(Clone, Debug)]
pub(super) struct Sampling {
    /// 1, 3, 5 …
    pub(super) orders: Vec<usize>,
    /// Columns cos kτ, sin kτ of each order, a row for each sample.
    waves: DMatrix<f64>,
    /// Their derivatives with respect to τ.
    slopes: DMatrix<f64>,
}

/// Coefficients of the force, and their derivatives.
#[derive(Clone, Debug)]
pub(super) struct Force {
    /// aₖ and bₖ of each order.
    pub(super) coefficients: Vec<f64>,
    /// With respect to those of the motion.
    pub(super) by_motion: DMatrix<f64>,
    /// With respect to ω, s.
    pub(super) by_frequency: Vec<f64>,
}

impl Sampling {
    /// Odd harmonics up to `highest`, for laws that remember or for others.
    pub(super) fn new(highest: usize, remembers: bool) -> Self {
        let orders: Vec<usize> = (1..=highest).step_by(2).collect();
        let count = match remembers {
            true => SAMPLES_OF_FRICTION,
            false => SAMPLES_A_HARMONIC * (highest + 1),
        };
        let angle =
            |sample: usize, order: usize| TAU * ((sample * order) % count) as f64 / count as f64;
        let wave = |sample: usize, column: usize| {
            let (sine, cosine) = angle(sample, orders[column / 2]).sin_cos();
            if column % 2 == 0 { cosine } else { sine }
        };
        let slope = |sample: usize, column: usize| {
            let order = orders[column / 2];
            let (sine, cosine) = angle(sample, order).sin_cos();
            order as f64 * if column % 2 == 0 { -sine } else { cosine }
        };
        Self {
            waves: DMatrix::from_fn(count, 2 * orders.len(), wave),
            slopes: DMatrix::from_fn(count, 2 * orders.len(), slope),
            orders,
        }
    }

    /// Unknowns of one degree of freedom.
    pub(super) fn size(&self) -> usize {
        2 * self.orders.len()
    }

    /// The largest magnitude over a period of what has these coefficients.
    pub(super) fn largest(&self, coefficients: &[f64]) -> f64 {
        let samples =
            (0..self.waves.nrows()).map(|sample| self.at(&self.waves, coefficients, sample).abs());
        samples.fold(0.0, f64::max)
    }

    /// The force of these laws at this motion of the frequency ω (rad/s).
    pub(super) fn force(&self, laws: &DofLaws, motion: &[f64], omega: f64) -> Force {
        if laws.have_memory() {
            return self.friction(laws, motion, omega);
        }
        let along = DofLaws::new(laws.parameters().map(Dual::<2>::from));
        let size = self.size();
        let mut force = Force {
            coefficients: vec![0.0; size],
            by_motion: DMatrix::zeros(size, size),
            by_frequency: vec![0.0; size],
        };
        for sample in 0..self.waves.nrows() {
            let r = self.at(&self.waves, motion, sample);
            let slope = self.at(&self.slopes, motion, sample);
            let f = along.load(
                &DOF_AT_REST,
                Dual::along(r, 0),
                Dual::along(omega * slope, 1),
            );
            let [by_r, by_v] = f.change;
            for i in 0..size {
                let weight = self.weight() * self.waves[(sample, i)];
                force.coefficients[i] += weight * f.value;
                force.by_frequency[i] += weight * by_v * slope;
                for j in 0..size {
                    let change =
                        by_r * self.waves[(sample, j)] + by_v * omega * self.slopes[(sample, j)];
                    force.by_motion[(i, j)] += weight * change;
                }
            }
        }
        force
    }

    /// That of laws that remember, with derivatives by differences.
    fn friction(&self, laws: &DofLaws, motion: &[f64], omega: f64) -> Force {
        let size = self.size();
        let coefficients = self.followed(laws, motion, omega);
        let largest = motion
            .iter()
            .fold(0.0, |largest: f64, own| largest.max(own.abs()));
        let step = if largest > 0.0 {
            VARIED * largest
        } else {
            f64::EPSILON
        };
        let mut by_motion = DMatrix::zeros(size, size);
        let mut varied = motion.to_vec();
        for j in 0..size {
            varied[j] = motion[j] + step;
            let own = self.followed(laws, &varied, omega);
            for i in 0..size {
                by_motion[(i, j)] = (own[i] - coefficients[i]) / step;
            }
            varied[j] = motion[j];
        }
        let change = VARIED * omega;
        let own = self.followed(laws, motion, omega + change);
        let by_frequency = own
            .iter()
            .zip(&coefficients)
            .map(|(own, was)| (own - was) / change);
        Force {
            by_frequency: by_frequency.collect(),
            coefficients,
            by_motion,
        }
    }

    /// Coefficients of the force once what the laws remember repeats itself.
    fn followed(&self, laws: &DofLaws, motion: &[f64], omega: f64) -> Vec<f64> {
        let mut memory: DofMemory = DOF_AT_REST;
        let mut coefficients = vec![0.0; self.size()];
        // a period leads onto the loop
        for is_counted in [false, true] {
            for sample in 0..self.waves.nrows() {
                let r = self.at(&self.waves, motion, sample);
                let v = omega * self.at(&self.slopes, motion, sample);
                let f = laws.load(&memory, r, v);
                laws.commit(&mut memory, r, v);
                if is_counted {
                    for (i, own) in coefficients.iter_mut().enumerate() {
                        *own += self.weight() * self.waves[(sample, i)] * f;
                    }
                }
            }
        }
        coefficients
    }

    fn weight(&self) -> f64 {
        2.0 / self.waves.nrows() as f64
    }

    fn at(&self, waves: &DMatrix<f64>, coefficients: &[f64], sample: usize) -> f64 {
        let pairs = waves.row(sample);
        pairs
            .iter()
            .zip(coefficients)
            .map(|(wave, own)| wave * own)
            .sum()
    }
}
