//! The search for several joints at once: damped Gauss–Newton steps from several starts.

use nalgebra::{DMatrix, DVector};

use super::normal::{Normal, cost};
use super::problem::{Problem, Unknowns};
use super::starts::starts;
use crate::error::SpatialError;
use crate::normal::Deviations;

/// Steps after which a search has not converged.
const STEPS_MAX: usize = 150;

/// A step that lowers the cost by less than this part of it, and this much, was the last one.
const SETTLED: f64 = 1e-9;

/// First damping, and one that no step can be helped with.
const DAMPING_FIRST: f64 = 1e-3;
const DAMPING_MAX: f64 = 1e12;

/// A search that has come as low as the lowest, up to this part.
const AS_LOW: f64 = 1e-6;

/// Squares over numbers that noise explains.
const EXPLAINED: f64 = 1.1;

/// Where a search has come to.
pub(super) struct Bottom {
    pub(super) unknowns: Unknowns,
    pub(super) cost: f64,
    pub(super) has_converged: bool,
}

/// The lowest of the searches, how many starts were tried and how many came as low. When a second one has, or noise whose level is
/// stated explains what is left, the others are not tried. A minimum that neither confirms may be another one.
pub(super) fn searched(
    problem: &Problem,
    level: &Deviations,
    is_stated: bool,
) -> Result<(Bottom, [usize; 2]), SpatialError> {
    let numbers = (2 * problem.observed.len() * problem.frequency_hz.len()) as f64;
    let mut best: Option<Bottom> = None;
    let (mut tried, mut agreeing, mut is_confirmed) = (0, 0, false);
    for start in starts(problem)? {
        tried += 1;
        let Ok(found) = downhill(problem, start, level) else {
            continue;
        };
        let lowest = best.as_ref().map_or(f64::INFINITY, |best| best.cost);
        let as_low = AS_LOW * (lowest.min(found.cost) + numbers);
        agreeing = match found.cost - lowest {
            above if above > as_low => agreeing,
            above if above >= -as_low => agreeing + 1,
            _ => 1,
        };
        is_confirmed |= is_stated && found.cost < EXPLAINED * numbers;
        if found.cost < lowest {
            best = Some(found);
        }
        is_confirmed |= agreeing > 1;
        if is_confirmed {
            break;
        }
    }
    let mut best = best.ok_or(SpatialError::NoStart)?;
    best.has_converged &= is_confirmed;
    Ok((best, [tried, agreeing]))
}

/// From these unknowns to the bottom, (F + λ diag F) Δθ = g.
pub(super) fn downhill(
    problem: &Problem,
    start: Unknowns,
    level: &Deviations,
) -> Result<Bottom, SpatialError> {
    let mut normal = Normal::of(problem, &start, level)?;
    let mut unknowns = start;
    let mut damping = DAMPING_FIRST;
    for _ in 0..STEPS_MAX {
        let mut moved = None;
        while damping < DAMPING_MAX {
            if let Some(step) = step(&normal, damping) {
                let trial = Unknowns(&unknowns.0 + step);
                let found = cost(problem, &trial, level).unwrap_or(f64::INFINITY);
                if found <= normal.cost {
                    moved = Some((trial, found));
                    damping = (0.1 * damping).max(1e-12);
                    break;
                }
            }
            damping *= 10.0;
        }
        let Some((trial, found)) = moved else { break };
        let gain = normal.cost - found;
        unknowns = trial;
        if gain <= SETTLED * (1.0 + found) {
            return Ok(Bottom {
                unknowns,
                cost: found,
                has_converged: true,
            });
        }
        normal = Normal::of(problem, &unknowns, level)?;
    }
    Ok(Bottom {
        unknowns,
        cost: normal.cost,
        // no step helps: at the bottom as far as rounding lets it be seen
        has_converged: damping >= DAMPING_MAX,
    })
}

fn step(normal: &Normal, damping: f64) -> Option<DVector<f64>> {
    let information = &normal.information;
    let scale = information.diagonal().map(|own| match own > 0.0 {
        true => own.sqrt().recip(),
        false => 1.0,
    });
    let damped = DMatrix::from_fn(scale.len(), scale.len(), |i, j| {
        let own = information[(i, j)] * scale[i] * scale[j];
        if i == j { own + damping } else { own }
    });
    let right = normal.descent.component_mul(&scale);
    let step = damped.cholesky()?.solve(&right).component_mul(&scale);
    step.iter().all(|x| x.is_finite()).then_some(step)
}
