//! The search for the joint and the causes that are most likely together: Gauss–Newton in marginal form.

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use super::estimate::Settings;
use super::experiment::{Experiment, Structure};
use super::line::{Labelled, Point, Task, Terms};
use super::normal::{Scatter, Share, Whitened, as_measured};
use super::structures::Recomputations;
use super::taking_part::{is_linear, keeps_its_frequency, still_linear};

/// The structures' receptances stay what was measured until steps are below this part of a standard deviation …
const NEAR: f64 = 0.1;
/// … or until so many steps are left.
const LAST: usize = 15;
/// Part of a step that a line may take, best first.
const PARTS: [f64; 5] = [1.0, 0.5, 0.2, 0.05, 0.0];
/// A step that goes back by more than this part of the one before …
const FALLING: f64 = 0.3;
/// … is shortened, to this part of it at most.
const SHORTEST: f64 = 0.25;
/// Steps below this part of a standard deviation are none.
pub(crate) const TOLERANCE: f64 = 0.01;
/// A step longer than this many standard deviations is taken as far as it leaves less …
const LONG: f64 = 1.0;
/// … down to this part, which is taken where no part leaves less.
const SHORTEST_PART: f64 = 0.04;
/// A search that finds no way down more often than this, one time after the other, is given up.
const MOST_STUCK: usize = 4;
/// A search near its end leaves lines out so often that are not linear there.
const MOST_CHECKS: usize = 3;
/// Of a search that has used up its steps, the last one may have been so many standard deviations long.
const TOLERABLE: f64 = 0.3;
/// Prior standard deviations that a cause may move in one step.
const LARGEST_STEP: f64 = 1.5;
/// Part of its size that an unknown of the joint may move in one step, first and later.
const LARGEST_PARTS: [f64; 2] = [0.3, 1.0];
/// By what inflated noise of the assembly shrinks from step to step.
const ANNEALING: f64 = 0.6;

/// How many times as large as they are the standard deviations of each assembly are taken to be: at the beginning, and where the
/// search may come to rest. What is left shrinks from step to step.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Inflation {
    from: Vec<f64>,
    to: Vec<f64>,
}

/// The inflation of an assembly that is hardly heard beside another.
const FAINT: f64 = 300.0;

impl Inflation {
    /// None.
    pub(crate) fn none(experiment: &Experiment<'_>) -> Self {
        Self::from(experiment, 1.0)
    }

    /// The same for all assemblies, at the beginning.
    pub(crate) fn from(experiment: &Experiment<'_>, factor: f64) -> Self {
        let all = |factor: f64| vec![factor; experiment.assemblies.len()];
        Self {
            from: all(factor),
            to: all(1.0),
        }
    }

    /// One assembly is heard and the others hardly; then the others are heard more and more.
    pub(crate) fn led_by(experiment: &Experiment<'_>, leading: usize) -> [Self; 2] {
        let of = |number| if number == leading { 1.0 } else { FAINT };
        let from: Vec<f64> = (0..experiment.assemblies.len()).map(of).collect();
        let held = Self {
            to: from.clone(),
            from: from.clone(),
        };
        let Self { to, .. } = Self::none(experiment);
        [held, Self { from, to }]
    }
}

/// Where a search came to rest.
pub(crate) struct Found {
    pub(crate) point: Point,
    pub(crate) labelled: Vec<Labelled>,
    /// Lines that were used.
    pub(crate) lines: Vec<usize>,
    /// Of unknowns and causes, without the priors.
    pub(crate) information: DMatrix<f64>,
    /// Σ r̃ᴴ S⁻¹ r̃ of the lines, without the priors.
    pub(crate) cost: f64,
    /// What each used line adds.
    pub(crate) shares: Vec<Share>,
    pub(crate) iterations: usize,
    pub(crate) converged: bool,
}

/// Searches from `point`; `None` where an assembly is singular or a structure cannot be computed.
pub(crate) fn search(
    task: &Task<'_>,
    mut point: Point,
    settings: &Settings,
    inflation: &Inflation,
) -> Option<Found> {
    let experiment = task.experiment;
    let has_labelled = [&experiment.a, &experiment.b]
        .iter()
        .any(|side| matches!(side, Structure::Measured(_)));
    let stride = task.lines().div_ceil(settings.most_lines.max(1)).max(1);
    let all: Vec<usize> = (0..task.lines())
        .step_by(stride)
        .filter(|&line| keeps_its_frequency(task, line, settings))
        .collect();
    let mut labelled: Vec<Labelled> = Vec::new();
    let mut proposed: Option<Vec<Labelled>> = None;
    let mut lines: Vec<usize> = all.clone();
    let mut inflated = inflation.from.clone();
    let mut rests = !has_labelled;
    let mut before: Option<DVector<f64>> = None;
    let mut stuck = 0;
    let mut checks = 0;
    for iteration in 0..settings.most_iterations {
        bolted_joint_wanted::look();
        let recomputed = Recomputations::of(experiment, task.priors, &point.causes)?;
        let frozen = !rests;
        let scatter = Scatter {
            inflation: &inflated.clone(),
            keeps_second_order: frozen && experiment.has_common_errors(),
        };
        if frozen || labelled.is_empty() {
            labelled = (0..task.lines())
                .map(|line| as_measured(task, line, &point))
                .collect();
        } else if let Some(proposed) = proposed.take() {
            labelled = chosen(task, &point, &recomputed, &labelled, &proposed);
        }
        let mut terms: Vec<(usize, Terms)> = (if frozen { &all } else { &lines })
            .par_iter()
            .map(|&line| {
                Some((
                    line,
                    task.terms(line, &point, &labelled[line], &recomputed)?,
                ))
            })
            .collect::<Option<_>>()?;
        if frozen {
            terms.retain(|(_, terms)| is_linear(terms, settings.most_nonlinear));
            lines = terms.iter().map(|(line, _)| *line).collect();
        }
        let whitened: Vec<Whitened<'_>> = terms
            .par_iter()
            .map(|(line, terms)| Whitened::of(task, *line, terms, &scatter))
            .collect::<Option<_>>()?;
        let shares: Vec<Share> = whitened.par_iter().map(Whitened::share).collect();
        let (information, gradient, cost) = summed(&shares, task.unknowns() + task.priors.len())?;
        let (step, deviation) = step(task, &point, &information, &gradient)?;
        let relative = step
            .iter()
            .zip(deviation.iter())
            .map(|(s, d)| (s / d).abs());
        let largest = relative.fold(0.0, f64::max);
        let part = allowed(task, &point, &step, &deviation, iteration);
        rests |= inflated == inflation.to
            && part == 1.0
            && (largest < NEAR || iteration + LAST >= settings.most_iterations);
        if !frozen && part == 1.0 && largest < TOLERABLE && checks < MOST_CHECKS {
            let still = still_linear(task, &lines, &point, &recomputed, settings);
            if still.len() < lines.len() {
                checks += 1;
                lines = still;
                continue;
            }
        }
        let has_settled = !frozen && part == 1.0 && largest < TOLERANCE && iteration > 1;
        if has_settled || iteration + 1 == settings.most_iterations {
            drop(whitened);
            return Some(Found {
                point,
                labelled,
                lines,
                information,
                cost,
                shares,
                iterations: iteration + 1,
                converged: largest < TOLERABLE && !frozen,
            });
        }
        let damping = damping(before.as_ref(), &step, &deviation);
        let mut step = step * (part * damping);
        let is_long = largest > if has_labelled { LONG } else { TOLERANCE };
        if (frozen || !has_labelled) && is_long {
            let now = cost + priors_cost(task, &point);
            let down = descending(task, &point, &step, (&terms, &whitened), now);
            stuck = if down.is_some() { 0 } else { stuck + 1 };
            step *= down.unwrap_or(SHORTEST_PART);
        }
        if stuck > MOST_STUCK {
            drop(whitened);
            return Some(Found {
                point,
                labelled,
                lines,
                information,
                cost,
                shares,
                iterations: iteration + 1,
                converged: false,
            });
        }
        before = Some(step.component_div(&deviation));
        if has_labelled && !frozen {
            let mut next = labelled.clone();
            for ((line, _), whitened) in terms.iter().zip(&whitened) {
                next[*line] = whitened.followed(task.unknowns(), &step);
            }
            proposed = Some(next);
        }
        point.moves(&step);
        for (now, least) in inflated.iter_mut().zip(&inflation.to) {
            *now = (*now * ANNEALING).max(*least);
        }
    }
    None
}

/// Part of a step that is taken: one that goes back by more than [`FALLING`] of the step `before` (in standard deviations) shows
/// that steps overshoot, as those of frequency scales do, whose derivatives come from a smooth fit.
fn damping(before: Option<&DVector<f64>>, step: &DVector<f64>, deviation: &DVector<f64>) -> f64 {
    let Some(before) = before else {
        return 1.0;
    };
    let step = step.component_div(deviation);
    let length = before.norm();
    // how far it goes back along the one before, as a part of that one
    let back = -step.dot(before) / (length * length);
    if back.is_finite() && back > FALLING {
        // of a step t with the next one −ρt the sum is t/(1 + ρ)
        (1.0 + back).recip().max(SHORTEST)
    } else {
        1.0
    }
}

/// Part of a long step after which less is left than `now`, with the covariances of where it begins; `None` where no part is.
fn descending(
    task: &Task<'_>,
    point: &Point,
    step: &DVector<f64>,
    (terms, whitened): (&[(usize, Terms)], &[Whitened<'_>]),
    now: f64,
) -> Option<f64> {
    let left = |part: f64| -> Option<f64> {
        let mut moved = point.clone();
        moved.moves(&(step * part));
        let recomputed = Recomputations::values(task.experiment, task.priors, &moved.causes)?;
        let of_line = |((line, _), whitened): (&(usize, Terms), &Whitened<'_>)| {
            let labelled = as_measured(task, *line, &moved);
            let left = task.left(*line, &moved, &labelled, &recomputed)?;
            Some(whitened.cost_of(left))
        };
        let lines = terms.par_iter().zip(whitened);
        let lines: Option<Vec<f64>> = lines.map(of_line).collect();
        Some(lines?.iter().sum::<f64>() + priors_cost(task, &moved))
    };
    let mut part = 1.0;
    while part > SHORTEST_PART {
        if left(part).is_some_and(|left| left < now) {
            return Some(part);
        }
        part *= 0.5;
    }
    None
}

/// Σ (ν/σ)²
pub(crate) fn priors_cost(task: &Task<'_>, point: &Point) -> f64 {
    let pulls = task.priors.iter().zip(&point.causes);
    pulls.map(|(prior, value)| prior.pull(*value).powi(2)).sum()
}

/// Each line takes the part of the step that leaves least: near a structure's resonance it is not linear in the receptances.
fn chosen(
    task: &Task<'_>,
    point: &Point,
    recomputed: &Recomputations,
    now: &[Labelled],
    proposed: &[Labelled],
) -> Vec<Labelled> {
    (0..task.lines())
        .into_par_iter()
        .map(|line| {
            let at = |part: f64| -> Labelled {
                [0, 1].map(|side| {
                    let pairs = now[line][side].iter().zip(&proposed[line][side]);
                    pairs
                        .map(|(now, proposed)| now + (proposed - now) * part)
                        .collect()
                })
            };
            let mut best: Option<(f64, Labelled)> = None;
            for candidate in PARTS.map(at) {
                let cost = task
                    .cost(line, point, &candidate, recomputed)
                    .unwrap_or(f64::INFINITY);
                if best.as_ref().is_none_or(|(least, _)| cost < *least) {
                    best = Some((cost, candidate));
                }
            }
            best.map_or_else(|| now[line].clone(), |(_, labelled)| labelled)
        })
        .collect()
}

/// The sums over all lines.
pub(crate) fn summed(shares: &[Share], size: usize) -> Option<(DMatrix<f64>, DVector<f64>, f64)> {
    let mut information = DMatrix::zeros(size, size);
    let mut gradient = DVector::zeros(size);
    let mut cost = 0.0;
    for share in shares {
        information += &share.information;
        gradient += &share.gradient;
        cost += share.cost;
    }
    let is_finite = information.iter().all(|value: &f64| value.is_finite()) && cost.is_finite();
    (is_finite && !shares.is_empty()).then_some((information, gradient, cost))
}

/// The step of unknowns and causes, and their standard deviations.
pub(crate) fn step(
    task: &Task<'_>,
    point: &Point,
    information: &DMatrix<f64>,
    gradient: &DVector<f64>,
) -> Option<(DVector<f64>, DVector<f64>)> {
    let whole = with_priors(task, information);
    let first = task.unknowns();
    let mut right = gradient.clone();
    for (number, prior) in task.priors.iter().enumerate() {
        right[first + number] -= prior.pull(point.causes[number]) / prior.standard_deviation;
    }
    let covariance = inverse(&whole)?;
    let deviation = covariance.diagonal().map(f64::sqrt);
    Some((covariance * right, deviation))
}

/// N + P
pub(crate) fn with_priors(task: &Task<'_>, information: &DMatrix<f64>) -> DMatrix<f64> {
    let mut whole = information.clone();
    let first = task.unknowns();
    for (number, prior) in task.priors.iter().enumerate() {
        whole[(first + number, first + number)] += prior.standard_deviation.powi(-2);
    }
    whole
}

/// Inverse of an information matrix, scaled to a diagonal of ones first; `None` if it is singular.
pub(crate) fn inverse(information: &DMatrix<f64>) -> Option<DMatrix<f64>> {
    let scale = information.diagonal().map(|value| value.sqrt().recip());
    if !scale.iter().all(|value| value.is_finite()) {
        return None;
    }
    let scaled = |matrix: &DMatrix<f64>| {
        DMatrix::from_fn(matrix.nrows(), matrix.ncols(), |i, j| {
            matrix[(i, j)] * scale[i] * scale[j]
        })
    };
    let inverse = scaled(information).cholesky()?.inverse();
    Some(scaled(&inverse))
}

/// Part of a step that is not too long.
fn allowed(
    task: &Task<'_>,
    point: &Point,
    step: &DVector<f64>,
    deviation: &DVector<f64>,
    iteration: usize,
) -> f64 {
    let count = task.experiment.joint.entries.len();
    let entries = &task.experiment.joint.entries;
    let mut part: f64 = 1.0;
    for index in 0..task.unknowns() {
        let matrix = index / count * count;
        let of = |i: usize, j: usize| {
            let place = entries.iter().position(|places| places.contains(&(i, j)));
            place.map_or(0.0, |place| point.unknowns[matrix + place].abs())
        };
        let (i, j) = entries[index % count][0];
        let size = point.unknowns[index]
            .abs()
            .max((of(i, i) * of(j, j)).sqrt())
            .max(deviation[index]);
        let most = LARGEST_PARTS[usize::from(iteration > 1)] * size;
        part = part.min(most / step[index].abs());
    }
    for (number, prior) in task.priors.iter().enumerate() {
        let moved = step[task.unknowns() + number].abs() / prior.standard_deviation;
        part = part.min(LARGEST_STEP / moved);
    }
    part
}
