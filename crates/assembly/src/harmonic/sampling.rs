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
/// Steps of Newton's method from the largest sample to what is largest.
const NEWTON_STEPS: usize = 4;
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
        // value, slope and curvature
        let at = |angle: f64| {
            let pairs = self.orders.iter().zip(coefficients.chunks_exact(2));
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
        let count = SAMPLES_A_HARMONIC * (self.orders.len() * 2 + 1);
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

    /// That of laws that remember.
    fn friction(&self, laws: &DofLaws, motion: &[f64], omega: f64) -> Force {
        let size = self.size();
        let along = DofLaws::new(laws.parameters().map(Dual::<1>::from));
        // along each of the motion's coefficients, and then along ω
        let columns: Vec<Vec<Dual<1>>> = (0..=size)
            .map(|column| {
                let change = |sample: usize| match column == size {
                    true => [0.0, self.at(&self.slopes, motion, sample)],
                    false => [
                        self.waves[(sample, column)],
                        omega * self.slopes[(sample, column)],
                    ],
                };
                self.followed(&along, motion, omega, change)
            })
            .collect();
        let value = |i: usize| columns[size][i].value;
        Force {
            coefficients: (0..size).map(value).collect(),
            by_motion: DMatrix::from_fn(size, size, |i, j| columns[j][i].change[0]),
            by_frequency: columns[size].iter().map(|own| own.change[0]).collect(),
        }
    }

    /// Coefficients of the force once what the laws remember repeats itself, with their change along that of r and ṙ.
    fn followed(
        &self,
        laws: &DofLaws<Dual<1>>,
        motion: &[f64],
        omega: f64,
        change: impl Fn(usize) -> [f64; 2],
    ) -> Vec<Dual<1>> {
        let mut memory: DofMemory<Dual<1>> = DOF_AT_REST.map(Dual::from);
        let mut coefficients = vec![Dual::from(0.0); self.size()];
        // a period leads onto the loop
        for is_counted in [false, true] {
            for sample in 0..self.waves.nrows() {
                let [r_change, v_change] = change(sample);
                let r = Dual::new(self.at(&self.waves, motion, sample), [r_change]);
                let slope = self.at(&self.slopes, motion, sample);
                let v = Dual::new(omega * slope, [v_change]);
                let f = laws.load(&memory, r, v);
                laws.commit(&mut memory, r, v);
                if is_counted {
                    for (i, own) in coefficients.iter_mut().enumerate() {
                        let weight = Dual::from(self.weight() * self.waves[(sample, i)]);
                        *own = *own + weight * f;
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

#[cfg(test)]
mod tests {
    use bolted_joint_dynamics::law::{DOF_PARAMETER_COUNT, dof_parameters};

    use super::*;

    fn slider(stiffness: f64, slip_force: f64) -> DofLaws {
        let mut parameters = [0.0; DOF_PARAMETER_COUNT];
        for (own, (law, parameter)) in parameters.iter_mut().zip(dof_parameters()) {
            if law.name == "jenkins" && law.number == 1 {
                *own = match parameter.key {
                    "stiffness" => stiffness,
                    _ => slip_force,
                };
            }
        }
        DofLaws::new(parameters)
    }

    /// Where no sample is at a corner, central differences.
    #[test]
    fn friction_s_derivatives_are_those_of_its_coefficients() {
        let sampling = Sampling::new(3, true);
        let laws = slider(2e6, 60.0);
        let motion = [1.1e-4, -2.3e-5, 4.1e-6, 3.3e-6];
        let exact = sampling.force(&laws, &motion, 700.0);
        for column in 0..motion.len() {
            let part = 1e-11;
            let at = |change: f64| {
                let mut own = motion;
                own[column] += change;
                sampling.force(&laws, &own, 700.0).coefficients
            };
            let (above, below) = (at(part), at(-part));
            for i in 0..motion.len() {
                let expected = (above[i] - below[i]) / (2.0 * part);
                let found = exact.by_motion[(i, column)];
                assert!(
                    (found - expected).abs() < 2e-3 * 2e6,
                    "{i} {column}: {found} {expected}"
                );
            }
        }
    }
}
