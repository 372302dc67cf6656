//! How an assembly with nonlinear joints vibrates: harmonic balance on the joints alone, whatever the structures are.
//!
//! * Forced: the response to loads of one frequency, followed through folds.
//! * Free: a nonlinear mode from small to large amplitudes, with its frequency and damping ratio (extended periodic motion:
//!   M. Krack, Comput. Struct. 154 (2015) 59).

mod condensed;
mod follow;
mod forced;
mod free;
mod grown;
mod sampling;

use std::f64::consts::TAU;

use nalgebra::{DMatrix, DVector};
use num_complex::Complex64;

use crate::error::AssemblyError;
use crate::model::AssemblyModel;
use crate::reached::Reached;
use condensed::{At, Condensed, Dynamic};
use follow::{Lost, follow, point};
use forced::Forced;
use free::Free;
use grown::Grown;
use sampling::{Forces, Sampling};

/// Part of the frequency by which it is varied for the derivatives of what is linear.
const VARIED: f64 = 1e-6;
/// Part of the frequency that counts as much as the whole motion.
const OF_FREQUENCY: f64 = 0.02;
/// A damping ratio that counts as much, and a change of the amplitude's logarithm.
const OF_RATIO: f64 = 0.01;
const OF_LOGARITHM: f64 = 1.0;
/// Inverse iterations for the shape of a mode.
const ITERATIONS: usize = 8;

/// A point of a forced response.
#[derive(Clone, Debug, PartialEq)]
pub struct ForcedPoint {
    /// Hz.
    pub frequency_hz: f64,
    /// Fundamental of each output: it moves as Re(y e^{jωt}); m, rad.
    pub fundamental: Vec<Complex64>,
    /// Largest displacement of each output over a period; m, rad.
    pub largest: Vec<f64>,
}

/// A point of a nonlinear mode.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FreePoint {
    /// Amplitude of the output's fundamental; m, rad.
    pub amplitude: f64,
    /// Hz.
    pub frequency_hz: f64,
    /// Damping ratio ζ of the force 2ζω M q̇ that would keep the motion up.
    pub damping_ratio: f64,
}

impl AssemblyModel {
    /// The response to loads u(t) = Re(u e^{jωt}) (N, N·m, one for each input) from one frequency (Hz) to another, with odd
    /// harmonics up to the highest; and how far the joints that have laws move on the way.
    ///
    /// # Errors
    /// [`AssemblyError::NotBalanced`] where no solution is found, [`AssemblyError::CurveStuck`] and [`AssemblyError::CurveTooLong`]
    /// where the curve does not come to its end, [`AssemblyError::Law`] where a joint gives no law.
    pub fn forced_response(
        &self,
        loads: &[Complex64],
        [from_hz, to_hz]: [f64; 2],
        highest_harmonic: usize,
        progress: &dyn Fn(f64),
    ) -> Result<(Vec<ForcedPoint>, Reached), AssemblyError> {
        let problem = Problem::of(self, highest_harmonic)?;
        let forced = Forced {
            loads: DVector::from_row_slice(loads),
            problem: &problem,
        };
        let omega = TAU * from_hz;
        let start = forced
            .in_parts(omega)
            .or_else(|| Grown::new(&forced, omega).to_full_load(&|| progress(0.0)));
        let start = start.ok_or_else(|| not_balanced(from_hz))?;
        let found = follow(&forced, start, problem.size(), TAU * to_hz, progress);
        let points = found.map_err(|lost| no_farther(&lost, problem.size()))?;
        let all = points.iter().map(|unknowns| forced.outputs(unknowns));
        let all = all.collect::<Option<_>>();
        let all = all.ok_or_else(|| not_balanced(to_hz))?;
        Ok((all, problem.reached(&points)))
    }

    /// The nonlinear mode that begins as the linear one of this number (from 0, of those that oscillate, ascending), from one
    /// amplitude of an output's fundamental to another (m, rad); and how far the joints that have laws move on the way.
    ///
    /// # Errors
    /// As [`AssemblyModel::forced_response`]; [`AssemblyError::NoMode`] where there is no such mode.
    pub fn nonlinear_mode(
        &self,
        mode: usize,
        output: usize,
        [from, to]: [f64; 2],
        highest_harmonic: usize,
        progress: &dyn Fn(f64),
    ) -> Result<(Vec<FreePoint>, Reached), AssemblyError> {
        let problem = Problem::of(self, highest_harmonic)?;
        let modes = self.modes()?;
        let oscillating = modes
            .iter()
            .filter(|own| own.frequency_hz > 0.0 && own.damping_ratio.abs() < 1.0);
        let found = oscillating.clone().count();
        let linear = oscillating.clone().nth(mode).ok_or(AssemblyError::NoMode {
            mode: mode + 1,
            found,
        })?;
        let free = Free {
            problem: &problem,
            output,
        };
        let size = problem.size();
        let mut start = DVector::zeros(size + 3);
        start[size] = TAU * linear.frequency_hz;
        start[size + 1] = linear.damping_ratio;
        start[size + 2] = from.ln();
        free.shape(&mut start)
            .ok_or_else(|| not_balanced(linear.frequency_hz))?;
        let start =
            point(&free, &start, size + 2).ok_or_else(|| not_balanced(linear.frequency_hz))?;
        let found = follow(&free, start, size + 2, to.ln(), progress);
        let points = found.map_err(|lost| no_farther(&lost, size))?;
        let point = |own: &DVector<f64>| FreePoint {
            amplitude: own[size + 2].exp(),
            frequency_hz: own[size] / TAU,
            damping_ratio: own[size + 1],
        };
        Ok((points.iter().map(point).collect(), problem.reached(&points)))
    }
}

fn not_balanced(frequency_hz: f64) -> AssemblyError {
    AssemblyError::NotBalanced { frequency_hz }
}

/// Why a curve with its frequency at this place does not come to its end.
fn no_farther(lost: &Lost, place: usize) -> AssemblyError {
    let (frequency_hz, points) = (lost.last[place] / TAU, lost.points);
    match lost.is_too_long {
        true => AssemblyError::CurveTooLong {
            frequency_hz,
            points,
        },
        false => AssemblyError::CurveStuck {
            frequency_hz,
            points,
        },
    }
}

/// What is balanced.
struct Problem<'m> {
    condensed: Condensed<'m>,
    /// Of each DOF that has laws.
    forces: Vec<Forces>,
    sampling: Sampling,
}

/// What is linear at all harmonics.
struct Linear {
    at: Vec<Dynamic>,
}

/// What a motion leaves.
struct Balance {
    /// Z r + f − p.
    residual: DVector<f64>,
    /// Its derivatives by the motion and ω.
    derivatives: DMatrix<f64>,
    /// f, as the motion stands.
    forces: Vec<f64>,
}

impl<'m> Problem<'m> {
    fn of(model: &'m AssemblyModel, highest_harmonic: usize) -> Result<Self, AssemblyError> {
        let condensed = Condensed::of(model)?;
        if condensed.laws.is_empty() {
            return Err(AssemblyError::NothingNonlinear);
        }
        let forces = condensed.laws.iter().map(|(_, laws)| Forces::of(laws));
        Ok(Self {
            forces: forces.collect(),
            condensed,
            sampling: Sampling::new(highest_harmonic)?,
        })
    }

    /// Number of unknowns of the motion: DOF by DOF those of each harmonic.
    fn size(&self) -> usize {
        self.condensed.laws.len() * self.sampling.size()
    }

    fn linear(&self, omega: f64, ratio: f64, loads: &DVector<Complex64>) -> Option<Linear> {
        let none = DVector::zeros(loads.len());
        let orders = self.sampling.orders().iter();
        let all = orders.map(|&order| {
            let at = At {
                frequency_rad_per_s: order as f64 * omega,
                released_per_s: 2.0 * ratio * omega,
            };
            self.condensed
                .at(at, if order == 1 { loads } else { &none })
        });
        Some(Linear {
            at: all.collect::<Option<_>>()?,
        })
    }

    /// Place of the cosine of a DOF at a harmonic; the sine is behind it.
    fn place(&self, dof: usize, harmonic: usize) -> usize {
        dof * self.sampling.size() + 2 * harmonic
    }

    /// a − jb
    fn phasor(&self, coefficients: &[f64], dof: usize, harmonic: usize) -> Complex64 {
        let place = self.place(dof, harmonic);
        Complex64::new(coefficients[place], -coefficients[place + 1])
    }

    /// Z r − p of all harmonics as numbers.
    fn residual(&self, linear: &Linear, motion: &[f64]) -> DVector<f64> {
        let mut residual = DVector::zeros(self.size());
        for (harmonic, own) in linear.at.iter().enumerate() {
            for i in 0..self.condensed.laws.len() {
                let terms = (0..self.condensed.laws.len())
                    .map(|j| own.stiffness[(i, j)] * self.phasor(motion, j, harmonic));
                let value = terms.fold(-own.load[i], |sum, term| sum + term);
                let place = self.place(i, harmonic);
                residual[place] = value.re;
                residual[place + 1] = -value.im;
            }
        }
        residual
    }

    /// Derivative of [`Problem::residual`] by what is `change` more in `next`.
    fn by_change(&self, [linear, next]: [&Linear; 2], motion: &[f64], change: f64) -> DVector<f64> {
        (self.residual(next, motion) - self.residual(linear, motion)) / change
    }

    /// The balance of what is linear at ω (rad/s) with the laws' forces. The last column of its derivatives has those of these forces
    /// alone.
    fn balance(&self, linear: &Linear, motion: &[f64], omega: f64) -> Balance {
        let size = self.size();
        let mut residual = self.residual(linear, motion);
        let mut derivatives = DMatrix::zeros(size, size + 1);
        for (harmonic, own) in linear.at.iter().enumerate() {
            for i in 0..self.condensed.laws.len() {
                for j in 0..self.condensed.laws.len() {
                    let z = own.stiffness[(i, j)];
                    let (row, column) = (self.place(i, harmonic), self.place(j, harmonic));
                    // Z (a − jb), its real part and less its imaginary part
                    derivatives[(row, column)] += z.re;
                    derivatives[(row, column + 1)] += z.im;
                    derivatives[(row + 1, column)] -= z.im;
                    derivatives[(row + 1, column + 1)] += z.re;
                }
            }
        }
        let per_dof = self.sampling.size();
        let mut forces = vec![0.0; size];
        for (dof, laws) in self.forces.iter().enumerate() {
            let own = dof * per_dof..(dof + 1) * per_dof;
            let force = self.sampling.force(laws, &motion[own.clone()], omega);
            for (i, place) in own.clone().enumerate() {
                residual[place] += force.coefficients[i];
                forces[place] = force.coefficients[i];
                derivatives[(place, size)] += force.by_frequency[i];
                for (j, column) in own.clone().enumerate() {
                    derivatives[(place, column)] += force.by_motion[(i, j)];
                }
            }
        }
        Balance {
            residual,
            derivatives,
            forces,
        }
    }

    /// Motion of the outputs at a harmonic.
    fn outputs(&self, linear: &Linear, forces: &[f64], harmonic: usize) -> DVector<Complex64> {
        let count = self.condensed.laws.len();
        let own = DVector::from_fn(count, |dof, _| self.phasor(forces, dof, harmonic));
        linear.at[harmonic].outputs(&own)
    }

    /// How far the joints' DOFs that have laws move at points of a curve.
    fn reached(&self, points: &[DVector<f64>]) -> Reached {
        let size = self.sampling.size();
        let mut reached = Reached::default();
        for point in points {
            let of_dofs = point.as_slice().chunks_exact(size);
            for ((place, _), motion) in self.condensed.laws.iter().zip(of_dofs) {
                reached.include(*place, self.sampling.largest(motion));
            }
        }
        reached
    }

    /// The largest of the motion's coefficients.
    fn amplitude(&self, unknowns: &DVector<f64>) -> f64 {
        let own = unknowns.rows(0, self.size()).amax();
        if own > 0.0 {
            own
        } else {
            f64::MIN_POSITIVE.sqrt()
        }
    }
}

#[cfg(test)]
mod tests;
