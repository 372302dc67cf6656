//! Curves of periodic motions: amplitude over frequency at given loads or at a given amplitude, and backbones.

use super::balance::HarmonicBalance;
use super::condensed::Circumstances;
use super::continuation::Followed;
use super::solution::{SMALL, not_found};
use super::stability::Stability;
use super::system::{Closing, Regime, System};
use super::{HarmonicError, HarmonicLoads, Solution, Steps, Target};

/// Part of the range of frequencies that counts as much as the motion's change by itself.
const OF_RANGE: f64 = 0.1;
/// Steps from small amplitudes to larger ones, of which only the last is wanted.
const GROWING: Steps = Steps {
    first: 0.5,
    shortest: 1e-9,
    longest: 1.0,
    most: 2000,
};

/// A point of a curve.
#[derive(Clone, Debug, PartialEq)]
pub struct CurvePoint<const D: usize> {
    /// The motion.
    pub solution: Solution<D>,
    /// Whether the frequency turns here.
    pub is_fold: bool,
    /// Whether the motion persists; `None` where that was not asked for or has no meaning, as on backbones.
    pub stability: Option<Stability>,
}

/// How a curve is computed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CurveOptions {
    /// How it is followed.
    pub steps: Steps,
    /// Whether the stability of each motion is computed; it is not where a law slips.
    pub with_stability: bool,
}

impl<const D: usize> HarmonicBalance<D> {
    /// Responses under given loads from the first angular frequency to the second (rad/s), upwards or downwards, through all
    /// folds. The curve ends where it leaves the range. Curves that are not connected to the first response are not found.
    ///
    /// # Errors
    /// [`HarmonicError`] if loads or frequencies make no sense, no first response is found, or the curve cannot be followed.
    pub fn forced_curve(
        &self,
        omega_rad_s: [f64; 2],
        loads: &HarmonicLoads<D>,
        options: &CurveOptions,
    ) -> Result<Vec<CurvePoint<D>>, HarmonicError> {
        check_range(omega_rad_s, "angular frequencies in rad/s")?;
        let start = self.forced(omega_rad_s[0], loads, None)?;
        let mut system = System::new(self, loads, Regime::Forced);
        system.along_frequency(&start, omega_rad_s, options)
    }

    /// Responses of one amplitude, whose loads are adjusted, from the first angular frequency to the second (rad/s).
    ///
    /// # Errors
    /// As [`HarmonicBalance::forced_curve`].
    pub fn controlled_curve(
        &self,
        omega_rad_s: [f64; 2],
        loads: &HarmonicLoads<D>,
        target: Target,
        options: &CurveOptions,
    ) -> Result<Vec<CurvePoint<D>>, HarmonicError> {
        check_range(omega_rad_s, "angular frequencies in rad/s")?;
        let start = self.controlled(omega_rad_s[0], loads, target, None)?;
        let mut system = System::new(self, loads, Regime::Controlled(target));
        system.along_frequency(&start, omega_rad_s, options)
    }

    /// Phase resonances from the first to the second amplitude of a motion: `target` at each of them.
    ///
    /// # Errors
    /// As [`HarmonicBalance::forced_curve`].
    pub fn resonance_curve(
        &self,
        amplitudes: [f64; 2],
        loads: &HarmonicLoads<D>,
        target: Target,
        options: &CurveOptions,
    ) -> Result<Vec<CurvePoint<D>>, HarmonicError> {
        check_range(amplitudes, "amplitudes")?;
        let start = self.resonance(loads, at(target, amplitudes[0]), None)?;
        let mut system = System::new(self, loads, Regime::Resonance(target.observed));
        system.along_amplitude(&start, amplitudes, target, options)
    }

    /// The backbone from the first to the second amplitude of a motion: frequency and damping ratio of free motions.
    ///
    /// # Errors
    /// As [`HarmonicBalance::forced_curve`].
    pub fn backbone(
        &self,
        amplitudes: [f64; 2],
        target: Target,
        options: &CurveOptions,
    ) -> Result<Vec<CurvePoint<D>>, HarmonicError> {
        check_range(amplitudes, "amplitudes")?;
        let start = self.free(at(target, amplitudes[0]), None)?;
        let loads = HarmonicLoads::NONE;
        let mut system = System::new(self, &loads, Regime::Free(target.observed));
        system.along_amplitude(&start, amplitudes, target, options)
    }

    /// The response at a frequency that grows with the loads out of rest.
    pub(super) fn grown(
        &self,
        omega: f64,
        loads: &HarmonicLoads<D>,
    ) -> Result<Solution<D>, HarmonicError> {
        let mut system = System::new(self, loads, Regime::Level(omega));
        let begin = Circumstances {
            omega,
            load_factor: SMALL,
            released: 0.0,
        };
        let unknowns = system.unknowns(&vec![0.0; self.size()], begin);
        let start = system.closed(unknowns, &Closing::LoadFactor(SMALL))?;
        let place = self.size() + 1;
        let points = system.follow(
            system.unknowns(&start.coefficients, start.at),
            [0.0, 1.0],
            &GROWING,
            &move |_, unknowns| unknowns[place],
            &Closing::LoadFactor,
        )?;
        let end = points.into_iter().next_back();
        let end = end.filter(|end| (end.solution.at.load_factor - 1.0).abs() < 1e-9);
        let mut solution = end.ok_or_else(|| not_found(omega, 1))?.solution;
        solution.regime = Regime::Forced;
        solution.at.load_factor = 1.0;
        Ok(solution)
    }

    /// The response of an amplitude at a frequency that grows with the loads out of rest.
    pub(super) fn controlled_from_rest(
        &self,
        omega: f64,
        loads: &HarmonicLoads<D>,
        target: Target,
    ) -> Result<Solution<D>, HarmonicError> {
        let linear = self.linear(omega, loads, &target.times(SMALL))?;
        let mut system = System::new(self, loads, Regime::Level(omega));
        let mut solution = system.grown_to(&linear, target)?;
        solution.regime = Regime::Controlled(target);
        Ok(solution)
    }

    fn finished(
        &self,
        points: Vec<Followed<D>>,
        options: &CurveOptions,
    ) -> Result<Vec<CurvePoint<D>>, HarmonicError> {
        let finish = |point: Followed<D>| {
            let stability = match options.with_stability {
                true => Some(self.stability(&point.solution)?),
                false => None,
            };
            Ok(CurvePoint {
                solution: point.solution,
                is_fold: point.is_fold,
                stability,
            })
        };
        points.into_iter().map(finish).collect()
    }
}

impl<const D: usize> System<'_, D> {
    /// The motion of an amplitude that grows out of a small one.
    pub(super) fn grown_to(
        &mut self,
        small: &Solution<D>,
        target: Target,
    ) -> Result<Solution<D>, HarmonicError> {
        let from = target.times(SMALL);
        let unknowns = self.unknowns(&small.coefficients, small.at);
        let start = self.closed(unknowns, &Closing::Amplitude(from))?;
        let options = CurveOptions {
            steps: GROWING,
            with_stability: false,
        };
        let ends = [from.amplitude, target.amplitude];
        let points = self.along_amplitude(&start, ends, target, &options)?;
        let end = points.into_iter().next_back().map(|end| end.solution);
        let is_there = |end: &Solution<D>| {
            let unknowns = self.unknowns(&end.coefficients, end.at);
            let reached = self.target_amplitude(&target, &unknowns);
            (reached / target.amplitude - 1.0).abs() < 1e-9
        };
        let end = end.filter(is_there);
        end.ok_or_else(|| not_found(start.at.omega, 1))
    }

    fn along_frequency(
        &mut self,
        start: &Solution<D>,
        range: [f64; 2],
        options: &CurveOptions,
    ) -> Result<Vec<CurvePoint<D>>, HarmonicError> {
        self.omega_scale = OF_RANGE * (range[1] - range[0]).abs();
        let unknowns = self.unknowns(&start.coefficients, start.at);
        let place = self.balance.size();
        let points = self.follow(
            unknowns,
            range,
            &options.steps,
            &move |_, unknowns| unknowns[place],
            &Closing::Frequency,
        )?;
        self.balance.finished(points, options)
    }

    fn along_amplitude(
        &mut self,
        start: &Solution<D>,
        amplitudes: [f64; 2],
        target: Target,
        options: &CurveOptions,
    ) -> Result<Vec<CurvePoint<D>>, HarmonicError> {
        let unknowns = self.unknowns(&start.coefficients, start.at);
        let points = self.follow(
            unknowns,
            amplitudes,
            &options.steps,
            &move |system, unknowns| system.target_amplitude(&target, unknowns),
            &move |amplitude| Closing::Amplitude(at(target, amplitude)),
        )?;
        let options = CurveOptions {
            with_stability: options.with_stability && matches!(self.regime, Regime::Resonance(_)),
            ..*options
        };
        self.balance.finished(points, &options)
    }
}

fn at(target: Target, amplitude: f64) -> Target {
    Target {
        amplitude,
        ..target
    }
}

fn check_range([from, to]: [f64; 2], what: &'static str) -> Result<(), HarmonicError> {
    let is_positive = |value: f64| value.is_finite() && value > 0.0;
    let expected = "two different positive numbers";
    match [from, to].into_iter().find(|&value| !is_positive(value)) {
        Some(found) => Err(HarmonicError::Value {
            what,
            found,
            expected,
        }),
        None if from == to => Err(HarmonicError::Value {
            what,
            found: to,
            expected,
        }),
        None => Ok(()),
    }
}
