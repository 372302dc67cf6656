//! The force of a joint's laws on one degree of freedom over a period of its motion.
//!
//! That of laws which remember nothing is sampled (alternating frequency and time: T. M. Cameron, J. H. Griffin, J. Appl. Mech. 56
//! (1989) 149), that of the others integrated from turn to turn ([`Remembering`]). All laws are odd, f(−r, −ṙ) = −f(r, ṙ), so that
//! odd harmonics are balanced among themselves. With τ = ωt the motion is r = Σ aₖ cos kτ + bₖ sin kτ.

use std::f64::consts::TAU;

use bolted_joint_dynamics::Dual;
use bolted_joint_dynamics::law::{DOF_AT_REST, DofLaws, FORGETFUL_PARAMETER_COUNT};
use bolted_joint_harmonic::{HarmonicError, Harmonics, Remembering};
use nalgebra::DMatrix;

/// Samples for each harmonic: those of a force of ninth degree alias only into what is not balanced.
const SAMPLES_A_HARMONIC: usize = 12;
/// Steps of Newton's method from the largest sample to what is largest.
const NEWTON_STEPS: usize = 4;

/// The harmonics that are balanced, with cosines and sines of a period.
#[derive(Clone, Debug)]
pub(super) struct Sampling {
    harmonics: Harmonics,
    /// Columns cos kτ, sin kτ of each order, a row for each sample.
    waves: DMatrix<f64>,
    /// Their derivatives with respect to τ.
    slopes: DMatrix<f64>,
}

/// The laws on one degree of freedom, by what they remember.
#[derive(Clone, Debug)]
pub(super) struct Forces {
    forgetful: Option<DofLaws<Dual<2>>>,
    remembering: Option<Remembering>,
}

impl Forces {
    pub(super) fn of(laws: &DofLaws) -> Self {
        let mut parameters = laws.parameters().map(Dual::from);
        parameters[FORGETFUL_PARAMETER_COUNT..].fill(Dual::from(0.0));
        let forgetful = DofLaws::new(parameters);
        Self {
            forgetful: (!forgetful.are_none()).then_some(forgetful),
            remembering: Remembering::of(laws),
        }
    }
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
    /// Odd harmonics up to `highest`.
    ///
    /// # Errors
    /// [`HarmonicError::Harmonics`] if that is none, or more than make sense.
    pub(super) fn new(highest: usize) -> Result<Self, HarmonicError> {
        let harmonics = Harmonics::odd(highest)?;
        let orders = harmonics.orders();
        let count = SAMPLES_A_HARMONIC * (highest + 1);
        let angle =
            |sample: usize, order: usize| TAU * ((sample * order) % count) as f64 / count as f64;
        let wave = |sample: usize, column: usize| {
            let (sine, cosine) = angle(sample, orders[column / 2]).sin_cos();
            if column.is_multiple_of(2) {
                cosine
            } else {
                sine
            }
        };
        let slope = |sample: usize, column: usize| {
            let order = orders[column / 2];
            let (sine, cosine) = angle(sample, order).sin_cos();
            order as f64
                * if column.is_multiple_of(2) {
                    -sine
                } else {
                    cosine
                }
        };
        Ok(Self {
            waves: DMatrix::from_fn(count, 2 * orders.len(), wave),
            slopes: DMatrix::from_fn(count, 2 * orders.len(), slope),
            harmonics,
        })
    }

    /// 1, 3, 5 …
    pub(super) fn orders(&self) -> &[usize] {
        self.harmonics.orders()
    }

    /// Unknowns of one degree of freedom.
    pub(super) fn size(&self) -> usize {
        2 * self.orders().len()
    }

    /// The largest magnitude over a period of what has these coefficients.
    pub(super) fn largest(&self, coefficients: &[f64]) -> f64 {
        // value, slope and curvature
        let at = |angle: f64| {
            let pairs = self.orders().iter().zip(coefficients.chunks_exact(2));
            pairs.fold([0.0; 3], |[value, slope, curvature], (&order, own)| {
                let k = order as f64;
                let (sine, cosine) = (k * angle).sin_cos();
                let wave = own[0] * cosine + own[1] * sine;
                [
                    value + wave,
                    slope + k * (own[1] * cosine - own[0] * sine),
                    curvature - k * k * wave,
                ]
            })
        };
        let count = SAMPLES_A_HARMONIC * (self.orders().len() * 2 + 1);
        let spacing = TAU / count as f64;
        // half a period is enough of odd harmonics
        let angles = (0..=count / 2).map(|sample| spacing * sample as f64);
        let nearest = angles.max_by(|&one, &other| at(one)[0].abs().total_cmp(&at(other)[0].abs()));
        let mut angle = nearest.unwrap_or_default();
        for _ in 0..NEWTON_STEPS {
            let [_, slope, curvature] = at(angle);
            if curvature != 0.0 {
                angle -= (slope / curvature).clamp(-spacing, spacing);
            }
        }
        let found = at(angle)[0].abs();
        nearest.map_or(found, |nearest| found.max(at(nearest)[0].abs()))
    }

    /// The force of these laws at this motion of the frequency ω (rad/s).
    pub(super) fn force(&self, laws: &Forces, motion: &[f64], omega: f64) -> Force {
        let size = self.size();
        let mut force = Force {
            coefficients: vec![0.0; size],
            by_motion: DMatrix::zeros(size, size),
            by_frequency: vec![0.0; size],
        };
        if let Some(laws) = &laws.forgetful {
            self.sample(laws, motion, omega, &mut force);
        }
        if let Some(laws) = &laws.remembering {
            // places alone matter: the frequency changes nothing
            laws.add_harmonics(
                &self.harmonics,
                motion,
                &mut force.coefficients,
                &mut force.by_motion,
            );
        }
        force
    }

    /// Adds that of laws that remember nothing.
    fn sample(&self, laws: &DofLaws<Dual<2>>, motion: &[f64], omega: f64, force: &mut Force) {
        let size = self.size();
        for sample in 0..self.waves.nrows() {
            let r = self.at(&self.waves, motion, sample);
            let slope = self.at(&self.slopes, motion, sample);
            let f = laws.load(
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
