//! Maximum likelihood: the model's numbers and the true amplitude of every line at once. The amplitudes are eliminated line by
//! line, so that what is left is as small as the model.

mod amplitude;
mod data;
mod found;

use nalgebra::{DMatrix, DVector};

use self::amplitude::{LONGEST, dot, settled, unit};
use super::dynamic_stiffness::RelativeMotion;
use super::model::{LineResidual, Model, ResponseUnknown, Values};
use super::passive::{Bound, Limit, Passive};
use super::step::damped_step;
use super::study::Noise;
use crate::error::LapError;

pub(super) use self::data::{Data, Start};
pub use self::found::{AtLimit, Fit};

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
/// Longest step of the logarithm of a law's number from one reading of decays to the next.
const LONGEST_OF_LAW: f64 = 1.0;

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

/// χ² of data at values that were fitted to others.
pub(super) fn chi_squared_at(model: &Model, data: Data<'_>, noise: &Noise, values: &Values) -> f64 {
    let amplitudes = Start::from(values).amplitudes_m(model, data).into_iter();
    let logarithms = amplitudes.map(|amplitude_m| amplitude_m.max(f64::MIN_POSITIVE).ln());
    State::new(model, data, noise, *values, logarithms.collect()).chi_squared
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

/// The fit again from one before that data were made for, by a step that is not so long that they would no longer hold.
///
/// What decays are corrected by is that of the fit before. A law's numbers that a reading tells little of would run away.
pub(super) fn fit_near(
    model: &Model,
    data: Data<'_>,
    noise: &Noise,
    before: &Fit,
    kind: Kind,
) -> Result<Fit, LapError> {
    let found = fit(model, data, noise, before, kind)?;
    let change = model.change(&before.values, &found.values);
    let unknowns = model.unknowns.iter().zip(change.iter());
    let of_law = unknowns.filter(|(unknown, _)| matches!(unknown, ResponseUnknown::Slider(_)));
    let longest = of_law.fold(0.0_f64, |most, (_, change)| most.max(change.abs()));
    if longest <= LONGEST_OF_LAW {
        return Ok(found);
    }
    let values = model.moved(&before.values, &(change * (LONGEST_OF_LAW / longest)));
    let start = Start::from(&values);
    let largest_m = start.largest_m(model, data);
    fit_up_to(model, data, noise, start, (kind, largest_m, 0))
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
        bolted_joint_wanted::look();
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
    let of_curves = data.backbones.iter().map(|run| run.largest_m());
    let amplitudes_m: Vec<f64> = state.log_amplitudes.iter().map(|log| log.exp()).collect();
    let largest = amplitudes_m.iter().copied().chain(of_curves);
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
    let mut values = model.moved(&state.values, step);
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
