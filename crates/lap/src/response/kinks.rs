//! How far an estimate may be off where the likelihood has a kink: deviations that the slope on one side of it makes too small.
//!
//! A law slips through from some displacement on. Where that is next to the amplitude of a measured point, derivatives say on one side
//! that this point tells all, and nothing on the other. So the unknowns that move the kink are led away from the estimate, while all
//! others follow, until χ² has risen by what an interval of 95 % allows. And where few points lie beyond the kink, χ² has a minimum
//! wherever it may be among them: those that are as good belong to the interval.

use bolted_joint_statistics::NORMAL_975;
use nalgebra::{DMatrix, DVector};

use super::backbone::BackboneRun;
use super::choice::Candidate;
use super::data::{SineLine, Use};
use super::decay::InTime;
use super::fit::{self, Data, Fit, Kind};
use super::model::{Model, ResponseUnknown, Values};
use super::slider::{Slider, SliderParameter};
use super::study::{LapResponseStudy, Noise};
use super::told::Searched;

/// Deviations at which χ² is looked at first, and the part of their square by which it has to have risen there.
const FIRST: f64 = 2.0;
const ENOUGH: f64 = 0.5;
/// Deviations beyond which nothing is looked for.
const FARTHEST: f64 = 64.0;
/// Bisections of the last doubling.
const BISECTIONS: usize = 5;
/// Gaps between points in which the kink is looked for on either side of where it is …
const GAPS: usize = 3;
/// … where at most so many points lie beyond it: more of them tell where it is.
const FEW_BEYOND: usize = 12;
/// So few are told.
const FEWEST_BEYOND: usize = 3;
/// How often an estimate is left for a better one.
const RESTARTS: usize = 3;
/// By so much χ² has to fall for an estimate to be none.
const LOWER: f64 = 0.5;

/// The candidate, or a better estimate of its law, and by how much the deviation of each of its unknowns, as it is searched, has to be
/// raised.
pub(super) fn at_kinks(study: &LapResponseStudy, mut chosen: Candidate) -> (Candidate, Vec<f64>) {
    let model = chosen.model(study);
    let mut raised = vec![1.0; model.unknowns.len()];
    // decays pass every amplitude, and what is read of them has no such corners
    if model.terms.slider().is_none() || chosen.in_time != InTime::NoDecay {
        return (chosen, raised);
    }
    let runs = study.sines.iter().filter(|run| run.used_for == Use::Fit);
    let lines: Vec<SineLine> = runs.flat_map(|run| run.lines.iter().copied()).collect();
    let runs = std::mem::take(&mut chosen.backbones);
    let backbones: Vec<&BackboneRun> = runs.iter().collect();
    let data = Data {
        lines: &lines,
        backbones: &backbones,
    };
    for _ in 0..RESTARTS {
        let base = chosen.free.as_ref().unwrap_or(&chosen.fit);
        let factor = study.raised_by(base);
        let covariance = Searched::of(&model, base, factor).covariance;
        match along((&model, data, &study.noise), base, &covariance, factor) {
            Along::Raised(found) => {
                raised = found;
                break;
            }
            Along::Lower(lower) => {
                let again = |kind| fit::fit(&model, data, &study.noise, &lower.values, kind);
                let Ok(fit) = again(Kind::Passive) else { break };
                if fit.chi_squared >= chosen.fit.chi_squared {
                    break;
                }
                let free = match fit.at_limits.is_empty() {
                    true => None,
                    false => again(Kind::Free).ok(),
                };
                chosen.free = free.filter(|free| free.chi_squared < fit.chi_squared);
                chosen.fit = fit;
            }
        }
    }
    chosen.backbones = runs;
    (chosen, raised)
}

/// What is found along the unknowns that move the kink.
enum Along {
    /// By how much the deviation of each unknown, as it is searched, has to be raised; by 1 at least.
    Raised(Vec<f64>),
    /// A better estimate.
    Lower(Box<Fit>),
}

/// Looks about an estimate whose unknowns have this covariance, as they are searched; χ² counts in parts of `factor`.
fn along(
    (model, data, noise): (&Model, Data<'_>, &Noise),
    base: &Fit,
    covariance: &DMatrix<f64>,
    factor: f64,
) -> Along {
    let mut raised = vec![1.0_f64; model.unknowns.len()];
    let others = starts_beside(data, base);
    if others.is_empty() {
        return Along::Raised(raised);
    }
    let movers: Vec<ResponseUnknown> = (model.unknowns.iter().copied())
        .filter(|unknown| moves_a_kink(model, *unknown))
        .collect();
    for values in others {
        // where no minimum is, and χ² yet hardly larger
        for held in &movers {
            let held = fit::fit(&without(model, *held), data, noise, &values, Kind::Free);
            let is_as_good =
                |found: &Fit| found.chi_squared - base.chi_squared < factor * NORMAL_975.powi(2);
            if let Some(found) = held.ok().filter(is_as_good) {
                let change = model.change(&base.values, &found.values);
                raise(&mut raised, covariance, &change);
            }
        }
        let Ok(found) = fit::fit(model, data, noise, &values, Kind::Free) else {
            continue;
        };
        let rise = (found.chi_squared - base.chi_squared) / factor;
        if rise < -LOWER {
            return Along::Lower(Box::new(found));
        }
        if rise < NORMAL_975.powi(2) {
            let own = Searched::of(model, &found, factor).covariance.diagonal();
            let reaches = model.change(&base.values, &found.values).abs();
            raise(
                &mut raised,
                covariance,
                &(reaches + NORMAL_975 * own.map(f64::sqrt)),
            );
        }
    }
    for (place, unknown) in model.unknowns.iter().enumerate() {
        let variance = covariance[(place, place)];
        let is_told = variance > 0.0 && variance.is_finite();
        if !is_told || !moves_a_kink(model, *unknown) {
            continue;
        }
        let direction = covariance.column(place) / variance.sqrt();
        let others = without(model, *unknown);
        // where that unknown is so many deviations off, and all others follow
        let led = |deviations: f64| -> Option<Fit> {
            let values = model.moved(&base.values, &(&direction * deviations));
            fit::fit(&others, data, noise, &values, Kind::Free).ok()
        };
        for sign in [-1.0, 1.0] {
            let mut lowest: Option<Fit> = None;
            let mut risen = |deviations: f64| -> f64 {
                let Some(found) = led(sign * deviations) else {
                    return f64::INFINITY;
                };
                let rise = (found.chi_squared - base.chi_squared) / factor;
                if rise < -LOWER {
                    lowest = Some(found);
                }
                rise
            };
            let reach = reach(&mut risen);
            if let Some(found) = lowest {
                return Along::Lower(Box::new(found));
            }
            // and all that follows goes with it
            if reach > NORMAL_975
                && let Some(farthest) = led(sign * reach)
            {
                let change = model.change(&base.values, &farthest.values);
                raise(&mut raised, covariance, &change);
            }
        }
    }
    Along::Raised(raised)
}

/// The model in which this unknown is known.
fn without(model: &Model, unknown: ResponseUnknown) -> Model {
    let unknowns = model.unknowns.iter().copied();
    Model {
        unknowns: unknowns.filter(|other| *other != unknown).collect(),
        ..model.clone()
    }
}

/// By how much the deviations have to be raised for these changes to lie within 95 %.
fn raise(raised: &mut [f64], covariance: &DMatrix<f64>, reaches: &DVector<f64>) {
    for (place, raised) in raised.iter_mut().enumerate() {
        let own = NORMAL_975 * covariance[(place, place)].sqrt();
        let times = reaches[place].abs() / own;
        if own > 0.0 && times.is_finite() {
            *raised = raised.max(times);
        }
    }
}

/// Points of sines, backbones and decays (m) in their order, how many of them lie below the displacement from which on the law slips
/// through, and that displacement, m; `None` where it does not.
fn about_the_kink(data: Data<'_>, fit: &Fit) -> Option<(Vec<f64>, usize, f64)> {
    let slider = fit.values.slider?;
    let of_points = data.points().map(|point| point.amplitude_m);
    let mut all_m: Vec<f64> = (fit.amplitudes_m.iter().copied())
        .chain(of_points)
        .collect();
    all_m.sort_by(f64::total_cmp);
    let kink_m = slider.slips_at_m();
    let below = all_m.partition_point(|&amplitude_m| amplitude_m <= kink_m);
    Some((all_m, below, kink_m))
}

/// That a law's slip rests on next to nothing.
pub(super) fn of_few_beyond(study: &LapResponseStudy, fit: &Fit) -> Option<String> {
    let runs = study
        .backbones
        .iter()
        .filter(|run| run.used_for == Use::Fit);
    let backbones: Vec<&BackboneRun> = runs.collect();
    let data = Data {
        lines: &[],
        backbones: &backbones,
    };
    let (all_m, below, kink_m) = about_the_kink(data, fit)?;
    let beyond = all_m.len() - below;
    (1..=FEWEST_BEYOND).contains(&beyond).then(|| {
        let lie = if beyond == 1 { "lies" } else { "lie" };
        format!(
            "only {beyond} of {} points {lie} beyond {kink_m:.2e} m, where the law begins to slip through: what it says of that rests on \
             them; measure to larger amplitudes",
            all_m.len()
        )
    })
}

/// The law with its kink among the measured points next to where it is; nothing where many lie beyond it, or none.
fn starts_beside(data: Data<'_>, base: &Fit) -> Vec<Values> {
    let (Some(slider), Some((all_m, below, _))) = (base.values.slider, about_the_kink(data, base))
    else {
        return Vec::new();
    };
    if !(1..=FEW_BEYOND).contains(&(all_m.len() - below)) {
        return Vec::new();
    }
    let from = below.saturating_sub(1 + GAPS);
    let to = (below + 1 + GAPS).min(all_m.len());
    let gaps = all_m[from..to].windows(2);
    let places =
        gaps.flat_map(|gap| [1.0, 2.0].map(|part| gap[0] + part / 3.0 * (gap[1] - gap[0])));
    let largest_m = all_m[all_m.len() - 1];
    let moved = places.map(|kink_m| Values {
        slider: Some(slider.slipping_at(kink_m, largest_m)),
        ..base.values
    });
    moved.collect()
}

/// The deviations at which χ² has risen by what an interval of 95 % allows, where it rises by much less than its curvature says.
fn reach(risen: &mut impl FnMut(f64) -> f64) -> f64 {
    if risen(FIRST) >= ENOUGH * FIRST.powi(2) {
        return NORMAL_975;
    }
    let (mut near, mut far) = (FIRST, 2.0 * FIRST);
    while far < FARTHEST && risen(far) < NORMAL_975.powi(2) {
        (near, far) = (far, 2.0 * far);
    }
    for _ in 0..BISECTIONS {
        let middle = 0.5 * (near + far);
        match risen(middle) < NORMAL_975.powi(2) {
            true => near = middle,
            false => far = middle,
        }
    }
    far
}

/// Whether the displacement at which the law slips through follows this unknown.
fn moves_a_kink(model: &Model, unknown: ResponseUnknown) -> bool {
    match (model.terms.slider(), unknown) {
        (Some(Slider::Jenkins), ResponseUnknown::Slider(_)) => true,
        // of what is searched the logarithm of φ_max
        (Some(Slider::Iwan), ResponseUnknown::Slider(parameter)) => {
            parameter == SliderParameter::Exponent
        }
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_interval_ends_where_chi_squared_has_risen() {
        // as its curvature says
        assert_eq!(reach(&mut |t: f64| t * t), NORMAL_975);
        // a tenth of it
        let found = reach(&mut |t: f64| (0.1 * t).powi(2));
        assert!((0.0..0.5).contains(&(found - 10.0 * NORMAL_975)), "{found}");
        // never
        assert_eq!(reach(&mut |_| 0.0), FARTHEST);
    }
}
