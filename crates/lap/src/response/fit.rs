//! Maximum likelihood: the model's numbers and the true amplitude of every line at once. The amplitudes are eliminated line by
//! line, so that what is left is as small as the model.

use nalgebra::{DMatrix, DVector};

use super::backbone::BackboneLine;
use super::data::SineLine;
use super::dynamic_stiffness::RelativeMotion;
use super::model::{LineResidual, Model, Values};
use super::study::Noise;
use crate::error::LapError;

const STEPS: usize = 200;
/// Relative decrease of χ² that is none.
const AT_REST: f64 = 1e-10;
/// Longest step of the logarithm of an amplitude.
const LONGEST: f64 = 0.5;
/// Iterations of one line's amplitude, shortened steps in each, and the step that is none.
const SETTLING: usize = 12;
const HALVINGS: usize = 4;
const SETTLED: f64 = 1e-8;
const DAMPING: f64 = 1e-4;
const MOST_DAMPING: f64 = 1e12;

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
}

impl Fit {
    /// Largest amplitude of the relative motion that was fitted, beside that of a backbone, m.
    pub(super) fn largest_amplitude_m(&self, backbone: &[BackboneLine]) -> f64 {
        let of_backbone = backbone.iter().map(|line| line.amplitude_m);
        let all = self.amplitudes_m.iter().copied().chain(of_backbone);
        all.fold(0.0, f64::max)
    }
}

/// What a model is fitted to.
#[derive(Clone, Copy, Debug)]
pub(super) struct Data<'a> {
    pub(super) lines: &'a [SineLine],
    pub(super) backbone: &'a [BackboneLine],
}

impl Data<'_> {
    /// Numbers beyond the amplitudes.
    fn count(&self) -> usize {
        2 * self.lines.len() + self.backbone.iter().map(BackboneLine::count).sum::<usize>()
    }
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
        let backbone: Vec<(f64, Vec<f64>)> = data
            .backbone
            .iter()
            .flat_map(|line| line.residuals(model, &values, noise))
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

/// The amplitude that fits one line best, near a first guess: a force without error, which fixes it, would otherwise hold up every
/// step of the model.
fn settled(mut log_amplitude: f64, residual: impl Fn(f64) -> LineResidual) -> (f64, LineResidual) {
    let cost = |line: &LineResidual| dot(&line.residual, &line.residual);
    let mut line = residual(log_amplitude);
    for _ in 0..SETTLING {
        let (direction, length) = unit(line.by_log_amplitude);
        if length == 0.0 {
            break;
        }
        let mut step = (-dot(&line.residual, &direction) / length).clamp(-LONGEST, LONGEST);
        let mut is_better = false;
        for _ in 0..HALVINGS {
            if step.abs() < SETTLED {
                break;
            }
            let trial = residual(log_amplitude + step);
            if cost(&trial) < cost(&line) {
                log_amplitude += step;
                line = trial;
                is_better = true;
                break;
            }
            step *= 0.25;
        }
        if !is_better {
            break;
        }
    }
    (log_amplitude, line)
}

/// Fits the model from a start.
pub(super) fn fit(
    model: &Model,
    data: Data<'_>,
    noise: &Noise,
    start: &Values,
) -> Result<Fit, LapError> {
    let unknowns = model.unknowns.len();
    if data.count() <= unknowns {
        return Err(LapError::TooFewLines {
            lines: data.lines.len(),
            unknowns,
        });
    }
    let amplitudes = data.lines.iter().map(|line| {
        model
            .relative_amplitude(start, line)
            .max(f64::MIN_POSITIVE)
            .ln()
    });
    let mut state = State::new(model, data, noise, *start, amplitudes.collect());
    if !state.chi_squared.is_finite() {
        return Err(LapError::NoEstimate);
    }
    let mut damping = DAMPING;
    for _ in 0..STEPS {
        let (information, gradient) = normal_equations(&state, unknowns);
        let mut accepted = false;
        while damping < MOST_DAMPING {
            let Some(step) = damped_step(&information, &gradient, damping) else {
                damping *= 10.0;
                continue;
            };
            let trial = moved(model, data, noise, &state, &step);
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
    let (information, _) = normal_equations(&state, unknowns);
    let is_usable = information.iter().all(|entry| entry.is_finite());
    is_usable.then_some(()).ok_or(LapError::NoEstimate)?;
    Ok(Fit {
        values: state.values,
        amplitudes_m: state.log_amplitudes.iter().map(|log| log.exp()).collect(),
        chi_squared: state.chi_squared,
        degrees_of_freedom: data.count() - unknowns,
        information,
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

/// −(H + λ diag H)⁻¹ g, scaled to a unit diagonal.
fn damped_step(
    information: &DMatrix<f64>,
    gradient: &DVector<f64>,
    damping: f64,
) -> Option<DVector<f64>> {
    let scale = information.diagonal().map(|entry| {
        if entry > 0.0 {
            entry.sqrt().recip()
        } else {
            1.0
        }
    });
    let size = gradient.len();
    let scaled = DMatrix::from_fn(size, size, |i, j| {
        let own = information[(i, j)] * scale[i] * scale[j];
        if i == j { own + damping } else { own }
    });
    let step = scaled.cholesky()?.solve(&-gradient.component_mul(&scale));
    Some(step.component_mul(&scale))
}

/// The state after a step of the unknowns, with the amplitudes following.
fn moved(
    model: &Model,
    data: Data<'_>,
    noise: &Noise,
    state: &State,
    step: &DVector<f64>,
) -> State {
    let mut values = state.values;
    for (unknown, change) in model.unknowns.iter().zip(step.iter()) {
        if let Some(place) = values.place(*unknown) {
            *place += change;
        }
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

fn dot(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Direction and length; no direction of what has no length.
fn unit(vector: [f64; 3]) -> ([f64; 3], f64) {
    let length = dot(&vector, &vector).sqrt();
    if length > 0.0 && length.is_finite() {
        (vector.map(|entry| entry / length), length)
    } else {
        ([0.0; 3], 0.0)
    }
}
