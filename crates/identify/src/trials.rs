//! Where starts lead on few lines, and which of the ends are one minimum.

use nalgebra::DVector;

use super::data::Data;
use super::estimator::{Estimate, Free, estimate, first_levels};
use super::layout::Place;
use super::noise::Noise;
use super::parallel;
use super::robust::robust;

/// Two estimates are the same if their −2 log-likelihoods agree to this …
pub(super) const SAME_MISFIT: f64 = 2e-3;

/// … and their unknowns to this (with no more numbers than unknowns several joints fit exactly) …
const NEAR_UNKNOWN: f64 = 0.05;

/// … or if their unknowns agree to this, relative to its value or to what would change the residual by its assumed standard
/// deviation: data without noise leave a misfit of rounding alone.
const SAME_UNKNOWN: f64 = 1e-6;

/// … or to this, relative to the standard deviation that each would have if the others were known.
const SAME_DEVIATION: f64 = 0.3;

/// By how much the −2 log-likelihood of an estimate that has not converged must be lower to rank before one that has.
const DECISIVE_MISFIT: f64 = 20.0;

/// How many different estimates from thinned lines are refined on all lines.
const FINALISTS: usize = 4;

/// A minimum whose weighted mean square residual is so many times that of the best is not refined: no resonance between
/// the thinned lines makes up for it, and corrections that did would be no errors.
const COMPARABLE: f64 = 10.0;

/// Where a start leads on few lines if the receptances of the substructures stay as they were measured.
pub(super) fn rough(
    data: &Data<'_>,
    entries: &[Place],
    noise: &Noise,
    start: &DVector<f64>,
) -> Option<Estimate> {
    let thinned = data.thinned.objective(entries);
    let thinned = &thinned;
    match &data.thinned_whole {
        Some(whole) => robust(thinned, &whole.objective(entries), noise, start),
        None => {
            // Proportional errors while the joint is sought: a level that is estimated far from it would mean nothing.
            let levels = Some(first_levels(noise));
            estimate(thinned, noise, levels, &Free, start, None)
        }
    }
}

/// Where each of the starts leads on few lines; `ways` are the robust estimates that led somewhere before.
pub(super) fn try_starts(
    data: &Data<'_>,
    entries: &[Place],
    noise: &Noise,
    starts: &[DVector<f64>],
    ways: &mut Vec<Way>,
) -> Vec<Estimate> {
    let found = parallel::map(starts, |start| rough(data, entries, noise, start));
    if !data.has_errors() {
        return found.into_iter().flatten().collect();
    }
    let robust: Vec<Estimate> = found.into_iter().flatten().collect();
    let mut new: Vec<Estimate> = Vec::new();
    for one in &robust {
        let known = ways.iter().map(|way| &way.robust).chain(&new);
        if !known.into_iter().any(|known| same(known, one)) {
            new.push(one.clone());
        }
    }
    let left = |one: &Estimate| one.cost / one.measurements as f64;
    let known = ways.iter().map(|way| &way.robust).chain(&new);
    let least = known.map(left).fold(f64::INFINITY, f64::min);
    let (comparable, others): (Vec<Estimate>, Vec<Estimate>) = new
        .into_iter()
        .partition(|robust| left(robust) <= COMPARABLE * least);
    let ends = parallel::map(&comparable, |robust| {
        let used = data.few_near(entries, robust.place());
        let few = used.assemblies.objective(entries).as_searched();
        let (levels, start) = (Some(robust.levels), &robust.unknowns);
        let end = estimate(&few, noise, levels, &Free, start, None)?;
        Some(end.without_corrections())
    });
    let led = comparable.into_iter().zip(ends);
    let left = others.into_iter().map(|robust| (robust, None));
    ways.extend(led.chain(left).map(|(robust, end)| Way { robust, end }));
    let end = |one: &Estimate| {
        let way = ways.iter().find(|way| same(&way.robust, one))?;
        way.end.clone()
    };
    robust.iter().filter_map(end).collect()
}

/// A robust estimate and the one to which it led.
pub(super) struct Way {
    robust: Estimate,
    end: Option<Estimate>,
}

/// The best few different `trials`, best first.
pub(super) fn best_trials(trials: &[Estimate]) -> Vec<&Estimate> {
    let at_most = trials.iter().map(|trial| trial.measurements).max();
    let at_most = at_most.unwrap_or(0) as f64;
    let mut ranked: Vec<&Estimate> = trials.iter().collect();
    ranked.sort_by(|a, b| rank(a).total_cmp(&rank(b)));
    let lowest = ranked.first().map_or(0.0, |best| rank(best));
    let mut chosen: Vec<&Estimate> = Vec::new();
    for candidate in ranked {
        let comparable = rank(candidate) <= lowest + 2.0 * at_most * COMPARABLE.ln();
        if chosen.len() < FINALISTS
            && comparable
            && !chosen.iter().any(|known| same(known, candidate))
        {
            chosen.push(candidate);
        }
    }
    chosen
}

/// What estimates from few lines are ranked by, with a handicap for those that have not converged.
pub(super) fn rank(estimate: &Estimate) -> f64 {
    estimate.standing.unwrap_or(estimate.misfit) + handicap(estimate)
}

/// What is added to the −2 log-likelihood of an estimate that has not converged before it is ranked.
pub(super) fn handicap(estimate: &Estimate) -> f64 {
    match estimate.converged {
        true => 0.0,
        false => DECISIVE_MISFIT,
    }
}

/// Whether two estimates from the same lines are one minimum.
pub(super) fn same(one: &Estimate, other: &Estimate) -> bool {
    let close = |tolerance: f64| {
        (0..one.unknowns.len()).all(|index| {
            let (a, b) = (one.unknowns[index], other.unknowns[index]);
            let scale = one.information[(index, index)]
                .max(f64::MIN_POSITIVE)
                .sqrt()
                .recip();
            (a - b).abs() <= tolerance * a.abs().max(b.abs()).max(scale)
        })
    };
    let equally_good = (one.misfit - other.misfit).abs() <= SAME_MISFIT;
    let noise = (one.cost / one.measurements as f64).sqrt();
    let is_within_noise = (0..one.unknowns.len()).all(|index| {
        let moved = (one.unknowns[index] - other.unknowns[index]).abs();
        moved * one.information[(index, index)].sqrt() <= SAME_DEVIATION * noise
    });
    equally_good && close(NEAR_UNKNOWN) || close(SAME_UNKNOWN) || is_within_noise
}
