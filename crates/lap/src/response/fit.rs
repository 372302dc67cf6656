//! Maximum likelihood: the model's numbers and the true amplitude of every line at once. The amplitudes are eliminated line by
//! line, so that what is left is as small as the model.

mod amplitude;

use nalgebra::{DMatrix, DVector};

use self::amplitude::{LONGEST, dot, settled, unit};
use super::backbone::{BackboneLine, BackboneRun};
use super::data::SineLine;
use super::dynamic_stiffness::RelativeMotion;
use super::model::{LineResidual, Model, Values};
use super::passive::{Bound, Limit, Passive};
use super::step::damped_step;
use super::study::Noise;
use crate::error::LapError;

const STEPS: usize = 200;
/// Steps of a first look.
const FIRST_STEPS: usize = 12;
/// Relative decrease of χ² that is none.
const AT_REST: f64 = 1e-10;
const DAMPING: f64 = 1e-4;
const MOST_DAMPING: f64 = 1e12;
/// How often the largest displacement, which the limits go up to, follows the fit, and when it has come to rest.
const FOLLOWED: usize = 6;
const FOLLOWS: f64 = 1e-9;

/// A fitted model.
#[derive(Clone, Debug)]
pub struct Fit {
    /// The values.
    pub values: Values,
    /// The relative amplitude of each line, m.
    pub amplitudes_m: Vec<f64>,
    /// χ²: sum of the squared residuals in standard deviations.
    pub chi_squared: f64,
    /// Data less unknowns: two for each line, less the model's.
    pub degrees_of_freedom: usize,
    /// Information matrix of the unknowns in the order of the model's.
    pub information: DMatrix<f64>,
    /// Largest amplitude of the relative motion that was fitted, m: a passive joint takes energy up to there.
    pub amplitude_m: f64,
    /// Limits that the estimate stands at because the joint has to be passive.
    pub at_limits: Vec<AtLimit>,
    /// By how much a further step within the limits would lower χ²: nothing where the conditions of Karush, Kuhn and Tucker hold.
    pub left: f64,
}

impl Fit {
    /// χ² per degree of freedom.
    #[must_use]
    pub fn reduced_chi_squared(&self) -> f64 {
        self.chi_squared / self.degrees_of_freedom.max(1) as f64
    }

    /// Whether a limit of nothing else but this unknown holds the estimate.
    pub(super) fn is_held(&self, place: usize) -> bool {
        self.at_limits.iter().any(|at| {
            let mut others = at.gradient.clone();
            others[place] = 0.0;
            at.gradient[place] != 0.0 && others.norm_squared() == 0.0
        })
    }

    /// A covariance of the unknowns without the directions that the limits take away: Σ − ΣAᵀ(AΣAᵀ)⁻¹AΣ.
    pub(super) fn within_limits(&self, covariance: &DMatrix<f64>) -> DMatrix<f64> {
        let mut left = covariance.clone();
        // one limit after the other
        for at in &self.at_limits {
            let along = &left * &at.gradient;
            let variance = at.gradient.dot(&along);
            if variance > 0.0 {
                left.ger(-variance.recip(), &along, &along, 1.0);
            }
        }
        left
    }
}

/// A limit that an estimate stands at.
#[derive(Clone, Debug)]
pub struct AtLimit {
    /// Which.
    pub limit: Limit,
    /// By how much χ² falls with what is limited, in the reciprocal of its unit; not negative.
    pub multiplier: f64,
    /// What is limited, by the unknowns.
    pub(super) gradient: DVector<f64>,
}

/// What a model is fitted to.
#[derive(Clone, Copy, Debug)]
pub(super) struct Data<'a> {
    pub(super) lines: &'a [SineLine],
    pub(super) backbones: &'a [&'a BackboneRun],
}

impl<'a> Data<'a> {
    /// Numbers beyond the amplitudes.
    fn count(&self) -> usize {
        2 * self.lines.len() + self.points().map(BackboneLine::count).sum::<usize>()
    }

    /// Points of all backbones and decays.
    pub(super) fn points(&self) -> impl Iterator<Item = &'a BackboneLine> + use<'a> {
        self.backbones.iter().flat_map(|run| &run.lines)
    }
}

/// Where a fit starts.
#[derive(Clone, Copy, Debug)]
pub(super) struct Start<'a> {
    values: &'a Values,
    /// The relative amplitude of each line, m, where an earlier fit to the same lines found them.
    amplitudes_m: Option<&'a [f64]>,
}

impl<'a> From<&'a Values> for Start<'a> {
    fn from(values: &'a Values) -> Self {
        Self {
            values,
            amplitudes_m: None,
        }
    }
}

/// A fit goes on with the amplitudes that it has: a line may have two of them, of which another guess could be the worse one.
impl<'a> From<&'a Fit> for Start<'a> {
    fn from(fit: &'a Fit) -> Self {
        Self {
            values: &fit.values,
            amplitudes_m: Some(&fit.amplitudes_m),
        }
    }
}

impl Start<'_> {
    /// The relative amplitude of each line, m.
    fn amplitudes_m(&self, model: &Model, data: Data<'_>) -> Vec<f64> {
        match self.amplitudes_m {
            Some(found) if found.len() == data.lines.len() => found.to_vec(),
            _ => {
                let lines = data.lines.iter();
                lines
                    .map(|line| model.relative_amplitude(self.values, line))
                    .collect()
            }
        }
    }

    /// Largest displacement that it makes of the data, m.
    fn largest_m(&self, model: &Model, data: Data<'_>) -> f64 {
        let of_points = data.points().map(|line| line.amplitude_m);
        let of_lines = self.amplitudes_m(model, data).into_iter();
        of_lines.chain(of_points).fold(f64::MIN_POSITIVE, f64::max)
    }
}

/// Whether an estimate may be active.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Free,
    Passive,
}

/// Everything about one place in the space of unknowns.
struct State {
    values: Values,
    log_amplitudes: Vec<f64>,
    lines: Vec<LineResidual>,
    /// Residual and derivatives of each number of the backbones.
    backbone: Vec<(f64, Vec<f64>)>,
    chi_squared: f64,
}

impl State {
    fn new(
        model: &Model,
        data: Data<'_>,
        noise: &Noise,
        values: Values,
        log_amplitudes: Vec<f64>,
    ) -> Self {
        let motion = RelativeMotion::new(&values, model.harmonics);
        let pairs = data.lines.iter().zip(log_amplitudes);
        let settled = pairs.map(|(line, log_amplitude)| {
            settled(log_amplitude, |log_amplitude| {
                model.residual(&values, &motion, line, log_amplitude, noise)
            })
        });
        let (log_amplitudes, lines): (Vec<f64>, Vec<LineResidual>) = settled.unzip();
        let runs = data.backbones.iter();
        let backbone: Vec<(f64, Vec<f64>)> = runs
            .flat_map(|run| run.residuals(model, &values, noise))
            .collect();
        let squares = lines.iter().flat_map(|line| line.residual);
        let squares = squares.chain(backbone.iter().map(|(residual, _)| *residual));
        Self {
            values,
            chi_squared: squares.map(|residual| residual * residual).sum(),
            backbone,
            log_amplitudes,
            lines,
        }
    }
}

/// Fits the model from a start. A passive joint is so up to the largest displacement that was fitted, which a fit moves a
/// little: then it is fitted again.
pub(super) fn fit<'a>(
    model: &Model,
    data: Data<'_>,
    noise: &Noise,
    start: impl Into<Start<'a>>,
    kind: Kind,
) -> Result<Fit, LapError> {
    let start = start.into();
    let mut largest_m = start.largest_m(model, data);
    let mut found = fit_up_to(model, data, noise, start, (kind, largest_m, STEPS))?;
    for _ in 0..FOLLOWED {
        let is_there = (found.amplitude_m / largest_m - 1.0).abs() < FOLLOWS;
        // no other limit moves with that displacement
        let is_at_end = |at: &AtLimit| match at.limit {
            Limit::JointDamping(at_m) => at_m >= (1.0 - FOLLOWS) * largest_m,
            _ => false,
        };
        if kind == Kind::Free || is_there || !found.at_limits.iter().any(is_at_end) {
            break;
        }
        largest_m = found.amplitude_m;
        found = fit_up_to(
            model,
            data,
            noise,
            Start::from(&found),
            (kind, largest_m, STEPS),
        )?;
    }
    if kind == Kind::Passive && !found.at_limits.is_empty() {
        let passive = Passive {
            model,
            amplitude_m: largest_m,
        };
        found.values = passive.clear_of_rounding(&found.values);
        found.amplitude_m = found.amplitude_m.min(largest_m);
    }
    Ok(found)
}

/// Where the first few steps from a start lead: that tells which starts are worth the rest.
pub(super) fn glanced(
    model: &Model,
    data: Data<'_>,
    noise: &Noise,
    start: &Values,
    kind: Kind,
) -> Result<Fit, LapError> {
    let start = Start::from(start);
    let largest_m = start.largest_m(model, data);
    fit_up_to(model, data, noise, start, (kind, largest_m, FIRST_STEPS))
}

fn fit_up_to(
    model: &Model,
    data: Data<'_>,
    noise: &Noise,
    from: Start<'_>,
    (kind, largest_m, most_steps): (Kind, f64, usize),
) -> Result<Fit, LapError> {
    let unknowns = model.unknowns.len();
    if data.count() <= unknowns {
        return Err(LapError::TooFewLines {
            lines: data.lines.len(),
            unknowns,
        });
    }
    let passive = (kind == Kind::Passive).then_some(Passive {
        model,
        amplitude_m: largest_m,
    });
    let start = passive.map_or(*from.values, |passive| passive.within(*from.values));
    let from = Start {
        values: &start,
        ..from
    };
    let amplitudes = from.amplitudes_m(model, data).into_iter();
    let amplitudes = amplitudes.map(|amplitude_m| amplitude_m.max(f64::MIN_POSITIVE).ln());
    let mut state = State::new(model, data, noise, start, amplitudes.collect());
    if !state.chi_squared.is_finite() {
        return Err(LapError::NoEstimate);
    }
    let bounds = |state: &State| -> Vec<Bound> {
        passive.map_or_else(Vec::new, |passive| passive.bounds(&state.values))
    };
    let mut damping = DAMPING;
    for _ in 0..most_steps {
        let (information, gradient) = normal_equations(&state, unknowns);
        let limits = bounds(&state);
        let mut accepted = false;
        while damping < MOST_DAMPING {
            let Some(step) = damped_step(&information, &gradient, &limits, damping) else {
                damping *= 10.0;
                continue;
            };
            let trial = moved(model, data, noise, &state, &step.change, passive.as_ref());
            if trial.chi_squared.is_finite() && trial.chi_squared <= state.chi_squared {
                accepted = state.chi_squared - trial.chi_squared > AT_REST * state.chi_squared;
                state = trial;
                damping = (0.2 * damping).max(1e-12);
                break;
            }
            damping *= 5.0;
        }
        if !accepted {
            break;
        }
    }
    let (information, gradient) = normal_equations(&state, unknowns);
    let is_usable = information.iter().all(|entry| entry.is_finite());
    is_usable.then_some(()).ok_or(LapError::NoEstimate)?;
    let limits = bounds(&state);
    let last = damped_step(&information, &gradient, &limits, 1e-12);
    let multipliers = last.as_ref().map(|step| step.multipliers.clone());
    let at_limits = limits
        .into_iter()
        .zip(multipliers.unwrap_or_default())
        .filter(|(_, multiplier)| *multiplier > 0.0)
        .map(|(bound, multiplier)| AtLimit {
            limit: bound.limit,
            multiplier: 2.0 * multiplier,
            gradient: bound.gradient,
        });
    let of_points = data.points().map(|line| line.amplitude_m);
    let amplitudes_m: Vec<f64> = state.log_amplitudes.iter().map(|log| log.exp()).collect();
    let largest = amplitudes_m.iter().copied().chain(of_points);
    Ok(Fit {
        values: state.values,
        amplitude_m: largest.fold(0.0, f64::max),
        amplitudes_m,
        chi_squared: state.chi_squared,
        degrees_of_freedom: data.count() - unknowns,
        information,
        at_limits: at_limits.collect(),
        left: last.map_or(f64::INFINITY, |step| -gradient.dot(&step.change)),
    })
}

/// Σ JᵀPJ and Σ JᵀPr, where P takes the direction of the line's own amplitude away.
fn normal_equations(state: &State, unknowns: usize) -> (DMatrix<f64>, DVector<f64>) {
    let mut information = DMatrix::zeros(unknowns, unknowns);
    let mut gradient = DVector::zeros(unknowns);
    for line in &state.lines {
        let (direction, _) = unit(line.by_log_amplitude);
        let project = |vector: &[f64; 3]| {
            let along: f64 = dot(vector, &direction);
            std::array::from_fn::<f64, 3, _>(|i| vector[i] - along * direction[i])
        };
        let residual = project(&line.residual);
        let columns: Vec<[f64; 3]> = line.by_unknown.iter().map(project).collect();
        for (i, column) in columns.iter().enumerate() {
            gradient[i] += dot(column, &residual);
            for (j, other) in columns.iter().enumerate() {
                information[(i, j)] += dot(column, other);
            }
        }
    }
    for (residual, row) in &state.backbone {
        for (i, by) in row.iter().enumerate() {
            gradient[i] += by * residual;
            for (j, other) in row.iter().enumerate() {
                information[(i, j)] += by * other;
            }
        }
    }
    (information, gradient)
}

/// The state after a step of the unknowns, with the amplitudes following.
fn moved(
    model: &Model,
    data: Data<'_>,
    noise: &Noise,
    state: &State,
    step: &DVector<f64>,
    passive: Option<&Passive<'_>>,
) -> State {
    let mut values = state.values;
    for (unknown, change) in model.unknowns.iter().zip(step.iter()) {
        if let Some(place) = values.place(*unknown) {
            *place += change;
        }
    }
    if let Some(passive) = passive {
        values = passive.within(values);
    }
    let lines = state.lines.iter().zip(&state.log_amplitudes);
    let log_amplitudes = lines.map(|(line, log_amplitude)| {
        let (direction, length) = unit(line.by_log_amplitude);
        if length == 0.0 {
            return *log_amplitude;
        }
        let mut target = line.residual;
        for (column, change) in line.by_unknown.iter().zip(step.iter()) {
            for (entry, by) in target.iter_mut().zip(column) {
                *entry += by * change;
            }
        }
        log_amplitude - (dot(&target, &direction) / length).clamp(-LONGEST, LONGEST)
    });
    let log_amplitudes = log_amplitudes.collect();
    State::new(model, data, noise, values, log_amplitudes)
}

#[cfg(test)]
mod tests;
