//! Phase resonance of a run, measured and predicted at the force that was measured there.

mod between;
mod curve;
mod own_curve;
mod scatter;

use std::f64::consts::{FRAC_PI_2, TAU};

use nalgebra::{DMatrix, DVector, Matrix2, Vector2};
use num_complex::Complex64;
use serde::Serialize;

use super::data::{SineLine, SineRun, Use, wrapped};
use super::fit::Fit;
use super::model::{Model, Motion, Values};

pub use self::between::{BetweenRuns, RunScatter};
pub(super) use self::curve::Spread;
use self::scatter::Scatter;

pub use self::curve::{BackbonePrediction, Expected, Fall, PointPrediction};
pub use self::own_curve::CurvePoint;
pub(super) use self::own_curve::own_curve;
pub use self::scatter::NoInterval;

const ITERATIONS: usize = 100;
/// Step of the numerical derivatives and relative accuracy of the result.
const STEP: f64 = 1e-7;
const ACCURACY: f64 = 1e-10;

/// A phase resonance: displacement a quarter of a period behind the force.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Resonance {
    /// Hz
    pub frequency_hz: f64,
    /// Amplitude of the force, N.
    pub force_n: f64,
    /// Amplitude of the displacement, m.
    pub displacement_m: f64,
}

impl Resonance {
    /// What a line of a run would have there, with this phase.
    fn line(&self, phase_rad: f64) -> SineLine {
        SineLine {
            omega: TAU * self.frequency_hz,
            force_n: self.force_n,
            displacement_m: self.displacement_m,
            phase_rad,
        }
    }
}

/// A run that was left out, and why nothing of it is predicted.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Unpredicted {
    /// The run.
    pub run: String,
    /// Why.
    pub reason: &'static str,
}

/// Why a run has nothing that a resonance could be compared with.
const NO_CROSSING: &str = "no two neighbouring lines have the phase of a resonance between them";

/// A run's resonance beside the model's.
#[derive(Clone, Debug, Serialize)]
pub struct Prediction {
    /// The run.
    pub run: String,
    /// What resonates.
    pub motion: Motion,
    /// Whether the run was left out of the estimate.
    pub left_out: bool,
    /// Measured.
    pub measured: Resonance,
    /// Of the model at the same force; `None` if it has none there.
    pub predicted: Option<Resonance>,
    /// Within which a measurement is expected, with 95 %.
    pub interval_95: Option<ResonanceInterval>,
    /// Why there is no such interval.
    pub no_interval: Option<NoInterval>,
    #[serde(skip)]
    gradients: Option<Gradients>,
}

/// Where a run's resonance is expected.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ResonanceInterval {
    /// Hz
    pub frequency_hz: [f64; 2],
    /// Amplitude of the displacement, m.
    pub displacement_m: [f64; 2],
}

/// How a resonance changes along the directions of the unknowns, each in its standard deviations: Hz, and the logarithm of the
/// displacement's amplitude.
#[derive(Clone, Debug, PartialEq)]
struct Gradients {
    by_unknown: [DVector<f64>; 2],
}

/// Part of an unknown's standard deviation by which it is moved for a difference.
const PART: f64 = 0.1;

impl Prediction {
    /// Of all runs; `covariance` is that of the unknowns as they are searched. Runs scatter about each resonance on their own.
    pub(super) fn of_all(
        model: &Model,
        fit: &Fit,
        runs: &[SineRun],
        covariance: &DMatrix<f64>,
    ) -> (Vec<Self>, Vec<Unpredicted>) {
        let directions = directions(&fit.within_limits(covariance));
        let mut all: Vec<Self> = Vec::new();
        let mut unpredicted = Vec::new();
        for run in runs {
            let own = Self::of(model, &fit.values, run, &directions);
            if own.is_empty() && run.used_for == Use::Predict {
                unpredicted.push(Unpredicted {
                    run: run.name.clone(),
                    reason: NO_CROSSING,
                });
            }
            all.extend(own);
        }
        for motion in Motion::ALL {
            let scatter = Scatter::of(all.iter().filter(|row| row.motion == motion));
            for row in all.iter_mut().filter(|row| row.motion == motion) {
                match row.expected(&scatter) {
                    Ok(interval) => row.interval_95 = Some(interval),
                    Err(reason) => row.no_interval = Some(reason),
                }
            }
        }
        (all, unpredicted)
    }

    /// The resonances that a run has, one of each motion at most.
    fn of(model: &Model, values: &Values, run: &SineRun, directions: &DMatrix<f64>) -> Vec<Self> {
        let measured = measured_resonances(model, values, run).into_iter();
        let beside = measured.map(|(motion, measured)| {
            let predicted = predicted_resonance(model, values, motion, &measured);
            let gradients = predicted
                .and_then(|at| gradients(model, values, motion, (&measured, &at), directions));
            Self {
                run: run.name.clone(),
                motion,
                left_out: run.used_for == Use::Predict,
                measured,
                predicted,
                interval_95: None,
                no_interval: None,
                gradients,
            }
        });
        beside.collect()
    }

    /// Where a measurement of it is expected, by what the unknowns leave open and how runs scatter.
    fn expected(
        &self,
        scatter: &Result<Scatter, NoInterval>,
    ) -> Result<ResonanceInterval, NoInterval> {
        let at = self.predicted.ok_or(NoInterval::NoResonance)?;
        let own = self.gradients.as_ref().ok_or(NoInterval::Vanishes)?;
        let [of_frequency, of_displacement] =
            scatter.as_ref().map_err(|reason| *reason)?.halves(own);
        let factor = of_displacement.exp();
        Ok(ResonanceInterval {
            frequency_hz: [
                at.frequency_hz - of_frequency,
                at.frequency_hz + of_frequency,
            ],
            displacement_m: [at.displacement_m / factor, at.displacement_m * factor],
        })
    }

    /// Amplitude of the relative motion at the measured resonance, m.
    pub(super) fn relative_m(&self, model: &Model, values: &Values) -> f64 {
        let phase_rad = model.phase_of_resonance(self.motion);
        let phase_rad = phase_rad.unwrap_or(-FRAC_PI_2);
        relative_m(model, values, &self.measured, phase_rad)
    }

    /// Error of the frequency, Hz.
    #[must_use]
    pub fn frequency_error_hz(&self) -> Option<f64> {
        Some(self.predicted?.frequency_hz - self.measured.frequency_hz)
    }

    /// Relative error of the acceleration's amplitude.
    #[must_use]
    pub fn amplitude_error(&self) -> Option<f64> {
        let acceleration = |at: &Resonance| at.displacement_m * at.frequency_hz.powi(2);
        Some(acceleration(&self.predicted?) / acceleration(&self.measured) - 1.0)
    }
}

/// Directions of the unknowns, each as long as its standard deviation: columns L with a covariance of L Lᵀ. A direction that
/// limits have taken away is none.
fn directions(covariance: &DMatrix<f64>) -> DMatrix<f64> {
    let scale = covariance.diagonal().map(|variance| match variance > 0.0 {
        true => variance.sqrt(),
        false => 0.0,
    });
    let size = scale.len();
    let correlation = DMatrix::from_fn(size, size, |i, j| {
        let by = scale[i] * scale[j];
        if by > 0.0 {
            covariance[(i, j)] / by
        } else {
            0.0
        }
    });
    let eigen = correlation.symmetric_eigen();
    let lengths = eigen.eigenvalues.map(|value| value.max(0.0).sqrt());
    let kept: Vec<usize> = (0..size).filter(|&n| lengths[n] > ACCURACY).collect();
    DMatrix::from_fn(size, kept.len(), |i, n| {
        scale[i] * eigen.eigenvectors[(i, kept[n])] * lengths[kept[n]]
    })
}

/// How a resonance changes along the unknowns' directions, by differences.
fn gradients(
    model: &Model,
    values: &Values,
    motion: Motion,
    (measured, predicted): (&Resonance, &Resonance),
    directions: &DMatrix<f64>,
) -> Option<Gradients> {
    let none = DVector::zeros(directions.ncols());
    let mut by_unknown = [none.clone(), none];
    for (place, direction) in directions.column_iter().enumerate() {
        let moved = model.moved(values, &(PART * direction));
        let found = predicted_resonance(model, &moved, motion, measured)?;
        by_unknown[0][place] = (found.frequency_hz - predicted.frequency_hz) / PART;
        by_unknown[1][place] = (found.displacement_m / predicted.displacement_m).ln() / PART;
    }
    Some(Gradients { by_unknown })
}

/// Where the measured phase falls through that of a motion's resonance, the first of each motion.
fn measured_resonances(model: &Model, values: &Values, run: &SineRun) -> Vec<(Motion, Resonance)> {
    let mut found: Vec<(Motion, Resonance)> = Vec::new();
    for motion in Motion::ALL {
        let Some(phase_rad) = model.phase_of_resonance(motion) else {
            continue;
        };
        // both motions may have the same phase there
        let is_of = |at: &Resonance| {
            !model.sees_sum() || {
                let amplitude_m = model.relative_amplitude(values, &at.line(phase_rad));
                model.strongest(values, amplitude_m, TAU * at.frequency_hz) == motion
            }
        };
        let way = match model.sees_sum() {
            true => Between::Load,
            false => Between::Phase,
        };
        let mut all = crossings(run, phase_rad, way);
        let first = all.find(|at| at.displacement_m > 0.0 && is_of(at));
        found.extend(first.map(|at| (motion, at)));
    }
    found
}

/// Where the measured phase falls through a value, between two lines each.
fn crossings(run: &SineRun, phase_rad: f64, way: Between) -> impl Iterator<Item = Resonance> {
    run.lines.windows(2).filter_map(move |pair| {
        let [before, after] = [pair[0], pair[1]];
        let [from, to] = [before, after].map(|line| wrapped(line.phase_rad - phase_rad));
        if !(from > 0.0 && to <= 0.0 && from - to < FRAC_PI_2 * 2.0) {
            return None;
        }
        Some(way.crossing([&before, &after], [from, to]))
    })
}

/// What is a straight line between two lines.
#[derive(Clone, Copy)]
enum Between {
    /// The phase, as descriptions of measurements have it.
    Phase,
    /// The load over the motion: so it is near a resonance, however few lines that has. That of both bodies together is narrow.
    Load,
}

impl Between {
    /// Where the phase is right, of lines with a phase above and below that.
    fn crossing(self, [before, after]: [&SineLine; 2], [above, below]: [f64; 2]) -> Resonance {
        let stiffness = |line: &SineLine, phase_rad: f64| {
            Complex64::from_polar(line.force_n / line.displacement_m, -phase_rad)
        };
        let [from, to] = [stiffness(before, above), stiffness(after, below)];
        let share = match self {
            Self::Phase => above / (above - below),
            Self::Load => from.im / (from.im - to.im),
        };
        let between = |from: f64, to: f64| from + share * (to - from);
        let force_n = between(before.force_n, after.force_n);
        let displacement_m = match self {
            Self::Phase => between(before.displacement_m, after.displacement_m),
            Self::Load => force_n / between(from.re, to.re),
        };
        Resonance {
            frequency_hz: between(before.omega, after.omega) / TAU,
            force_n,
            displacement_m,
        }
    }
}

/// Amplitude of the relative motion at a resonance with this phase, m.
fn relative_m(model: &Model, values: &Values, at: &Resonance, phase_rad: f64) -> f64 {
    match model.sees_sum() {
        true => model.relative_amplitude(values, &at.line(phase_rad)),
        false => at.displacement_m / model.relative_share().abs(),
    }
}

/// The model's resonance of a motion at the force of `near`, by Newton's method on frequency and amplitude from there.
fn predicted_resonance(
    model: &Model,
    values: &Values,
    motion: Motion,
    near: &Resonance,
) -> Option<Resonance> {
    let phase_rad = model.phase_of_resonance(motion)?;
    let relative_m = relative_m(model, values, near, phase_rad);
    let scale_omega = TAU * near.frequency_hz;
    let equations = |place: &Vector2<f64>| {
        let omega = scale_omega * place[0].exp();
        let (receptance, force) = model.receptance(values, relative_m * place[1].exp(), omega);
        Vector2::new(
            wrapped(receptance.arg() - phase_rad),
            (force / near.force_n).ln(),
        )
    };
    let mut place = Vector2::zeros();
    for _ in 0..ITERATIONS {
        let value = equations(&place);
        let column = |axis: usize| {
            let mut moved = place;
            moved[axis] += STEP;
            (equations(&moved) - value) / STEP
        };
        let jacobian = Matrix2::from_columns(&[column(0), column(1)]);
        let step = jacobian.lu().solve(&-value)?;
        // The phase turns within the width of the resonance: no step is wider than a few.
        let longest = (step[0].abs() / 2e-3).max(step[1].abs() / 0.3).max(1.0);
        place += step / longest;
        if !place.iter().all(|entry| entry.is_finite()) {
            return None;
        }
        if step.amax() < ACCURACY {
            let omega = scale_omega * place[0].exp();
            let amplitude_m = relative_m * place[1].exp();
            let (receptance, force) = model.receptance(values, amplitude_m, omega);
            let is_own = model.strongest(values, amplitude_m, omega) == motion;
            return is_own.then(|| Resonance {
                frequency_hz: omega / TAU,
                force_n: near.force_n,
                displacement_m: receptance.norm() * force,
            });
        }
    }
    None
}
