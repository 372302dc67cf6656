//! Where the search starts: for a relative mode a linear fit of force over response, otherwise the resonances of the lowest level.

mod slipping;

use bolted_joint_dynamics::{Polynomial, law::Term};
use bolted_joint_wanted::{Pieces, step};
use nalgebra::{DMatrix, DVector};
use num_complex::Complex64;

use self::slipping::with_slider;
use super::backbone::BackboneRun;
use super::data::{SineLine, SineRun};
use super::fit::{Data, Fit, Kind, Start, fit, glanced};
use super::model::{Model, ResponseUnknown, Values};
use super::study::Noise;
use super::terms::TermSet;
use crate::error::LapError;

/// Damping ratios that are tried at each resonance.
const RATIOS: [f64; 9] = [1e-4, 3e-4, 1e-3, 3e-3, 6e-3, 0.012, 0.025, 0.05, 0.1];
/// Share of the joint's stiffness that a cubic spring starts with at the largest amplitude, of either sign.
const CUBIC_SHARE: f64 = 0.02;

/// Starts that are followed to their end, if more are tried: those that are best after a few steps.
const MOST_STARTS: usize = 4;
/// Standard deviations within which two searches came to the same estimate: where a law has a corner each point of the data
/// near it may make a minimum of its own.
const AGREES: f64 = 2.0;
/// Deviations of χ² within which noise explains it.
const BY_CHANCE: f64 = 2.0;
/// χ² per degree of freedom below which there is rounding.
const ROUNDING: f64 = 1e-6;

/// Fits the model from all starts and keeps the best, with the number of those that were followed and of those that came to it.
///
/// Where one alone of the best starts came to its estimate, the others are followed as well.
pub(super) fn best(
    model: &Model,
    runs: &[&SineRun],
    backbones: &[&BackboneRun],
    noise: &Noise,
    known: &Values,
    kind: Kind,
) -> Result<(Fit, usize, usize), LapError> {
    let lines = lines_of(runs);
    let data = Data {
        lines: &lines,
        backbones,
    };
    let mut starts = starts(model, runs, &lines, noise, known);
    if starts.is_empty() {
        starts.extend(super::backbone::start(model, data, known));
    }
    let starts: Vec<(usize, Values)> = match model.terms.slider() {
        Some(slider) => with_slider(model, data, slider, &starts),
        None => starts.into_iter().map(|start| (0, start)).collect(),
    };
    let looked_at = (starts.len() > MOST_STARTS).then(|| {
        let step = step("first looks", Pieces::Exactly(starts.len()));
        let glance = |(kind_of_start, start): &(usize, Values)| {
            let seen = glanced(model, data, noise, start, kind);
            step.done();
            let seen = seen.ok()?;
            seen.chi_squared
                .is_finite()
                .then_some((*kind_of_start, seen))
        };
        let mut seen: Vec<(usize, Fit)> = starts.iter().filter_map(glance).collect();
        seen.sort_by(|(_, a), (_, b)| a.chi_squared.total_cmp(&b.chi_squared));
        seen
    });
    let follow = |start: Start<'_>| searched(model, data, noise, start, kind);
    let mut fits = Vec::new();
    let mut followed = 0;
    let step = step("searches", Pieces::AtMost(starts.len()));
    let mut end = |ended: Result<Fit, LapError>, fits: &mut Vec<Fit>| {
        followed += 1;
        step.done();
        match ended {
            Ok(fit) if fit.values.mass > 0.0 => fits.push(fit),
            Err(error @ LapError::TooFewLines { .. }) => return Err(error),
            _ => {}
        }
        Ok(())
    };
    if let Some(seen) = &looked_at {
        let mut kinds = Vec::new();
        let mut others = Vec::new();
        for (rank, (kind_of_start, seen)) in seen.iter().enumerate() {
            // the best of all, and of each kind: few steps do not tell which of them leads farther
            let is_first = !kinds.contains(kind_of_start);
            kinds.push(*kind_of_start);
            match rank < MOST_STARTS || is_first {
                true => end(follow(seen.into()), &mut fits)?,
                false => others.push(seen),
            }
        }
        for seen in others {
            if agreeing(model, &fits) < 2 && !is_explained(noise, &fits) {
                end(follow(seen.into()), &mut fits)?;
            }
        }
    } else {
        for (_, start) in &starts {
            end(follow(start.into()), &mut fits)?;
        }
    }
    let count = agreeing(model, &fits);
    let best = fits
        .into_iter()
        .min_by(|a, b| a.chi_squared.total_cmp(&b.chi_squared));
    Ok((best.ok_or(LapError::NoEstimate)?, followed, count))
}

/// The fit from a start, and from a law of which something slips last where the first left nothing of that: a step too far to where
/// nothing is told of it, from which no further step leads back.
pub(super) fn searched<'a>(
    model: &Model,
    data: Data<'_>,
    noise: &Noise,
    start: impl Into<Start<'a>>,
    kind: Kind,
) -> Result<Fit, LapError> {
    let first = fit(model, data, noise, start, kind)?;
    let Some(again) = first.values.with_a_last_slider() else {
        return Ok(first);
    };
    let again = fit(model, data, noise, &again, kind).ok();
    let again = again.filter(|again| again.chi_squared < first.chi_squared);
    Ok(again.unwrap_or(first))
}

/// Whether the best leaves no more than the noise that is stated: then no other can be much better.
fn is_explained(noise: &Noise, fits: &[Fit]) -> bool {
    noise.is_stated
        && fits.iter().any(|fit| {
            let freedom = fit.degrees_of_freedom as f64;
            fit.chi_squared < freedom + BY_CHANCE * (2.0 * freedom).sqrt()
        })
}

/// How many fits are where the best is, and as good.
fn agreeing(model: &Model, fits: &[Fit]) -> usize {
    let best = fits
        .iter()
        .min_by(|a, b| a.chi_squared.total_cmp(&b.chi_squared));
    let Some(best) = best else {
        return 0;
    };
    let most = AGREES * AGREES * best.reduced_chi_squared().max(ROUNDING);
    let agree = |fit: &&Fit| {
        let change = model.change(&best.values, &fit.values);
        let distance = change.dot(&(&best.information * &change));
        fit.chi_squared <= best.chi_squared + most && distance <= most
    };
    fits.iter().filter(agree).count()
}

/// Fits a model to runs from the starts that the data suggest, free to be active. `known` holds the values of what is not among
/// the model's unknowns.
///
/// # Errors
/// [`LapError`] if there are too few lines or no start leads anywhere.
pub fn fit_responses(
    model: &Model,
    runs: &[SineRun],
    noise: &Noise,
    known: &Values,
) -> Result<Fit, LapError> {
    let runs: Vec<&SineRun> = runs.iter().collect();
    // The closed form of one harmonic finds the place, all harmonics refine it.
    let closed = Model {
        harmonics: 1,
        ..model.clone()
    };
    let (found, ..) = best(&closed, &runs, &[], noise, known, Kind::Free)?;
    if model.harmonics == 1 {
        return Ok(found);
    }
    let lines = lines_of(&runs);
    let data = Data {
        lines: &lines,
        backbones: &[],
    };
    fit(model, data, noise, &found.values, Kind::Free)
}

fn lines_of(runs: &[&SineRun]) -> Vec<SineLine> {
    let lines = runs.iter().flat_map(|run| &run.lines);
    lines.copied().collect()
}

fn starts(
    model: &Model,
    runs: &[&SineRun],
    data: &[SineLine],
    noise: &Noise,
    known: &Values,
) -> Vec<Values> {
    let mut starts = Vec::new();
    if model.sees_sum() {
        if let Some(linear) = two_resonances(model, runs, noise, known) {
            starts.extend(with_terms(model, data, linear));
        }
    } else if let Some(start) = (!data.is_empty())
        .then(|| force_over_response(model, data, known))
        .flatten()
    {
        starts.push(start);
        if start.terms != Polynomial::NONE {
            starts.push(Values {
                terms: Polynomial::NONE,
                ..start
            });
        }
    }
    starts
}

/// The linear model, and with a cubic spring of either sign.
fn with_terms(model: &Model, data: &[SineLine], linear: Values) -> Vec<Values> {
    let mut starts = vec![linear];
    if model.terms.terms().contains(&Term::CUBIC) {
        let amplitudes = data
            .iter()
            .map(|line| model.relative_amplitude(&linear, line));
        let largest = amplitudes.fold(0.0, f64::max);
        for share in [
            CUBIC_SHARE,
            -CUBIC_SHARE,
            0.1 * CUBIC_SHARE,
            -0.1 * CUBIC_SHARE,
        ] {
            let mut start = linear;
            *start.terms.coefficient_mut(Term::CUBIC) =
                share * linear.joint_stiffness / (largest * largest);
            starts.push(start);
        }
    }
    starts
}

/// z = F/x is linear in all numbers of a relative mode once the amplitude is taken as measured: one weighted least-squares problem.
fn force_over_response(model: &Model, data: &[SineLine], known: &Values) -> Option<Values> {
    let linear: Vec<ResponseUnknown> = model
        .unknowns
        .iter()
        .copied()
        .filter(|unknown| {
            !matches!(
                unknown,
                ResponseUnknown::OtherModesReal
                    | ResponseUnknown::OtherModesImaginary
                    | ResponseUnknown::Slider(_)
            )
        })
        .collect();
    let by_relative = model.relative_share().abs();
    let amplitudes = data.iter().map(|line| line.displacement_m / by_relative);
    let scale_amplitude = amplitudes.fold(0.0, f64::max);
    let factor = model.relative_factor();
    let mut rows: Vec<Complex64> = Vec::new();
    let mut right = Vec::new();
    for line in data {
        let omega = line.omega;
        // z_r = q d F/x
        let measured =
            factor * Complex64::from_polar(line.force_n / line.displacement_m, -line.phase_rad);
        let weight = measured.norm().recip();
        let amplitude = line.displacement_m / by_relative / scale_amplitude;
        let part = |unknown: &ResponseUnknown| match *unknown {
            ResponseUnknown::Mass => Complex64::new(-0.5 * omega * omega, 0.0),
            ResponseUnknown::SupportStiffness => Complex64::new(0.5, 0.0),
            ResponseUnknown::SupportDamping => Complex64::new(0.0, 0.5 * omega),
            ResponseUnknown::JointStiffness => Complex64::new(1.0, 0.0),
            ResponseUnknown::JointDamping => Complex64::new(0.0, omega),
            ResponseUnknown::Term(term) => {
                let share = term.describing() * amplitude.powi(term.amplitude_power());
                match term.is_damper() {
                    false => Complex64::new(share, 0.0),
                    true => Complex64::new(0.0, omega * share),
                }
            }
            ResponseUnknown::OtherModesReal
            | ResponseUnknown::OtherModesImaginary
            | ResponseUnknown::Slider(_) => Complex64::ZERO,
        };
        let fixed = Complex64::new(
            -0.5 * omega * omega * known.mass
                + 0.5 * known.support_stiffness
                + known.joint_stiffness,
            omega * (0.5 * known.support_damping + known.joint_damping),
        );
        rows.extend(linear.iter().map(|unknown| part(unknown) * weight));
        right.push((measured - fixed) * weight);
    }
    let (lines, size) = (data.len(), linear.len());
    let matrix = DMatrix::from_fn(2 * lines, size, |i, j| {
        let value = rows[(i / 2) * size + j];
        if i % 2 == 0 { value.re } else { value.im }
    });
    let right = DVector::from_fn(2 * lines, |i, _| {
        let value = right[i / 2];
        if i % 2 == 0 { value.re } else { value.im }
    });
    let norms: Vec<f64> = matrix
        .column_iter()
        .map(|column| column.norm().max(f64::MIN_POSITIVE))
        .collect();
    let mut scaled = matrix;
    for (mut column, norm) in scaled.column_iter_mut().zip(&norms) {
        column /= *norm;
    }
    let solution = bolted_joint_singular::solution(scaled, &right, 1e-13)?;
    let mut values = *known;
    for ((unknown, value), norm) in linear.iter().zip(solution.iter()).zip(&norms) {
        let power = match unknown {
            ResponseUnknown::Term(term) => scale_amplitude.powi(term.amplitude_power()),
            _ => 1.0,
        };
        if let Some(place) = values.place(*unknown) {
            *place = value / norm / power;
        }
    }
    Some(values)
}

/// The linear lap from the two highest peaks of the lowest level: the damping ratios that fit best of a few, the mass from the size
/// of the receptance, then a fit of that level.
fn two_resonances(
    model: &Model,
    runs: &[&SineRun],
    noise: &Noise,
    known: &Values,
) -> Option<Values> {
    // The runs of the lowest force may each hold one resonance: they are taken together.
    let lowest = runs
        .iter()
        .map(|run| mean_force(run))
        .fold(f64::INFINITY, f64::min);
    let of_lowest = runs.iter().filter(|run| mean_force(run) < 1.5 * lowest);
    let mut lines: Vec<SineLine> = of_lowest
        .flat_map(|run| run.lines.iter().copied())
        .collect();
    lines.sort_by(|a, b| a.omega.total_cmp(&b.omega));
    let size: Vec<f64> = lines
        .iter()
        .map(|line| line.displacement_m / line.force_n)
        .collect();
    let highest = (0..size.len()).max_by(|&a, &b| size[a].total_cmp(&size[b]))?;
    // The other resonance is the line that stands highest above the lowest point between it and the first.
    let prominence = |place: usize| {
        let between = place.min(highest)..=place.max(highest);
        let valley = size[between].iter().copied().fold(f64::INFINITY, f64::min);
        size[place] / valley
    };
    let other = (0..size.len())
        .filter(|&place| place != highest)
        .max_by(|&a, &b| prominence(a).total_cmp(&prominence(b)))?;
    let mut omegas = [highest, other].map(|place| lines[place].omega);
    omegas.sort_by(f64::total_cmp);
    let [first, second] = omegas;
    if first >= second {
        return None;
    }
    let with = |mass: f64, ratios: (f64, f64)| Values {
        mass,
        support_stiffness: mass * first * first,
        joint_stiffness: 0.5 * mass * (second * second - first * first),
        support_damping: 2.0 * ratios.0 * first * mass,
        joint_damping: (ratios.1 * second - ratios.0 * first) * mass,
        ..Values::default()
    };
    let mut best: Option<(f64, Values)> = None;
    for one in RATIOS {
        for two in RATIOS {
            let unit = with(1.0, (one, two));
            let logs: Vec<Complex64> = lines
                .iter()
                .map(|line| {
                    let measured =
                        Complex64::from_polar(line.displacement_m / line.force_n, line.phase_rad);
                    (measured / model.receptance(&unit, 0.0, line.omega).0).ln()
                })
                .collect();
            // The receptance is inverse to the mass at given frequencies and ratios.
            let shift = logs.iter().map(|log| log.re).sum::<f64>() / logs.len() as f64;
            let cost: f64 = logs
                .iter()
                .map(|log| (log.re - shift).powi(2) + log.im.powi(2))
                .sum();
            if best.as_ref().is_none_or(|(least, _)| cost < *least) {
                best = Some((cost, with((-shift).exp(), (one, two))));
            }
        }
    }
    let mut start = best?.1;
    // What is known stays as it is.
    for unknown in [
        ResponseUnknown::Mass,
        ResponseUnknown::SupportStiffness,
        ResponseUnknown::SupportDamping,
        ResponseUnknown::JointStiffness,
        ResponseUnknown::JointDamping,
    ] {
        if !model.unknowns.contains(&unknown)
            && let Some(place) = start.place(unknown)
        {
            *place = known.of(unknown);
        }
    }
    let linear = Model {
        terms: TermSet::default(),
        unknowns: model
            .unknowns
            .iter()
            .copied()
            .filter(|unknown| {
                !matches!(
                    unknown,
                    ResponseUnknown::Term(_) | ResponseUnknown::Slider(_)
                )
            })
            .collect(),
        ..model.clone()
    };
    let data = Data {
        lines: &lines,
        backbones: &[],
    };
    let fitted = fit(&linear, data, noise, &start, Kind::Free)
        .ok()
        .map(|fit| fit.values);
    Some(fitted.filter(|values| values.mass > 0.0).unwrap_or(start))
}

fn mean_force(run: &SineRun) -> f64 {
    run.lines.iter().map(|line| line.force_n).sum::<f64>() / run.lines.len().max(1) as f64
}
