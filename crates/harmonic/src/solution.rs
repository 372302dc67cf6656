//! One periodic motion: how it is found, and what sensors see of it.

use std::f64::consts::TAU;

use bolted_joint_dynamics::{LapState, Motion};
use num_complex::Complex64;

use super::balance::HarmonicBalance;
use super::condensed::{Circumstances, Condensed};
use super::system::{Closing, Regime, System};
use super::{HarmonicError, HarmonicLoads, Observed, Side, Target};

/// Part of an amplitude at which a lap is still nearly linear, where growing begins.
pub(super) const SMALL: f64 = 1e-3;
/// Iterations from a start that may be far.
const MOST_ITERATIONS: usize = 60;

/// A periodic motion of a lap.
#[derive(Clone, Debug, PartialEq)]
pub struct Solution<const D: usize> {
    pub(super) loads: HarmonicLoads<D>,
    pub(super) regime: Regime,
    pub(super) at: Circumstances,
    /// Of the relative motion.
    pub(super) coefficients: Vec<f64>,
}

impl<const D: usize> Solution<D> {
    /// Frequency of the fundamental, Hz.
    #[must_use]
    pub fn frequency_hz(&self) -> f64 {
        self.at.omega / TAU
    }

    /// Angular frequency of the fundamental, rad/s.
    #[must_use]
    pub fn omega_rad_s(&self) -> f64 {
        self.at.omega
    }

    /// Factor of the harmonic loads, where a test adjusts them; 1 under given loads, 0 without loads.
    #[must_use]
    pub fn load_factor(&self) -> f64 {
        self.at.load_factor
    }

    /// Damping ratio of a free motion: the ζ for which 2ζω M ẋ takes from it in a period what its dampers do; else 0.
    #[must_use]
    pub fn damping_ratio(&self) -> f64 {
        self.at.released
    }

    /// The loads that keep it going.
    #[must_use]
    pub fn loads(&self) -> HarmonicLoads<D> {
        self.loads.scaled(self.at.load_factor)
    }

    /// Real coefficients of the relative motion, DOF by DOF (m, rad): the constant if it is among the harmonics, then cosine and
    /// sine of each.
    #[must_use]
    pub fn coefficients(&self) -> &[f64] {
        &self.coefficients
    }
}

impl<const D: usize> HarmonicBalance<D> {
    /// The response at an angular frequency (rad/s) under given loads. Where there are several, it is the one that Newton's method
    /// finds from `start`; without a start, that which grows out of the linear one.
    ///
    /// # Errors
    /// [`HarmonicError`] if the loads or the frequency make no sense or nothing is found.
    pub fn forced(
        &self,
        omega_rad_s: f64,
        loads: &HarmonicLoads<D>,
        start: Option<&Solution<D>>,
    ) -> Result<Solution<D>, HarmonicError> {
        self.check(omega_rad_s, loads)?;
        let at = Circumstances {
            omega: omega_rad_s,
            load_factor: 1.0,
            released: 0.0,
        };
        let mut system = System::new(self, loads, Regime::Forced);
        let closing = Closing::Frequency(omega_rad_s);
        let rest = vec![0.0; self.size()];
        let coefficients = start.map_or(&rest, |start| &start.coefficients);
        let mut unknowns = system.unknowns(coefficients, at);
        if start.is_none() {
            // The first iteration from rest gives the linear response, which sets the scale.
            let scale = system.scale(&unknowns);
            let (matrix, residual) = system.linearise(&unknowns, &closing, &scale);
            let linear = matrix.lu().solve(&residual);
            let linear = linear.ok_or_else(|| not_found(omega_rad_s, 1))?;
            for (n, unknown) in unknowns.iter_mut().enumerate() {
                *unknown -= scale.unknown[n] * linear[n];
            }
        }
        let begin = unknowns.clone();
        let scale = system.scale(&unknowns);
        let found = system.correct(&mut unknowns, &closing, &scale, MOST_ITERATIONS, false);
        // From far away Newton's method may end anywhere, or nowhere: follow the response from small loads instead.
        let is_far = || {
            let change = begin.iter().zip(&unknowns).zip(&scale.unknown);
            let change = change.map(|((begin, end), size)| ((begin - end) / size).abs());
            start.is_none() && change.fold(0.0, f64::max) > 0.1
        };
        if found.is_none() || is_far() {
            return self.grown(omega_rad_s, loads);
        }
        Ok(system.solution(&unknowns))
    }

    /// The response under loads whose factor keeps a fundamental's amplitude at `target`, as response-controlled stepped sine does.
    ///
    /// # Errors
    /// [`HarmonicError`] if the target or the frequency make no sense, no harmonic load acts, or nothing is found.
    pub fn controlled(
        &self,
        omega_rad_s: f64,
        loads: &HarmonicLoads<D>,
        target: Target,
        start: Option<&Solution<D>>,
    ) -> Result<Solution<D>, HarmonicError> {
        self.check(omega_rad_s, loads)?;
        self.check_target(&target, loads)?;
        let Some(start) = start else {
            return self.controlled_from_rest(omega_rad_s, loads, target);
        };
        let mut system = System::new(self, loads, Regime::Controlled(target));
        let at = Circumstances {
            omega: omega_rad_s,
            ..start.at
        };
        let unknowns = system.unknowns(&start.coefficients, at);
        system.closed(unknowns, &Closing::Frequency(omega_rad_s))
    }

    /// The response at which a motion of the given fundamental amplitude is a quarter of a period from the loads: phase resonance.
    /// Without a start, that nearest to the linear resonance where the relative motion in that DOF is largest.
    ///
    /// # Errors
    /// As [`HarmonicBalance::controlled`].
    pub fn resonance(
        &self,
        loads: &HarmonicLoads<D>,
        target: Target,
        start: Option<&Solution<D>>,
    ) -> Result<Solution<D>, HarmonicError> {
        self.check_loads(loads)?;
        self.check_target(&target, loads)?;
        let mut system = System::new(self, loads, Regime::Resonance(target.observed));
        let Some(start) = start else {
            let omega = self.natural_omega(target.observed)?;
            let small = target.times(SMALL);
            let linear = self.linear(omega, loads, &small)?;
            return system.grown_to(&linear, target);
        };
        let unknowns = system.unknowns(&start.coefficients, start.at);
        system.closed(unknowns, &Closing::Amplitude(target))
    }

    /// The free motion of a fundamental amplitude, with the damping ratio at which it loses what it loses: a point of the backbone.
    ///
    /// A force 2ζω M ẋ makes the damped motion periodic (M. Krack, Nonlinear modal analysis of nonconservative systems, Comput.
    /// Struct. 154 (2015) 59–71). Of a lap without dampers this is the nonlinear normal mode, ζ = 0. Without a start, the mode
    /// is that in which the relative motion of the target's DOF is largest.
    ///
    /// # Errors
    /// [`HarmonicError`] if the target makes no sense or nothing is found.
    pub fn free(
        &self,
        target: Target,
        start: Option<&Solution<D>>,
    ) -> Result<Solution<D>, HarmonicError> {
        self.check_amplitude(&target)?;
        let loads = HarmonicLoads::NONE;
        let mut system = System::new(self, &loads, Regime::Free(target.observed));
        let Some(start) = start else {
            let linear = self.linear_mode(&target.times(SMALL))?;
            return system.grown_to(&linear, target);
        };
        let unknowns = system.unknowns(&start.coefficients, start.at);
        system.closed(unknowns, &Closing::Amplitude(target))
    }

    /// Complex amplitude of a harmonic of a motion, 0 for the constant term: X of Re(X e^{jhωt}), m or rad. Zero where the
    /// harmonic is not among those of the balance.
    #[must_use]
    pub fn amplitude_of(
        &self,
        solution: &Solution<D>,
        observed: Observed,
        order: usize,
    ) -> Complex64 {
        let dof = observed.dof();
        let Some(place) = self.place_of(order).filter(|_| dof < D) else {
            return Complex64::ZERO;
        };
        let r = self.amplitude(&solution.coefficients, dof, place);
        match observed {
            Observed::Relative(_) => r,
            Observed::Body(side, _) => {
                Condensed::new(&self.lap, &solution.loads, dof, order, solution.at).body(side, r)
            }
        }
    }

    /// The lap's state at a phase ωt (rad) of the motion, to start a time integration from.
    #[must_use]
    pub fn state_at(&self, solution: &Solution<D>, phase_rad: f64) -> LapState<D> {
        let motion = |side: Side| {
            let mut motion = Motion::REST;
            for dof in 0..D {
                for (order, _) in self.all_places() {
                    let omega = order as f64 * solution.at.omega;
                    let amplitude = self.amplitude_of(solution, Observed::Body(side, dof), order);
                    let now = amplitude * Complex64::cis(order as f64 * phase_rad);
                    motion.displacement[dof] += now.re;
                    // Re(jΩ X e^{jΩt})
                    motion.velocity[dof] -= omega * now.im;
                }
            }
            motion
        };
        LapState {
            a: motion(Side::A),
            b: motion(Side::B),
        }
    }

    /// Largest |x| of a motion over a period, m or rad, on so fine a grid that the highest harmonic is followed.
    #[must_use]
    pub fn peak_of(&self, solution: &Solution<D>, observed: Observed) -> f64 {
        let amplitudes: Vec<(f64, Complex64)> = self
            .all_places()
            .map(|(order, _)| (order as f64, self.amplitude_of(solution, observed, order)))
            .collect();
        let count = 64 * self.harmonics.highest();
        let moment = |n: usize| {
            let phase = TAU * n as f64 / count as f64;
            let sum: f64 = amplitudes
                .iter()
                .map(|(order, amplitude)| (amplitude * Complex64::cis(order * phase)).re)
                .sum();
            sum.abs()
        };
        (0..count).map(moment).fold(0.0, f64::max)
    }

    fn check(&self, omega: f64, loads: &HarmonicLoads<D>) -> Result<(), HarmonicError> {
        if !(omega.is_finite() && omega > 0.0) {
            return Err(HarmonicError::Value {
                what: "angular frequency in rad/s",
                found: omega,
                expected: "a positive number",
            });
        }
        self.check_loads(loads)
    }

    fn check_amplitude(&self, target: &Target) -> Result<(), HarmonicError> {
        if !(target.amplitude.is_finite() && target.amplitude > 0.0) {
            return Err(HarmonicError::Value {
                what: "amplitude",
                found: target.amplitude,
                expected: "a positive number",
            });
        }
        let dof = target.observed.dof();
        if dof >= D {
            return Err(HarmonicError::Value {
                what: "DOF of an amplitude",
                found: dof as f64,
                expected: "one that the lap has",
            });
        }
        Ok(())
    }

    pub(super) fn check_target(
        &self,
        target: &Target,
        loads: &HarmonicLoads<D>,
    ) -> Result<(), HarmonicError> {
        if loads.largest() == Complex64::ZERO {
            return Err(HarmonicError::NoLoad);
        }
        self.check_amplitude(target)
    }

    /// The response of the linear lap at a frequency, its loads adjusted to the target.
    pub(super) fn linear(
        &self,
        omega: f64,
        loads: &HarmonicLoads<D>,
        target: &Target,
    ) -> Result<Solution<D>, HarmonicError> {
        let mut system = System::new(self, loads, Regime::Forced);
        let at = Circumstances {
            omega,
            load_factor: 1.0,
            released: 0.0,
        };
        let mut unknowns = system.unknowns(&vec![0.0; self.size()], at);
        let scale = system.scale(&unknowns);
        let (matrix, rest) = system.linearise(&unknowns, &Closing::Frequency(omega), &scale);
        let linear = matrix.lu().solve(&rest);
        let linear = linear.ok_or_else(|| not_found(omega, 1))?;
        for (n, unknown) in unknowns.iter_mut().enumerate() {
            *unknown -= scale.unknown[n] * linear[n];
        }
        let factor = target.amplitude / system.target_amplitude(target, &unknowns);
        if !(factor.is_finite() && factor > 0.0) {
            return Err(not_found(omega, 1));
        }
        let mut solution = system.solution(&unknowns);
        solution.at.load_factor = factor;
        for coefficient in &mut solution.coefficients {
            *coefficient *= factor;
        }
        Ok(solution)
    }
}

impl<const D: usize> System<'_, D> {
    pub(super) fn solution(&self, unknowns: &[f64]) -> Solution<D> {
        Solution {
            loads: *self.loads,
            regime: self.regime,
            at: self.circumstances(unknowns),
            coefficients: unknowns[..self.balance.size()].to_vec(),
        }
    }

    /// The solution that Newton's method finds from here.
    pub(super) fn closed(
        &mut self,
        mut unknowns: Vec<f64>,
        closing: &Closing<'_>,
    ) -> Result<Solution<D>, HarmonicError> {
        let scale = self.scale(&unknowns);
        let omega = unknowns[self.balance.size()];
        match self.correct(&mut unknowns, closing, &scale, MOST_ITERATIONS, false) {
            Some(_) => Ok(self.solution(&unknowns)),
            None => Err(not_found(omega, MOST_ITERATIONS)),
        }
    }
}

pub(super) fn not_found(omega: f64, iterations: usize) -> HarmonicError {
    HarmonicError::NotFound {
        frequency_hz: omega / TAU,
        iterations,
    }
}
