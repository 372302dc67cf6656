//! Whether a periodic motion persists: Floquet's multipliers of a small deviation over one period.

use std::f64::consts::TAU;

use bolted_joint_dynamics::Body;
use nalgebra::{DMatrix, Schur};
use num_complex::Complex64;

use super::balance::HarmonicBalance;
use super::{HarmonicError, Solution};

/// Runge–Kutta steps of one radian of the fastest motion: the phase of a multiplier is then exact to
/// 2π · (1/24)⁴/120 = 1.6·10⁻⁷ for each of its periods.
const STEPS_PER_RADIAN: f64 = 24.0;
/// Multipliers beyond one by no more than what the integration adds count as on the unit circle.
const ON_THE_CIRCLE: f64 = 1e-9;
/// Iterations for all eigenvalues of a matrix of at most eight rows.
const MOST_ITERATIONS: usize = 1000;

/// Floquet multipliers of a periodic motion.
#[derive(Clone, Debug, PartialEq)]
pub struct Stability {
    /// By modulus, the largest first.
    pub multipliers: Vec<Complex64>,
}

impl Stability {
    /// Whether every small deviation dies out, or at least does not grow.
    #[must_use]
    pub fn is_stable(&self) -> bool {
        self.multipliers
            .iter()
            .all(|multiplier| multiplier.norm() <= 1.0 + ON_THE_CIRCLE)
    }
}

/// Deviations of the bodies: displacements and their rates over τ = ωt, one row a deviation.
#[derive(Clone, Copy)]
struct Deviation<const D: usize> {
    x: [[f64; D]; 2],
    rate: [[f64; D]; 2],
}

/// The equations of small deviations about a motion, over τ.
struct Linearised<'a, const D: usize> {
    bodies: [&'a Body<D>; 2],
    joint_stiffness: &'a [[f64; D]; D],
    joint_damping: &'a [[f64; D]; D],
    omega: f64,
}

impl<const D: usize> HarmonicBalance<D> {
    /// Floquet multipliers of a solution: eigenvalues of what one period makes of small deviations, by RK4.
    ///
    /// # Errors
    /// [`HarmonicError::Multipliers`] if they are not finite.
    pub fn stability(&self, solution: &Solution<D>) -> Result<Stability, HarmonicError> {
        if self.slipping.is_some() {
            return Err(HarmonicError::SlippingStability);
        }
        let refuse = || HarmonicError::Multipliers {
            frequency_hz: solution.frequency_hz(),
        };
        let omega = solution.at.omega;
        let fastest = self.fastest(solution);
        let steps = (TAU * STEPS_PER_RADIAN * (fastest / omega).max(1.0)).ceil();
        if steps.is_nan() || steps >= 1e7 {
            return Err(refuse());
        }
        let steps = steps as usize;
        let tangents = self.tangents(solution, 2 * steps);
        let equations = Linearised {
            bodies: [&self.lap.a, &self.lap.b],
            joint_stiffness: &self.lap.joint.linear.stiffness,
            joint_damping: &self.lap.joint.linear.damping,
            omega,
        };
        let mut deviations = Deviation::units();
        let step = TAU / steps as f64;
        for n in 0..steps {
            let tangents = [2 * n, 2 * n + 1, 2 * n + 2].map(|at| &tangents[at % (2 * steps)]);
            for deviation in &mut deviations {
                *deviation = equations.step(deviation, tangents, step);
            }
        }
        let size = 4 * D;
        let monodromy = DMatrix::from_fn(size, size, |row, column| deviations[column].entry(row));
        if monodromy.iter().any(|entry| !entry.is_finite()) {
            return Err(refuse());
        }
        let schur = Schur::try_new(monodromy, f64::EPSILON, MOST_ITERATIONS).ok_or_else(refuse)?;
        let mut multipliers: Vec<Complex64> = schur.complex_eigenvalues().iter().copied().collect();
        multipliers.sort_by(|one, other| other.norm().total_cmp(&one.norm()));
        Ok(Stability { multipliers })
    }

    /// ∂f/∂r and ∂f/∂ṙ of each DOF at so many moments of the period.
    fn tangents(&self, solution: &Solution<D>, count: usize) -> Vec<[[f64; D]; 2]> {
        let slots = self.harmonics.slots();
        let mut tangents = vec![[[0.0; D]; 2]; count];
        for (n, tangent) in tangents.iter_mut().enumerate() {
            let phase = TAU * n as f64 / count as f64;
            let turn = Complex64::cis(phase);
            let mut r = [0.0; D];
            let mut rate = [0.0; D];
            if self.harmonics.has_constant() {
                for dof in 0..D {
                    r[dof] = solution.coefficients[dof * slots];
                }
            }
            // e^{jhτ} by repeated turns
            let (mut wave, mut last) = (Complex64::ONE, 0);
            for (order, place) in self.harmonics.places() {
                for _ in last..order {
                    wave *= turn;
                }
                last = order;
                for dof in 0..D {
                    let at = dof * slots + place;
                    let (a, b) = (solution.coefficients[at], solution.coefficients[at + 1]);
                    r[dof] += a * wave.re + b * wave.im;
                    rate[dof] += order as f64 * (b * wave.re - a * wave.im);
                }
            }
            for dof in 0..D {
                let here = self.terms[dof].tangent(r[dof], solution.at.omega * rate[dof]);
                tangent[0][dof] = here.stiffness;
                tangent[1][dof] = here.damping;
            }
        }
        tangents
    }

    /// No motion is faster than this, rad/s: a bound of the eigenvalues by row sums, of the joint at its stiffest.
    fn fastest(&self, solution: &Solution<D>) -> f64 {
        let tangents = self.tangents(solution, 4 * self.harmonics.highest() + 4);
        let stiffest: [f64; D] = std::array::from_fn(|dof| {
            tangents
                .iter()
                .fold(0.0, |most: f64, at| most.max(at[0][dof].abs()))
        });
        let bodies = [&self.lap.a, &self.lap.b];
        let mut most: f64 = 0.0;
        for row in &bodies {
            for i in 0..D {
                let mut sum = row.stiffness[i].abs() / row.inertia[i];
                for column in &bodies {
                    for j in 0..D {
                        let mut entry = self.lap.joint.linear.stiffness[i][j].abs();
                        if i == j {
                            entry += stiffest[i];
                        }
                        sum += entry / (row.inertia[i] * column.inertia[j]).sqrt();
                    }
                }
                most = most.max(sum);
            }
        }
        most.sqrt()
    }
}

impl<const D: usize> Deviation<D> {
    const NONE: Self = Self {
        x: [[0.0; D]; 2],
        rate: [[0.0; D]; 2],
    };

    /// One deviation for each state.
    fn units() -> Vec<Self> {
        (0..4 * D)
            .map(|n| {
                let mut unit = Self::NONE;
                let (side, dof) = (n / D % 2, n % D);
                if n < 2 * D {
                    unit.x[side][dof] = 1.0;
                } else {
                    unit.rate[side][dof] = 1.0;
                }
                unit
            })
            .collect()
    }

    fn entry(&self, n: usize) -> f64 {
        let (side, dof) = (n / D % 2, n % D);
        if n < 2 * D {
            self.x[side][dof]
        } else {
            self.rate[side][dof]
        }
    }

    /// `self + factor · by`
    fn moved(&self, factor: f64, by: &Self) -> Self {
        let sum = |one: &[[f64; D]; 2], other: &[[f64; D]; 2]| {
            std::array::from_fn(|side| {
                std::array::from_fn(|dof| one[side][dof] + factor * other[side][dof])
            })
        };
        Self {
            x: sum(&self.x, &by.x),
            rate: sum(&self.rate, &by.rate),
        }
    }
}

impl<const D: usize> Linearised<'_, D> {
    /// x'' = −M⁻¹ (K x + …)/ω² − M⁻¹ (C x' + …)/ω, the joint's tangent added to its K and C
    fn rate(&self, deviation: &Deviation<D>, [stiffness, damping]: &[[f64; D]; 2]) -> Deviation<D> {
        let (x, rate) = (&deviation.x, &deviation.rate);
        let by_stiffness = 1.0 / (self.omega * self.omega);
        let by_damping = 1.0 / self.omega;
        let mut second = [[0.0; D]; 2];
        for i in 0..D {
            let mut joint = by_stiffness * stiffness[i] * (x[0][i] - x[1][i])
                + by_damping * damping[i] * (rate[0][i] - rate[1][i]);
            for j in 0..D {
                joint += by_stiffness * self.joint_stiffness[i][j] * (x[0][j] - x[1][j])
                    + by_damping * self.joint_damping[i][j] * (rate[0][j] - rate[1][j]);
            }
            for (side, sign) in [(0, 1.0), (1, -1.0)] {
                let body = self.bodies[side];
                let own = by_stiffness * body.stiffness[i] * x[side][i]
                    + by_damping * body.damping[i] * rate[side][i];
                second[side][i] = -(own + sign * joint) / body.inertia[i];
            }
        }
        Deviation {
            x: *rate,
            rate: second,
        }
    }

    fn step(
        &self,
        start: &Deviation<D>,
        [first, middle, last]: [&[[f64; D]; 2]; 3],
        step: f64,
    ) -> Deviation<D> {
        let one = self.rate(start, first);
        let two = self.rate(&start.moved(0.5 * step, &one), middle);
        let three = self.rate(&start.moved(0.5 * step, &two), middle);
        let four = self.rate(&start.moved(step, &three), last);
        start
            .moved(step / 6.0, &one)
            .moved(step / 3.0, &two)
            .moved(step / 3.0, &three)
            .moved(step / 6.0, &four)
    }
}
