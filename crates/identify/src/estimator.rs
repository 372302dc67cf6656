//! Maximum likelihood on the assembly's receptances by reweighted Gauss–Newton, over all lines and entries at once.
//!
//! Weights are held while a Levenberg–Marquardt iteration with the exact Jacobian converges, then renewed from the
//! computed receptances, until nothing moves. Holding them keeps the score free of bias: an estimator that could gain by
//! raising its own σ would. For the same reason ln det of J Σ_H Jᴴ does not count: the errors of the substructures are
//! unknowns of their own (see `objective`), not part of the residual's variance.

use std::sync::Arc;

use nalgebra::{DMatrix, DVector};

use super::likelihood::log_variances;
use super::marquardt::{Control, Damping, levenberg_marquardt};
use super::noise::{Levels, Noise, Size};
use super::normal::{Normal, TOLERANCE, relative_change};
use super::objective::{Corrections, Objective, State, Weights};
use super::scoring::scored;

/// How the unknowns follow from the coordinates in which they are sought.
pub(super) trait Chart {
    /// The unknowns at these coordinates.
    fn unknowns(&self, coordinates: &DVector<f64>) -> DVector<f64>;
    /// Their derivative by the coordinates; `None` where they are the coordinates.
    fn derivative(&self, coordinates: &DVector<f64>) -> Option<DMatrix<f64>>;
}

/// The unknowns themselves.
pub(super) struct Free;

impl Chart for Free {
    fn unknowns(&self, coordinates: &DVector<f64>) -> DVector<f64> {
        coordinates.clone()
    }

    fn derivative(&self, _coordinates: &DVector<f64>) -> Option<DMatrix<f64>> {
        None
    }
}

impl State {
    /// Its normal equations by the coordinates.
    pub(super) fn normal_in(&self, chart: &dyn Chart, coordinates: &DVector<f64>) -> Normal {
        match chart.derivative(coordinates) {
            Some(derivative) => self.normal.in_chart(&derivative),
            None => self.normal.clone(),
        }
    }
}

/// Where the estimator came to rest.
#[derive(Clone, Debug)]
pub(super) struct Estimate {
    /// Stiffness of each entry of the joint model, then damping.
    pub(super) unknowns: DVector<f64>,
    /// χ²/2: Σ|residual|² with the final weights.
    pub(super) cost: f64,
    /// −2 log-likelihood up to a constant; where noise is not stated the common scale of the variances is profiled out.
    pub(super) misfit: f64,
    /// [`Objective::standing`] on all lines that starts are tried on, once there is another estimate to be ranked with.
    pub(super) standing: Option<f64>,
    /// Complex numbers measured.
    pub(super) measurements: usize,
    /// Real residuals minus unknowns.
    pub(super) degrees_of_freedom: usize,
    /// JᵀΣ⁻¹J by the unknowns; the information is twice that.
    pub(super) information: DMatrix<f64>,
    pub(super) levels: Levels,
    pub(super) converged: bool,
    /// By how many standard deviations the last round moved an unknown, at most; infinite where that round did not end.
    pub(super) unrest: f64,
    pub(super) corrections: Corrections,
}

impl Estimate {
    /// The same, its corrections given up for the memory that they take.
    pub(super) fn without_corrections(self) -> Self {
        Self {
            corrections: Corrections::default(),
            ..self
        }
    }

    /// Noise and unknowns: where it is.
    pub(super) fn place(&self) -> (Levels, &DVector<f64>) {
        (self.levels, &self.unknowns)
    }

    /// The misfit for each number measured: what estimates on different lines are compared by.
    pub(super) fn misfit_of_each(&self) -> f64 {
        self.misfit / self.measurements as f64
    }

    /// χ² over degrees of freedom: twice the cost, because σ² is the sum of the variances of two parts.
    pub(super) fn reduced_chi_squared(&self) -> Option<f64> {
        (self.degrees_of_freedom > 0).then(|| 2.0 * self.cost / self.degrees_of_freedom as f64)
    }
}

const MAX_REWEIGHTINGS: usize = 20;
const MAX_ITERATIONS: usize = 100;
/// The same where corrections of the substructures follow each step.
const MAX_ITERATIONS_OF_CORRECTED: usize = 40;
/// Gain that the full Gauss–Newton step promises, as a fraction of the cost, below which the iteration has converged.
const NEGLIGIBLE_GAIN: f64 = 1e-13;
/// The same where corrections of the substructures follow each step, as a part of a residual's mean square: a hundredth of a
/// standard deviation.
const NEGLIGIBLE_GAIN_OF_CORRECTED: f64 = 1e-4;
/// The same between many joints, where steps near the minimum shrink slowly: a thirtieth of a standard deviation.
const NEGLIGIBLE_GAIN_OF_MANY: f64 = 1e-3;
/// Change of every unknown, in standard deviations, below which renewing the weights changes nothing that matters.
const NEGLIGIBLE_SHIFT: f64 = 1e-5;
/// Gain that is enough before the weights are renewed anyway.
pub(super) const GAIN_BEFORE_RENEWAL: f64 = 1e-6;
/// Promised gain below which the weights follow each step, as long as the promise falls with each …
const NEAR: f64 = 1e-2;
/// … to this part, at least.
const FALL: f64 = 0.1;

/// Estimates the unknowns from `start` coordinates; `None` if the start cannot be evaluated.
///
/// With `levels`, as for the trial of a start, the weights follow from them and no level is estimated, and an iteration that
/// wanders is given up.
pub(super) fn estimate(
    objective: &Objective<'_>,
    noise: &Noise,
    levels: Option<Levels>,
    chart: &dyn Chart,
    start: &DVector<f64>,
    corrections: Option<Corrections>,
) -> Option<Estimate> {
    let is_trial = levels.is_some();
    let estimates_level = levels.is_none() && !noise.is_stated();
    let mut levels = levels.unwrap_or_else(|| first_levels(noise));
    let mut coordinates = start.clone();
    let (mut weights, mut state) = objective.renewed(levels, chart.unknowns(start), corrections)?;
    let measurements = objective.measurements();
    let unknowns = start.len();
    let shrinkage = 1.0 - unknowns as f64 / (2 * measurements) as f64;
    let mut converged = false;
    let mut unrest = f64::INFINITY;
    let mut damping = Damping::first(objective);
    for round in 0..MAX_REWEIGHTINGS {
        if !estimates_level {
            let near = follow(objective, levels, chart, (coordinates, weights, state))?;
            (coordinates, weights, state) = near.point;
            if near.has_settled {
                converged = true;
                unrest = 0.0;
                break;
            }
        }
        let gain = if round == 0 {
            GAIN_BEFORE_RENEWAL
        } else {
            negligible_gain(objective)
        };
        let control = Control {
            negligible_gain: gain,
            damping,
            most: most_iterations(objective),
        };
        let rest = if objective.holds {
            scored(objective, &weights, chart, &coordinates, state, gain)
        } else {
            levenberg_marquardt(objective, &weights, chart, &coordinates, state, control)
        };
        damping = rest.damping;
        let moved = relative_change(&coordinates, &rest.coordinates, &rest.scale);
        // In standard deviations, at least: σ ≥ 1/√(JᵀΣ⁻¹J)_ii times that of the residual, S/N.
        let deviation = &rest.scale * (rest.state.normal.cost / measurements as f64).sqrt();
        let step = (&rest.coordinates - &coordinates).component_div(&deviation);
        let shift = step.amax();
        let settled = rest.settled;
        unrest = if settled { shift } else { f64::INFINITY };
        coordinates = rest.coordinates;
        // Two sets of them at a time would be much memory.
        drop(weights);
        if estimates_level && shrinkage > 0.0 {
            levels = noise.levels(objective.level(noise, &rest.state, shrinkage)?);
        }
        let State {
            unknowns,
            corrections,
            ..
        } = rest.state;
        (weights, state) = objective.renewed(levels, unknowns, Some(corrections))?;
        let is_long = !objective.is_independent() || objective.has_many_joints();
        if (is_trial || is_long) && !settled {
            // It wanders, and renewed weights would not lead it back.
            break;
        }
        if round > 0 && (moved < 100.0 * TOLERANCE || shift < NEGLIGIBLE_SHIFT) {
            converged = settled;
            break;
        }
    }
    let end = (weights, state, levels);
    Some(arrived(objective, noise, end, (converged, unrest)))
}

/// The estimate at a point with the weights that it gives itself: whether it has converged, and its unrest.
pub(super) fn arrived(
    objective: &Objective<'_>,
    noise: &Noise,
    (weights, state, levels): (Vec<Weights>, State, Levels),
    (converged, unrest): (bool, f64),
) -> Estimate {
    let (measurements, unknowns) = (objective.measurements(), state.unknowns.len());
    let log_determinant = objective.log_variances_of_scatter(&weights) + log_variances(&weights)
        - objective.log_powers();
    let cost = state.normal.cost;
    Estimate {
        unknowns: state.unknowns,
        cost,
        misfit: misfit(noise, cost, log_determinant, measurements),
        standing: None,
        measurements,
        degrees_of_freedom: (2 * measurements).saturating_sub(unknowns),
        information: state.normal.matrix,
        levels,
        converged,
        unrest,
        corrections: state.corrections,
    }
}

/// −2 log-likelihood up to a constant; where noise is not stated the common scale of the variances is profiled out.
pub(super) fn misfit(noise: &Noise, cost: f64, log_determinant: f64, measurements: usize) -> f64 {
    let count = measurements as f64;
    // −2 ln L = 2 Σ|r|²/σ² + 2 Σ ln σ², with the scale of σ profiled out 2 N ln(Σ|r|²/σ² / N) + 2 Σ ln σ² + 2 N
    if noise.is_stated() {
        2.0 * (cost + log_determinant)
    } else {
        2.0 * (count * (cost / count).ln() + count + log_determinant)
    }
}

/// A point with the weights that it gives itself.
type Weighted = (DVector<f64>, Vec<Weights>, State);

/// Where weights that follow each step led.
struct Near {
    point: Weighted,
    has_settled: bool,
}

/// Full steps from a point near the minimum, each with the weights of the point before it: there the promise falls with each,
/// whatever the weights do, and no step has to be tried with weights that are held. Far from it the point stays where it is.
fn follow(
    objective: &Objective<'_>,
    levels: Levels,
    chart: &dyn Chart,
    mut point: Weighted,
) -> Option<Near> {
    let settled = |point, has_settled| Some(Near { point, has_settled });
    let mut normal = point.2.normal_in(chart, &point.0);
    loop {
        if normal.is_settled(&point.0, negligible_gain(objective)) {
            return settled(point, true);
        }
        let promise = normal.promise().filter(|promise| *promise < NEAR);
        let (Some(promise), Some(step)) = (promise, normal.step(1e-12)) else {
            return settled(point, false);
        };
        let coordinates = &point.0 + step;
        let corrections = Some(Arc::clone(&point.2.corrections));
        let next = objective.renewed(levels, chart.unknowns(&coordinates), corrections);
        let Some((weights, state)) = next else {
            return settled(point, false);
        };
        normal = state.normal_in(chart, &coordinates);
        if !normal.promise().is_some_and(|next| next <= FALL * promise) {
            return settled(point, false);
        }
        point = (coordinates, weights, state);
    }
}

fn negligible_gain(objective: &Objective<'_>) -> f64 {
    let of_each = match (objective.is_independent(), objective.has_many_joints()) {
        (true, false) => return NEGLIGIBLE_GAIN,
        (true, true) => NEGLIGIBLE_GAIN_OF_MANY,
        (false, _) => NEGLIGIBLE_GAIN_OF_CORRECTED,
    };
    of_each / objective.measurements() as f64
}

/// Levels to begin with: what is not stated is proportional to the receptance, unless that is stated to be exact.
pub(super) fn first_levels(noise: &Noise) -> Levels {
    let has_floor = noise.assembly.relative == Some(0.0) || noise.is_stated();
    noise.levels(Size {
        relative: 1.0,
        floor: f64::from(u8::from(has_floor)),
    })
}

/// Where the cost with these weights is lowest, roughly.
pub(super) fn minimum(
    objective: &Objective<'_>,
    weights: &[Weights],
    start: &DVector<f64>,
) -> Option<State> {
    let state = objective.at(weights, start.clone(), None)?;
    let control = Control {
        negligible_gain: GAIN_BEFORE_RENEWAL,
        damping: Damping::first(objective),
        most: most_iterations(objective),
    };
    let rest = levenberg_marquardt(objective, weights, &Free, start, state, control);
    Some(rest.state)
}

fn most_iterations(objective: &Objective<'_>) -> usize {
    if objective.is_independent() {
        MAX_ITERATIONS
    } else {
        MAX_ITERATIONS_OF_CORRECTED
    }
}
