//! Curves of periodic motions: amplitude over frequency at given loads or at a given amplitude, and backbones.

use super::balance::HarmonicBalance;
use super::condensed::Circumstances;
use super::continuation::Followed;
use super::stability::Stability;
use super::system::{Closing, Regime, System};
use super::{HarmonicError, HarmonicLoads, Solution, Steps, Target};

/// Part of the range of frequencies that counts as much as the motion's change by itself.
const OF_RANGE: f64 = 0.1;

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
    /// Whether the stability of each motion is computed.
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
        let factor = 1e-3;
        let begin = Circumstances {
            omega,
            load_factor: factor,
            released: 0.0,
        };
        let mut unknowns = system.unknowns(&vec![0.0; self.size()], begin);
        let scale = system.scale(&unknowns);
        let closing = Closing::LoadFactor(factor);
        let refuse = || super::solution::not_found(omega, 1);
        let _ = system
            .correct(&mut unknowns, &closing, &scale, 60, false)
            .ok_or_else(refuse)?;
        let place = self.size() + 1;
        let points = system.follow(
            unknowns,
            [0.0, 1.0],
            &Steps {
                longest: 0.5,
                first: 0.5,
                ..Steps::default()
            },
            &move |_, unknowns| unknowns[place],
            &Closing::LoadFactor,
        )?;
        let end = points
            .last()
            .filter(|end| end.solution.at.load_factor == 1.0);
        let mut solution = end.ok_or_else(refuse)?.solution.clone();
        solution.regime = Regime::Forced;
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
