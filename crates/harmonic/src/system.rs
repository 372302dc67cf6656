//! The equations of each kind of test in one form: harmonics, frequency and one more number unknown, and Newton's method on them.

use nalgebra::{DMatrix, DVector, Dyn, LU};
use num_complex::Complex64;

use super::balance::{Evaluation, HarmonicBalance};
use super::condensed::{Circumstances, Condensed};
use super::{HarmonicLoads, Observed, Target};

/// Largest scaled correction of the last iteration; those before it converge quadratically.
const TOLERANCE: f64 = 1e-9;
/// Scaled correction beyond which an iteration from a nearby point is lost.
const LOST: f64 = 4.0;

/// What a test holds while its frequency or its amplitude moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Regime {
    /// The loads.
    Forced,
    /// The frequency (rad/s), while the loads move.
    Level(f64),
    /// An amplitude, by adjusting the loads.
    Controlled(Target),
    /// A quarter of a period between the loads and a motion.
    Resonance(Observed),
    /// Nothing: without loads, damping released as far as the motion needs it, and the motion's fundamental a cosine.
    Free(Observed),
}

/// Which point of a curve is meant.
#[derive(Clone, Copy, Debug)]
pub(super) enum Closing<'a> {
    /// That at a frequency, rad/s.
    Frequency(f64),
    /// That with a factor of the loads.
    LoadFactor(f64),
    /// That with an amplitude.
    Amplitude(Target),
    /// That in the plane through a point, across a scaled direction.
    Plane {
        through: &'a [f64],
        across: &'a DVector<f64>,
    },
}

/// Sizes of the unknowns, and of the forces that are out of balance.
#[derive(Clone, Debug)]
pub(super) struct Scale {
    /// One for each unknown.
    pub(super) unknown: Vec<f64>,
    /// m
    amplitude: f64,
}

impl Scale {
    /// What a row of the balance is multiplied by: its DOF's length over a force.
    pub(super) fn of_row<const D: usize>(&self, balance: &HarmonicBalance<D>, row: usize) -> f64 {
        balance.length[row / balance.harmonics.slots()] / (balance.stiffness * self.amplitude)
    }
}

/// An observed complex amplitude of the fundamental with its derivatives.
#[derive(Clone, Copy, Debug)]
pub(super) struct Observation {
    pub(super) value: Complex64,
    pub(super) by_r: Complex64,
    pub(super) by_omega: Complex64,
    pub(super) by_factor: Complex64,
    pub(super) by_released: Complex64,
}

/// The equations of one test. Unknowns are the coefficients, ω, and except in [`Regime::Forced`] a second number: the factor of
/// the loads or the damping released.
#[derive(Debug)]
pub(super) struct System<'a, const D: usize> {
    pub(super) balance: &'a HarmonicBalance<D>,
    pub(super) loads: &'a HarmonicLoads<D>,
    pub(super) regime: Regime,
    /// Step of the frequency that counts as much as an amplitude's change by itself, rad/s.
    pub(super) omega_scale: f64,
    evaluation: Evaluation,
}

impl<'a, const D: usize> System<'a, D> {
    pub(super) fn new(
        balance: &'a HarmonicBalance<D>,
        loads: &'a HarmonicLoads<D>,
        regime: Regime,
    ) -> Self {
        Self {
            balance,
            loads,
            regime,
            omega_scale: balance.omega,
            evaluation: balance.room(),
        }
    }

    /// Number of unknowns.
    pub(super) fn size(&self) -> usize {
        self.balance.size() + self.extras()
    }

    fn extras(&self) -> usize {
        match self.regime {
            Regime::Forced => 1,
            _ => 2,
        }
    }

    pub(super) fn circumstances(&self, unknowns: &[f64]) -> Circumstances {
        let size = self.balance.size();
        let (omega, second) = (unknowns[size], unknowns.get(size + 1).copied());
        match (self.regime, second) {
            (Regime::Free(_), Some(released)) => Circumstances {
                omega,
                load_factor: 0.0,
                released,
            },
            (_, Some(load_factor)) => Circumstances {
                omega,
                load_factor,
                released: 0.0,
            },
            (_, None) => Circumstances {
                omega,
                load_factor: 1.0,
                released: 0.0,
            },
        }
    }

    /// Unknowns of a motion.
    pub(super) fn unknowns(&self, coefficients: &[f64], at: Circumstances) -> Vec<f64> {
        let mut unknowns = coefficients.to_vec();
        unknowns.push(at.omega);
        match self.regime {
            Regime::Forced => {}
            Regime::Free(_) => unknowns.push(at.released),
            Regime::Level(_) | Regime::Controlled(_) | Regime::Resonance(_) => {
                unknowns.push(at.load_factor);
            }
        }
        unknowns
    }

    /// Size of the motion (m): root of the sum of squares of all coefficients, scaled to the first DOF.
    pub(super) fn amplitude(&self, unknowns: &[f64]) -> f64 {
        let slots = self.balance.harmonics.slots();
        let mut sum = 0.0;
        for (dof, length) in self.balance.length.iter().enumerate() {
            for coefficient in &unknowns[dof * slots..(dof + 1) * slots] {
                sum += (coefficient / length).powi(2);
            }
        }
        sum.sqrt()
    }

    /// Sizes of the unknowns at a point.
    pub(super) fn scale(&self, unknowns: &[f64]) -> Scale {
        let amplitude = self.amplitude(unknowns);
        let amplitude = if amplitude > 0.0 { amplitude } else { 1.0 };
        let slots = self.balance.harmonics.slots();
        let lengths = self.balance.length.iter();
        let mut unknown: Vec<f64> = lengths
            .flat_map(|length| std::iter::repeat_n(length * amplitude, slots))
            .collect();
        unknown.push(self.omega_scale);
        match self.regime {
            Regime::Forced => {}
            // A damping ratio is of the order of one at most, and mostly much smaller.
            Regime::Free(_) => unknown.push(1.0),
            Regime::Level(_) | Regime::Controlled(_) | Regime::Resonance(_) => {
                let factor = unknowns.last().map_or(0.0, |factor| factor.abs());
                unknown.push(if factor > 0.0 { factor } else { 1.0 });
            }
        }
        Scale { unknown, amplitude }
    }

    /// What a sensor sees of the fundamental.
    pub(super) fn observe(&self, observed: Observed, unknowns: &[f64]) -> Observation {
        let at = self.circumstances(unknowns);
        self.balance.observe(observed, unknowns, self.loads, at)
    }

    /// |X| ω^n
    pub(super) fn target_amplitude(&self, target: &Target, unknowns: &[f64]) -> f64 {
        let omega = unknowns[self.balance.size()];
        let order = target.derivative.order();
        self.observe(target.observed, unknowns).value.norm() * omega.powi(order)
    }

    /// The scaled matrix and right-hand side of Newton's method.
    pub(super) fn linearise(
        &mut self,
        unknowns: &[f64],
        closing: &Closing<'_>,
        scale: &Scale,
    ) -> (DMatrix<f64>, DVector<f64>) {
        let (size, total) = (self.balance.size(), self.size());
        let slots = self.balance.harmonics.slots();
        let at = self.circumstances(unknowns);
        let balance = self.balance;
        balance.evaluate(&unknowns[..size], self.loads, at, &mut self.evaluation);
        let evaluation = &self.evaluation;
        let mut matrix = DMatrix::zeros(total, total);
        let mut rest = DVector::zeros(total);
        let row_scale: [f64; D] = std::array::from_fn(|dof| scale.of_row(balance, dof * slots));
        for column in 0..size {
            let by = scale.unknown[column];
            let from = evaluation.jacobian.column(column);
            let mut to = matrix.column_mut(column);
            for row in 0..size {
                to[row] = from[row] * by * row_scale[row / slots];
            }
        }
        let second: &[f64] = match self.regime {
            Regime::Free(_) => &evaluation.by_released,
            _ => &evaluation.by_factor,
        };
        for row in 0..size {
            let by = row_scale[row / slots];
            rest[row] = evaluation.residual[row] * by;
            matrix[(row, size)] = evaluation.by_omega[row] * by * scale.unknown[size];
            if total > size + 1 {
                matrix[(row, size + 1)] = second[row] * by * scale.unknown[size + 1];
            }
        }
        if total > size + 1 {
            let (value, derivatives) = self.condition(unknowns, scale);
            rest[size] = value;
            for column in 0..total {
                matrix[(size, column)] = derivatives[column] * scale.unknown[column];
            }
        }
        let (value, derivatives) = self.close(unknowns, closing, scale);
        rest[total - 1] = value;
        for column in 0..total {
            matrix[(total - 1, column)] = derivatives[column] * scale.unknown[column];
        }
        (matrix, rest)
    }

    /// The equation that a regime adds, and its derivatives.
    fn condition(&self, unknowns: &[f64], scale: &Scale) -> (f64, Vec<f64>) {
        match self.regime {
            Regime::Forced => (0.0, vec![0.0; self.size()]),
            Regime::Level(omega) => self.held(self.balance.size(), omega, unknowns),
            Regime::Controlled(target) => self.of_target(&target, unknowns),
            // Re(X F̄)/|F| = 0
            Regime::Resonance(observed) => {
                let load = self.loads.largest();
                self.of_part(observed, load.conj() / load.norm(), unknowns, scale)
            }
            // Im X = 0: Re(−j X)
            Regime::Free(observed) => self.of_part(observed, -Complex64::I, unknowns, scale),
        }
    }

    fn close(&self, unknowns: &[f64], closing: &Closing<'_>, scale: &Scale) -> (f64, Vec<f64>) {
        match closing {
            Closing::Frequency(omega) => self.held(self.balance.size(), *omega, unknowns),
            Closing::LoadFactor(factor) => self.held(self.balance.size() + 1, *factor, unknowns),
            Closing::Amplitude(target) => self.of_target(target, unknowns),
            Closing::Plane { through, across } => {
                let sizes = &scale.unknown;
                let parts =
                    (0..self.size()).map(|n| across[n] * (unknowns[n] - through[n]) / sizes[n]);
                let derivatives = across.iter().zip(sizes).map(|(across, size)| across / size);
                (parts.sum(), derivatives.collect())
            }
        }
    }

    /// One unknown as given.
    fn held(&self, place: usize, value: f64, unknowns: &[f64]) -> (f64, Vec<f64>) {
        let size = if value == 0.0 { 1.0 } else { value };
        let mut derivatives = vec![0.0; self.size()];
        derivatives[place] = 1.0 / size;
        ((unknowns[place] - value) / size, derivatives)
    }

    /// |X| ω^n / A − 1
    fn of_target(&self, target: &Target, unknowns: &[f64]) -> (f64, Vec<f64>) {
        let size = self.balance.size();
        let omega = unknowns[size];
        let observation = self.observe(target.observed, unknowns);
        let modulus = observation.value.norm();
        let order = target.derivative.order();
        let factor = omega.powi(order) / target.amplitude;
        // d|X| = Re(X̄ dX)/|X|
        let direction = if modulus > 0.0 {
            observation.value.conj() / modulus
        } else {
            Complex64::ONE
        };
        let mut derivatives = self.along(target.observed, &observation, direction * factor);
        derivatives[size] += f64::from(order) * modulus * factor / omega;
        (modulus * factor - 1.0, derivatives)
    }

    /// Re(direction · X)
    fn of_part(
        &self,
        observed: Observed,
        direction: Complex64,
        unknowns: &[f64],
        scale: &Scale,
    ) -> (f64, Vec<f64>) {
        let length = self.balance.length[observed.dof()];
        let direction = direction / (length * scale.amplitude);
        let observation = self.observe(observed, unknowns);
        let derivatives = self.along(observed, &observation, direction);
        ((direction * observation.value).re, derivatives)
    }

    /// Change of [`System::condition`] with a parameter that changes what sensors see at the same relative motion.
    pub(super) fn condition_change(
        &self,
        seen: impl Fn(Observed) -> Complex64,
        unknowns: &[f64],
        scale: &Scale,
    ) -> f64 {
        let part = |observed: Observed, direction: Complex64| {
            let length = self.balance.length[observed.dof()] * scale.amplitude;
            (direction * seen(observed)).re / length
        };
        match self.regime {
            Regime::Forced | Regime::Level(_) => 0.0,
            Regime::Controlled(target) => {
                self.target_change(&target, seen(target.observed), unknowns)
            }
            Regime::Resonance(observed) => {
                let load = self.loads.largest();
                part(observed, load.conj() / load.norm())
            }
            Regime::Free(observed) => part(observed, -Complex64::I),
        }
    }

    /// Change of |X| ω^n / A with a change of X.
    pub(super) fn target_change(
        &self,
        target: &Target,
        change: Complex64,
        unknowns: &[f64],
    ) -> f64 {
        let value = self.observe(target.observed, unknowns).value;
        let omega = unknowns[self.balance.size()];
        let factor = omega.powi(target.derivative.order()) / target.amplitude;
        (value.conj() * change).re / value.norm() * factor
    }

    /// Derivatives of Re(direction · X).
    fn along(
        &self,
        observed: Observed,
        observation: &Observation,
        direction: Complex64,
    ) -> Vec<f64> {
        let size = self.balance.size();
        let mut derivatives = vec![0.0; self.size()];
        let harmonics = &self.balance.harmonics;
        let place = observed.dof() * harmonics.slots() + harmonics.fundamental();
        // X changes by (∂X/∂r)(da − j db)
        let by_r = direction * observation.by_r;
        derivatives[place] = by_r.re;
        derivatives[place + 1] = by_r.im;
        derivatives[size] = (direction * observation.by_omega).re;
        if let Some(second) = derivatives.get_mut(size + 1) {
            let by_second = match self.regime {
                Regime::Free(_) => observation.by_released,
                _ => observation.by_factor,
            };
            *second = (direction * by_second).re;
        }
        derivatives
    }

    /// Moves `unknowns` to the nearest solution. The number of iterations it took, and the matrix of the last one; `None` if
    /// none is near.
    pub(super) fn correct(
        &mut self,
        unknowns: &mut [f64],
        closing: &Closing<'_>,
        scale: &Scale,
        most: usize,
        is_near: bool,
    ) -> Option<(usize, LU<f64, Dyn, Dyn>)> {
        let mut last = f64::INFINITY;
        for iteration in 1..=most {
            let (matrix, rest) = self.linearise(unknowns, closing, scale);
            let factors = matrix.lu();
            let correction = factors.solve(&rest)?;
            let largest = correction.amax();
            if !largest.is_finite() || is_near && (largest > LOST || largest > 2.0 * last) {
                return None;
            }
            for (n, unknown) in unknowns.iter_mut().enumerate() {
                *unknown -= scale.unknown[n] * correction[n];
            }
            if largest <= TOLERANCE {
                return Some((iteration, factors));
            }
            last = largest;
        }
        None
    }
}

impl<const D: usize> HarmonicBalance<D> {
    /// What a sensor sees of the fundamental.
    pub(super) fn observe(
        &self,
        observed: Observed,
        coefficients: &[f64],
        loads: &HarmonicLoads<D>,
        at: Circumstances,
    ) -> Observation {
        let dof = observed.dof();
        let r = self.amplitude(coefficients, dof, (1, self.harmonics.fundamental()));
        match observed {
            Observed::Relative(_) => Observation {
                value: r,
                by_r: Complex64::ONE,
                by_omega: Complex64::ZERO,
                by_factor: Complex64::ZERO,
                by_released: Complex64::ZERO,
            },
            Observed::Body(side, _) => {
                let bodies = Condensed::new(&self.lap, loads, dof, 1, at);
                Observation {
                    value: bodies.body(side, r),
                    by_r: bodies.body_by_r(side),
                    by_omega: bodies.body_by_omega(r),
                    by_factor: bodies.body_by_factor(loads, dof),
                    by_released: bodies.body_by_released(r),
                }
            }
        }
    }
}
