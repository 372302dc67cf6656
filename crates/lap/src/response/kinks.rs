//! How far an estimate may be off where the likelihood has a kink: deviations that the slope on one side of it makes too small.
//!
//! A law slips through from some displacement on. Where that is next to the amplitude of a measured point, derivatives say on one side
//! that this point tells all, and nothing on the other. And where few points lie beyond the kink, χ² has a minimum wherever it may be
//! among them. So it is held at places in the gaps between them, while all else follows, and then led away from the estimate, until χ²
//! has risen by what an interval of 95 % allows. No place is more deviations off than the root of its χ² says.

use bolted_joint_statistics::NORMAL_975;
use bolted_joint_wanted::{Pieces, step};
use nalgebra::{DMatrix, DVector};

use super::backbone::BackboneRun;
use super::choice::Candidate;
use super::data::{SineLine, Use};
use super::fit::{self, Data, Fit, Kind};
use super::model::{Model, ResponseUnknown, Values};
use super::slider::{Slider, SliderParameter};
use super::start::searched;
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
/// … at these parts of each, from some of which all unknowns are searched. The last ones are close, since what lies just beyond the
/// kink tells the less of it the nearer it is.
const PARTS_OF_GAP: [(f64, bool); 7] = [
    (0.05, false),
    (0.2, false),
    (0.35, true),
    (0.5, false),
    (0.65, true),
    (0.8, false),
    (0.95, false),
];
/// … where at most so many points lie beyond it: more of them tell where it is.
const FEW_BEYOND: usize = 12;
/// So few are told.
const FEWEST_BEYOND: usize = 3;
/// How often an estimate is left for a better one.
const RESTARTS: usize = 3;
/// Where χ² is larger by more than this beyond what an interval of 95 % allows, no place is looked at: chance leads there in one of
/// 16,000 tests.
const LOOKED_AT: f64 = 12.2;
/// By so much χ² has to fall for an estimate to be none.
const LOWER: f64 = 0.5;

/// The candidate, or a better estimate of its law, with how much the deviation of each of its unknowns, as it is searched, has to be
/// raised.
pub(super) fn at_kinks(study: &LapResponseStudy, mut chosen: Candidate) -> Candidate {
    let model = chosen.model(study);
    let mut raised = vec![1.0; model.unknowns.len()];
    // decays pass every amplitude, and what is read of them has no such corners
    if model.terms.slider().is_none() || chosen.backbones.iter().any(|run| run.errors.is_some()) {
        return chosen;
    }
    let runs = study.sines.iter().filter(|run| run.used_for == Use::Fit);
    let lines: Vec<SineLine> = runs.flat_map(|run| run.lines.iter().copied()).collect();
    let runs = std::mem::take(&mut chosen.backbones);
    let backbones: Vec<&BackboneRun> = runs.iter().collect();
    let data = Data {
        lines: &lines,
        backbones: &backbones,
    };
    let _step = step("corners of the law", Pieces::Unknown);
    for restart in 0..=RESTARTS {
        let base = chosen.free.as_ref().unwrap_or(&chosen.fit);
        let factor = study.raised_by(base);
        let covariance = Searched::of(&model, base, factor).covariance;
        let lower;
        (raised, lower) = along((&model, data, &study.noise), base, &covariance, factor);
        let Some(lower) = lower.filter(|_| restart < RESTARTS) else {
            break;
        };
        let again = |kind| searched(&model, data, &study.noise, &lower.values, kind);
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
        // those before came to another
        chosen.starts = (chosen.starts.0 + 1, 1);
    }
    chosen.backbones = runs;
    chosen.raised = raised;
    chosen
}

/// By how much the deviation of each unknown, as it is searched, has to be raised about an estimate with this covariance, by 1 at least;
/// and a better estimate, if one was found. χ² counts in parts of `factor`.
fn along(
    (model, data, noise): (&Model, Data<'_>, &Noise),
    base: &Fit,
    covariance: &DMatrix<f64>,
    factor: f64,
) -> (Vec<f64>, Option<Fit>) {
    let mut raised = vec![1.0_f64; model.unknowns.len()];
    let others = starts_beside(data, base);
    let mut unknowns = model.unknowns.iter();
    let kink = unknowns.position(|unknown| moves_a_kink(model, *unknown));
    let Some(kink) = kink.filter(|_| !others.is_empty()) else {
        return (raised, None);
    };
    let rise = |found: &Fit| (found.chi_squared - base.chi_squared) / factor;
    let mut lowest: Option<Fit> = None;
    let mut keep_if_lower = |found: Fit| {
        let before = lowest.as_ref().map_or(-LOWER, rise);
        if rise(&found) < before {
            lowest = Some(found);
        }
    };
    let held = without(model, model.unknowns[kink]);
    let at_kink = |values: &Values| fit::fit(&held, data, noise, values, Kind::Free).ok();
    // how far the unknowns are off, in parts of what χ² allows; all others reach as far as it may still rise
    let reaches = |found: &Fit| {
        let far = model.change(&base.values, &found.values).abs();
        let left = NORMAL_975.powi(2) - rise(found);
        if left <= 0.0 {
            return (-left < LOOKED_AT).then(|| far * (NORMAL_975 / rise(found).sqrt()));
        }
        let own = Searched::of(&held, found, factor).covariance.diagonal();
        let beyond = own.insert_row(kink, 0.0).map(|own| (left * own).sqrt());
        Some(far + beyond)
    };
    for (values, is_start) in others {
        // where no minimum is, and χ² yet hardly larger
        if let Some(found) = at_kink(&values) {
            if let Some(reaches) = reaches(&found) {
                raise(&mut raised, covariance, &reaches);
            }
            keep_if_lower(found);
        }
        if !is_start {
            continue;
        }
        let Ok(found) = searched(model, data, noise, &values, Kind::Free) else {
            continue;
        };
        if rise(&found) < NORMAL_975.powi(2) {
            let own = Searched::of(model, &found, factor).covariance.diagonal();
            let reaches = model.change(&base.values, &found.values).abs();
            raise(
                &mut raised,
                covariance,
                &(reaches + NORMAL_975 * own.map(f64::sqrt)),
            );
        }
        keep_if_lower(found);
    }
    let variance = covariance[(kink, kink)];
    if !(variance > 0.0 && variance.is_finite()) {
        return (raised, lowest);
    }
    let direction = covariance.column(kink) / variance.sqrt();
    // where the kink is so many deviations off, and all others follow
    let led = |deviations: f64| at_kink(&model.moved(&base.values, &(&direction * deviations)));
    for sign in [-1.0, 1.0] {
        let mut risen = |deviations: f64| {
            led(sign * deviations).map_or(f64::INFINITY, |found| {
                let rise = rise(&found);
                keep_if_lower(found);
                rise
            })
        };
        let reach = reach(&mut risen);
        // and all that follows goes with it
        if reach > NORMAL_975
            && let Some(farthest) = led(sign * reach)
        {
            let change = model.change(&base.values, &farthest.values);
            raise(&mut raised, covariance, &change);
        }
    }
    (raised, lowest)
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

/// The law with its kink among the measured points next to where it is, or among the last ones where it is beyond all; nothing where
/// many points lie beyond it. And whether a search is to begin there.
fn starts_beside(data: Data<'_>, base: &Fit) -> Vec<(Values, bool)> {
    let (Some(slider), Some((all_m, below, _))) = (base.values.slider, about_the_kink(data, base))
    else {
        return Vec::new();
    };
    if all_m.len() - below > FEW_BEYOND {
        return Vec::new();
    }
    let from = below.saturating_sub(1 + GAPS);
    let to = (below + 1 + GAPS).min(all_m.len());
    let gaps = all_m[from..to].windows(2);
    let places = gaps.flat_map(|gap| {
        PARTS_OF_GAP.map(|(part, is_start)| (gap[0] + part * (gap[1] - gap[0]), is_start))
    });
    let largest_m = all_m[all_m.len() - 1];
    let moved = places.map(|(kink_m, is_start)| {
        let values = Values {
            slider: Some(slider.slipping_at(kink_m, largest_m)),
            ..base.values
        };
        (values, is_start)
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
    // what is searched in their places are the logarithms of F_S/K_T and of φ_max
    matches!(
        (model.terms.slider(), unknown),
        (
            Some(Slider::Jenkins),
            ResponseUnknown::Slider(SliderParameter::SlipForce)
        ) | (
            Some(Slider::Iwan),
            ResponseUnknown::Slider(SliderParameter::Exponent)
        )
    )
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
