//! Phase resonance of a run, measured and predicted at the force that was measured there.

mod between;
mod curve;
mod scatter;

use std::f64::consts::{FRAC_PI_2, TAU};

use nalgebra::{DMatrix, DVector, Matrix2, Vector2};
use serde::Serialize;

use super::data::{SineRun, Use, wrapped};
use super::fit::Fit;
use super::model::{Model, Values};

pub use self::between::{BetweenRuns, RunScatter};
pub(super) use self::curve::Spread;
use self::scatter::Scatter;

pub use self::curve::{BackbonePrediction, Expected, Fall, PointPrediction};
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

/// A run's resonance beside the model's.
#[derive(Clone, Debug, Serialize)]
pub struct Prediction {
    /// The run.
    pub run: String,
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
    /// Of all runs; `covariance` is that of the unknowns as they are searched.
    pub(super) fn of_all(
        model: &Model,
        fit: &Fit,
        runs: &[SineRun],
        covariance: &DMatrix<f64>,
    ) -> Vec<Self> {
        let directions = directions(&fit.within_limits(covariance));
        let runs = runs.iter();
        let mut all: Vec<Self> = runs
            .filter_map(|run| Self::of(model, &fit.values, run, &directions))
            .collect();
        let scatter = Scatter::of(&all);
        for row in &mut all {
            match row.expected(&scatter) {
                Ok(interval) => row.interval_95 = Some(interval),
                Err(reason) => row.no_interval = Some(reason),
            }
        }
        all
    }

    fn of(
        model: &Model,
        values: &Values,
        run: &SineRun,
        directions: &DMatrix<f64>,
    ) -> Option<Self> {
        let measured = measured_resonance(run)?;
        let predicted = predicted_resonance(model, values, &measured);
        let gradients =
            predicted.and_then(|at| gradients(model, values, &measured, &at, directions));
        Some(Self {
            run: run.name.clone(),
            left_out: run.used_for == Use::Predict,
            measured,
            predicted,
            interval_95: None,
            no_interval: None,
            gradients,
        })
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
    measured: &Resonance,
    predicted: &Resonance,
    directions: &DMatrix<f64>,
) -> Option<Gradients> {
    let none = DVector::zeros(directions.ncols());
    let mut by_unknown = [none.clone(), none];
    for (place, direction) in directions.column_iter().enumerate() {
        let moved = model.moved(values, &(PART * direction));
        let found = predicted_resonance(model, &moved, measured)?;
        by_unknown[0][place] = (found.frequency_hz - predicted.frequency_hz) / PART;
        by_unknown[1][place] = (found.displacement_m / predicted.displacement_m).ln() / PART;
    }
    Some(Gradients { by_unknown })
}

/// Where the measured phase passes −90°, by linear interpolation between the lines.
#[must_use]
pub fn measured_resonance(run: &SineRun) -> Option<Resonance> {
    run.lines.windows(2).find_map(|pair| {
        let [before, after] = [pair[0], pair[1]];
        let (from, to) = (before.phase_rad + FRAC_PI_2, after.phase_rad + FRAC_PI_2);
        if !(from > 0.0 && to <= 0.0 && from - to < FRAC_PI_2 * 2.0) {
            return None;
        }
        let share = from / (from - to);
        let between = |from: f64, to: f64| from + share * (to - from);
        Some(Resonance {
            frequency_hz: between(before.omega, after.omega) / TAU,
            force_n: between(before.force_n, after.force_n),
            displacement_m: between(before.displacement_m, after.displacement_m),
        })
    })
}

/// The model's resonance at the force of `near`, by Newton's method on frequency and amplitude from there.
#[must_use]
pub fn predicted_resonance(model: &Model, values: &Values, near: &Resonance) -> Option<Resonance> {
    let share = model.relative_share().abs();
    let scale_omega = TAU * near.frequency_hz;
    let equations = |place: &Vector2<f64>| {
        let omega = scale_omega * place[0].exp();
        let (receptance, force) =
            model.receptance(values, near.displacement_m / share * place[1].exp(), omega);
        // arg h = −90°, |F| = F
        Vector2::new(
            wrapped(receptance.arg() + FRAC_PI_2),
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
            let (receptance, force) =
                model.receptance(values, near.displacement_m / share * place[1].exp(), omega);
            return Some(Resonance {
                frequency_hz: omega / TAU,
                force_n: near.force_n,
                displacement_m: receptance.norm() * force,
            });
        }
    }
    None
}
