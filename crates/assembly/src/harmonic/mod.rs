//! How an assembly with nonlinear joints vibrates: harmonic balance on the joints alone, whatever the structures are.
//!
//! * Forced: the response to loads of one frequency, followed through folds.
//! * Free: a nonlinear mode from small to large amplitudes, with its frequency and damping ratio (extended periodic motion:
//!   M. Krack, Comput. Struct. 154 (2015) 59).

mod condensed;
mod follow;
mod sampling;

use std::f64::consts::TAU;

use bolted_joint_dynamics::Dual;
use bolted_joint_dynamics::law::{DOF_AT_REST, DofLaws};
use nalgebra::{DMatrix, DVector};
use num_complex::Complex64;

use crate::error::AssemblyError;
use crate::model::AssemblyModel;
use condensed::{At, Condensed, Dynamic};
use follow::{Curve, follow, point};
use sampling::Sampling;

/// Part of the frequency by which it is varied for the derivatives of what is linear.
const VARIED: f64 = 1e-6;
/// Part of the frequency that counts as much as the whole motion.
const OF_FREQUENCY: f64 = 0.02;
/// A damping ratio that counts as much, and a change of the amplitude's logarithm.
const OF_RATIO: f64 = 0.01;
const OF_LOGARITHM: f64 = 1.0;
/// Loads of the first point come in so many parts.
const PARTS: u32 = 20;
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
    /// harmonics up to the highest.
    ///
    /// # Errors
    /// [`AssemblyError::NotBalanced`] where no solution is found, [`AssemblyError::Law`] where a joint gives no law.
    pub fn forced_response(
        &self,
        loads: &[Complex64],
        [from_hz, to_hz]: [f64; 2],
        highest_harmonic: usize,
        progress: &dyn Fn(f64),
    ) -> Result<Vec<ForcedPoint>, AssemblyError> {
        let problem = Problem::of(self, highest_harmonic)?;
        let forced = Forced {
            loads: DVector::from_row_slice(loads),
            problem: &problem,
        };
        let omega = TAU * from_hz;
        let mut start = DVector::zeros(problem.size() + 1);
        start[problem.size()] = omega;
        for part in 1..=PARTS {
            let share = f64::from(part) / f64::from(PARTS);
            let own = Forced {
                loads: &forced.loads * Complex64::from(share),
                problem: &problem,
            };
            if part == 1 {
                start = own.linear(omega).ok_or_else(|| not_balanced(from_hz))?;
            } else {
                start *= share / (share - 1.0 / f64::from(PARTS));
                start[problem.size()] = omega;
            }
            start = point(&own, &start, problem.size()).ok_or_else(|| not_balanced(from_hz))?;
        }
        let found = follow(&forced, start, problem.size(), TAU * to_hz, progress);
        let points = found.map_err(|lost| {
            let last = lost.points.last().map_or(omega, |own| own[problem.size()]);
            not_balanced(last / TAU)
        })?;
        let all = points.iter().map(|unknowns| forced.outputs(unknowns));
        all.collect::<Option<_>>()
            .ok_or_else(|| not_balanced(to_hz))
    }

    /// The nonlinear mode that begins as the linear one of this number (from 0, of those that oscillate, ascending), from one
    /// amplitude of an output's fundamental to another (m, rad).
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
    ) -> Result<Vec<FreePoint>, AssemblyError> {
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
        let points = found.map_err(|lost| {
            let last = lost.points.last().map_or(0.0, |own| own[size]);
            not_balanced(last / TAU)
        })?;
        let point = |own: &DVector<f64>| FreePoint {
            amplitude: own[size + 2].exp(),
            frequency_hz: own[size] / TAU,
            damping_ratio: own[size + 1],
        };
        Ok(points.iter().map(point).collect())
    }
}

fn not_balanced(frequency_hz: f64) -> AssemblyError {
    AssemblyError::NotBalanced { frequency_hz }
}

/// What is balanced.
struct Problem<'m> {
    condensed: Condensed<'m>,
    sampling: Sampling,
}

/// What is linear at all harmonics.
struct Linear {
    at: Vec<Dynamic>,
}

impl<'m> Problem<'m> {
    fn of(model: &'m AssemblyModel, highest_harmonic: usize) -> Result<Self, AssemblyError> {
        let condensed = Condensed::of(model)?;
        if condensed.laws.is_empty() {
            return Err(AssemblyError::NothingNonlinear);
        }
        let remembers = condensed.laws.iter().any(|(_, laws)| laws.have_memory());
        Ok(Self {
            condensed,
            sampling: Sampling::new(highest_harmonic, remembers),
        })
    }

    /// Number of unknowns of the motion: DOF by DOF those of each harmonic.
    fn size(&self) -> usize {
        self.condensed.laws.len() * self.sampling.size()
    }

    fn linear(&self, omega: f64, ratio: f64, loads: &DVector<Complex64>) -> Option<Linear> {
        let none = DVector::zeros(loads.len());
        let orders = self.sampling.orders.iter();
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

    /// Residuals Z r + f − p, and their derivatives by the motion and ω, the last column; `loads` of the fundamental.
    fn balance(
        &self,
        motion: &[f64],
        omega: f64,
        ratio: f64,
        loads: &DVector<Complex64>,
    ) -> Option<(DVector<f64>, DMatrix<f64>, Vec<f64>)> {
        let linear = self.linear(omega, ratio, loads)?;
        let size = self.size();
        let mut residual = self.residual(&linear, motion);
        let change = VARIED * omega;
        let next = self.linear(omega + change, ratio, loads)?;
        let mut derivatives = DMatrix::zeros(size, size + 1);
        let by_omega = (self.residual(&next, motion) - &residual) / change;
        derivatives.column_mut(size).copy_from(&by_omega);
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
        for (dof, (_, laws)) in self.condensed.laws.iter().enumerate() {
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
        Some((residual, derivatives, forces))
    }

    /// Motion of the outputs at a harmonic.
    fn outputs(&self, linear: &Linear, forces: &[f64], harmonic: usize) -> DVector<Complex64> {
        let count = self.condensed.laws.len();
        let own = DVector::from_fn(count, |dof, _| self.phasor(forces, dof, harmonic));
        linear.at[harmonic].outputs(&own)
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

/// Forced motion: unknowns are the motion and ω.
struct Forced<'p, 'm> {
    problem: &'p Problem<'m>,
    loads: DVector<Complex64>,
}

impl Forced<'_, '_> {
    /// The motion without the laws.
    fn linear(&self, omega: f64) -> Option<DVector<f64>> {
        let problem = self.problem;
        let linear = problem.linear(omega, 0.0, &self.loads)?;
        let first = linear.at.first()?;
        let r = first.stiffness.clone().lu().solve(&first.load)?;
        let mut start = DVector::zeros(problem.size() + 1);
        for dof in 0..r.len() {
            let place = problem.place(dof, 0);
            start[place] = r[dof].re;
            start[place + 1] = -r[dof].im;
        }
        start[problem.size()] = omega;
        Some(start)
    }

    fn outputs(&self, unknowns: &DVector<f64>) -> Option<ForcedPoint> {
        let problem = self.problem;
        let omega = unknowns[problem.size()];
        let motion = unknowns.as_slice().get(..problem.size())?;
        let (_, _, forces) = problem.balance(motion, omega, 0.0, &self.loads)?;
        let linear = problem.linear(omega, 0.0, &self.loads)?;
        let harmonics = problem.sampling.orders.len();
        let all: Vec<DVector<Complex64>> = (0..harmonics)
            .map(|own| problem.outputs(&linear, &forces, own))
            .collect();
        let first = all.first()?;
        let largest = (0..first.len()).map(|output| {
            let pairs = all.iter().flat_map(|own| [own[output].re, -own[output].im]);
            let coefficients: Vec<f64> = pairs.collect();
            problem.sampling.largest(&coefficients)
        });
        Some(ForcedPoint {
            frequency_hz: omega / TAU,
            largest: largest.collect(),
            fundamental: first.iter().copied().collect(),
        })
    }
}

impl Curve for Forced<'_, '_> {
    fn at(&self, unknowns: &DVector<f64>) -> Option<(DVector<f64>, DMatrix<f64>)> {
        let (motion, omega) = unknowns.as_slice().split_at(self.problem.size());
        let (residual, derivatives, _) =
            self.problem
                .balance(motion, *omega.first()?, 0.0, &self.loads)?;
        Some((residual, derivatives))
    }

    fn scale(&self, unknowns: &DVector<f64>) -> DVector<f64> {
        let size = self.problem.size();
        let mut scale = DVector::from_element(size + 1, self.problem.amplitude(unknowns));
        scale[size] = OF_FREQUENCY * unknowns[size];
        scale
    }
}

/// A nonlinear mode: unknowns are the motion, ω, ζ, and the logarithm of the amplitude of an output.
struct Free<'p, 'm> {
    problem: &'p Problem<'m>,
    output: usize,
}

impl Free<'_, '_> {
    fn no_loads(&self) -> DVector<Complex64> {
        DVector::zeros(self.problem.condensed.loads())
    }

    /// Gives the motion the shape of the linear mode, and the amplitude that is asked for.
    fn shape(&self, unknowns: &mut DVector<f64>) -> Option<()> {
        let problem = self.problem;
        let size = problem.size();
        // beside the mode: at an undamped resonance of a structure itself nothing is finite
        unknowns[size] *= 1.0 + VARIED;
        let omega = unknowns[size];
        let linear = problem.linear(omega, unknowns[size + 1], &self.no_loads())?;
        let first = linear.at.first()?;
        let mut stiffness = first.stiffness.clone();
        for (dof, (_, laws)) in problem.condensed.laws.iter().enumerate() {
            // of small motion
            let laws = DofLaws::new(laws.parameters().map(Dual::<2>::from));
            let [k, c] = laws
                .load(&DOF_AT_REST, Dual::along(0.0, 0), Dual::along(0.0, 1))
                .change;
            stiffness[(dof, dof)] += Complex64::new(k, omega * c);
        }
        let count = stiffness.nrows();
        let lu = stiffness.lu();
        let mut r = DVector::from_element(count, Complex64::ONE);
        for _ in 0..ITERATIONS {
            r = lu.solve(&r)?;
            let norm = r.norm();
            r /= Complex64::from(norm);
        }
        let mut motion = vec![0.0; size];
        let put = |motion: &mut [f64], r: &DVector<Complex64>| {
            for dof in 0..count {
                let place = problem.place(dof, 0);
                motion[place] = r[dof].re;
                motion[place + 1] = -r[dof].im;
            }
        };
        put(&mut motion, &r);
        // y of the mode with f = −Z r
        let forces = -&first.stiffness * &r;
        let y = first.outputs(&forces)[self.output];
        if y.norm() == 0.0 {
            return None;
        }
        let r = r * (Complex64::from(unknowns[size + 2].exp()) / y);
        put(&mut motion, &r);
        unknowns.rows_mut(0, size).copy_from_slice(&motion);
        Some(())
    }

    fn residual(&self, unknowns: &DVector<f64>) -> Option<(DVector<f64>, DMatrix<f64>)> {
        let problem = self.problem;
        let size = problem.size();
        let loads = self.no_loads();
        let (omega, ratio, amplitude) =
            (unknowns[size], unknowns[size + 1], unknowns[size + 2].exp());
        let motion = unknowns.as_slice().get(..size)?;
        let (own, derivatives, _) = problem.balance(motion, omega, ratio, &loads)?;
        let linear = problem.linear(omega, ratio, &loads)?;
        // y = U f with f = −Z r at the fundamental, which is linear in r
        let output = |linear: &Linear| -> Option<DMatrix<Complex64>> {
            let first = linear.at.first()?;
            Some(-first.by_forces(self.output) * &first.stiffness)
        };
        let rows = output(&linear)?;
        let count = problem.condensed.laws.len();
        let r = DVector::from_fn(count, |dof, _| problem.phasor(motion, dof, 0));
        let y = (&rows * &r)[(0, 0)];
        let mut residual = DVector::zeros(size + 2);
        residual.rows_mut(0, size).copy_from(&own);
        residual[size] = y.re / amplitude - 1.0;
        residual[size + 1] = y.im / amplitude;
        let mut matrix = DMatrix::zeros(size + 2, size + 3);
        matrix
            .view_mut((0, 0), (size, size + 1))
            .copy_from(&derivatives);
        let [by_omega, by_ratio] = [[VARIED * omega, 0.0], [0.0, VARIED]];
        for (column, [omega_change, ratio_change]) in [(size, by_omega), (size + 1, by_ratio)] {
            let step = omega_change + ratio_change;
            let next = problem.linear(omega + omega_change, ratio + ratio_change, &loads)?;
            if column == size + 1 {
                let change =
                    (problem.residual(&next, motion) - problem.residual(&linear, motion)) / step;
                matrix.view_mut((0, column), (size, 1)).copy_from(&change);
            }
            let change = ((output(&next)? * &r)[(0, 0)] - y) / step;
            matrix[(size, column)] = change.re / amplitude;
            matrix[(size + 1, column)] = change.im / amplitude;
        }
        for dof in 0..count {
            let place = problem.place(dof, 0);
            let own = rows[(0, dof)];
            // own (a − jb)
            matrix[(size, place)] = own.re / amplitude;
            matrix[(size, place + 1)] = own.im / amplitude;
            matrix[(size + 1, place)] = own.im / amplitude;
            matrix[(size + 1, place + 1)] = -own.re / amplitude;
        }
        matrix[(size, size + 2)] = -y.re / amplitude;
        matrix[(size + 1, size + 2)] = -y.im / amplitude;
        Some((residual, matrix))
    }
}

impl Curve for Free<'_, '_> {
    fn at(&self, unknowns: &DVector<f64>) -> Option<(DVector<f64>, DMatrix<f64>)> {
        self.residual(unknowns)
    }

    fn scale(&self, unknowns: &DVector<f64>) -> DVector<f64> {
        let size = self.problem.size();
        let mut scale = DVector::from_element(size + 3, self.problem.amplitude(unknowns));
        scale[size] = OF_FREQUENCY * unknowns[size];
        scale[size + 1] = OF_RATIO;
        scale[size + 2] = OF_LOGARITHM;
        scale
    }
}
