//! What reading does to a decay: a model's own decay, step by step in time, read as the record was.
//!
//! Over a window and ten half-periods the amplitude may fall by half. Then what is read is not what the model has at the
//! mean amplitude: it is averaged, and the energy that the heat of a cycle is taken from grows otherwise than the square of
//! the amplitude. A decay of the model has the same errors, and they are taken off.

use std::f64::consts::TAU;

use bolted_joint_dynamics::law::Law;
use nalgebra::DMatrix;

use super::stretch::Stretch;
use super::{HALF_PERIODS, Record, Stretches, WINDOW};
use crate::response::backbone::{BackboneLine, BackboneRun, Row};
use crate::response::fit::Fit;
use crate::response::model::{Model, ResponseUnknown, Values};

/// Steps in a period, and every how many of them there is a sample. With 6,400 steps a law that loses a fifth of its stiffness of
/// small motion has a frequency that is 4·10⁻⁶ of itself lower or higher, and a damping ratio that differs by 10⁻⁴ of itself.
const STEPS: f64 = 200.0;
const EVERY: usize = 4;
/// Half the difference of ln A that slopes are taken over: of the size of what is read at once.
const STEP: f64 = 0.1;
/// Samples at most, and how many times as long as what was measured a model's decay may take: a model with next to no damping
/// would go on for ever.
const MOST: usize = 400_000;
const AS_LONG: f64 = 5.0;
/// By how much the first amplitude that is read should be above the first that was measured, and how often that is tried.
const ABOVE: f64 = 1.1;
const RELEASES: usize = 3;
/// Longest step of an unknown that derivatives are taken over, as part of its size; of the logarithm of a law's.
const LONGEST: f64 = 0.05;

/// How what is read from a model's decay follows the model's unknowns, about one place among them.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::response) struct Following {
    at: Values,
    /// What each line has beyond the model's reading there, of frequencies and of damping ratios.
    beyond: [Vec<f64>; 2],
    /// How that reading grows with the unknowns.
    by: [DMatrix<f64>; 2],
}

impl Following {
    /// Deviations of frequencies (0) or damping ratios (1) with their derivatives, for these values.
    ///
    /// The model's own curve is not asked: it may have a corner, which reading makes round.
    pub(in crate::response) fn rows(
        &self,
        model: &Model,
        values: &Values,
        kind: usize,
    ) -> Vec<Row> {
        let grown = &self.by[kind] * model.change(&self.at, values);
        let lines = self.beyond[kind].iter().enumerate();
        lines
            .map(|(line, beyond)| {
                let by = self.by[kind].row(line);
                (
                    beyond - grown[line],
                    by.iter().map(|entry| -entry).collect(),
                )
            })
            .collect()
    }
}

/// A decay corrected for the model that was fitted, with how its reading follows the unknowns.
///
/// What is read depends on the model nearly as much as what the model has. A fit that took the correction as fixed would come
/// to its end slowly, and with too small errors. What `near` has is kept of how the reading follows.
pub(in crate::response) fn followed(
    model: &Model,
    fit: &Fit,
    run: &BackboneRun,
    near: Option<&Following>,
) -> BackboneRun {
    let Some(read) = read(model, &fit.values, run) else {
        return run.clone();
    };
    let here = beyond_reading(model, &fit.values, run, &read);
    let mut own = corrected_by(model, &fit.values, run, &read);
    let by = match near {
        Some(near) => Some(near.by.clone()),
        None => by_unknowns(model, fit, run),
    };
    own.following = by.map(|by| Following {
        at: fit.values,
        beyond: [0, 1].map(|kind| here.iter().map(|own| own[kind]).collect()),
        by,
    });
    own
}

/// How what is read from a model's decay grows with the unknowns. `None` where that cannot be said.
fn by_unknowns(model: &Model, fit: &Fit, run: &BackboneRun) -> Option<[DMatrix<f64>; 2]> {
    let beyond = |values: &Values| {
        let read = read(model, values, run)?;
        Some(beyond_reading(model, values, run, &read))
    };
    let size = (run.lines.len(), model.unknowns.len());
    let mut by = [0, 1].map(|_| DMatrix::zeros(size.0, size.1));
    for (column, &unknown) in model.unknowns.iter().enumerate() {
        let mut place = fit.values;
        let Some(place) = place.place(unknown) else {
            continue;
        };
        let longest = match unknown {
            ResponseUnknown::Slider(_) => LONGEST,
            _ if *place != 0.0 => LONGEST * place.abs(),
            _ => f64::INFINITY,
        };
        // what the others being known would leave uncertain
        let deviation = fit.information[(column, column)].sqrt().recip();
        let step = deviation.min(longest);
        if !(step > 0.0 && step.is_finite()) {
            return None;
        }
        // To both sides: two unknowns that act alike and against each other, as k and h do on the displacement of the corner,
        // would else seem to be told apart by the curvature.
        let side = |sign: f64| {
            let mut moved = fit.values;
            if let Some(place) = moved.place(unknown) {
                *place += sign * step;
            }
            beyond(&moved)
        };
        let (above, below) = side(1.0).zip(side(-1.0))?;
        for (line, (above, below)) in above.iter().zip(&below).enumerate() {
            for kind in [0, 1] {
                by[kind][(line, column)] = (below[kind] - above[kind]) / (2.0 * step);
            }
        }
    }
    Some(by)
}

/// What each line of a run has beyond the model, and how long the model takes from the first amplitude to the last, s.
pub(in crate::response) type Beside = (Vec<[f64; 2]>, Option<f64>);

/// A run beside the model: beside the reading of its own decay, where the run is one and the model has one.
pub(in crate::response) fn beside(model: &Model, values: &Values, run: &BackboneRun) -> Beside {
    let own = read(model, values, run);
    let beyond = own
        .as_ref()
        .map(|read| beyond_reading(model, values, run, read));
    let duration_s = own.and_then(|read| {
        let [from, to] = [run.lines.first()?, run.lines.last()?]
            .map(|line| read_at(&read, line.amplitude_m)?.time_s);
        Some(to? - from?)
    });
    let plain = || {
        let lines = run.lines.iter();
        lines.map(|line| line.beyond(model, values)).collect()
    };
    (beyond.unwrap_or_else(plain), duration_s)
}

/// What each line of a run has beyond what was read of the model's own decay: of the logarithm of the frequency and of the
/// damping ratio.
fn beyond_reading(
    model: &Model,
    values: &Values,
    run: &BackboneRun,
    read: &[BackboneLine],
) -> Vec<[f64; 2]> {
    let corrections = corrections(model, values, run, read);
    let lines = run.lines.iter().zip(corrections);
    let both = lines.map(|(line, correction)| {
        let measured = line.beyond(model, values);
        [0, 1].map(|kind| measured[kind] - correction[kind])
    });
    both.collect()
}

/// A decay as it would have been read if reading had no errors, where `values` are those of the joint; others as they are.
pub(in crate::response) fn corrected(
    model: &Model,
    values: &Values,
    run: &BackboneRun,
) -> BackboneRun {
    match read(model, values, run) {
        Some(read) => corrected_by(model, values, run, &read),
        None => run.clone(),
    }
}

/// A decay corrected by what was `read` of the model's own.
fn corrected_by(
    model: &Model,
    values: &Values,
    run: &BackboneRun,
    read: &[BackboneLine],
) -> BackboneRun {
    let mut own = run.clone();
    let corrections = corrections(model, values, run, read);
    for (line, [of_frequency, of_ratio]) in own.lines.iter_mut().zip(corrections) {
        line.omega *= (-of_frequency).exp();
        line.damping_ratio = line.damping_ratio.map(|ratio| ratio - of_ratio);
    }
    let slopes = own.lines.iter().map(|line| slopes(model, values, line));
    let slopes: Vec<[f64; 2]> = slopes.collect();
    let errors = own.errors.take();
    own.errors = errors.map(|errors| {
        let mut following = errors.clone();
        match following.follow(&run.lines, &slopes) {
            Some(()) => following,
            None => errors,
        }
    });
    own
}

/// d ln ω/d ln A and dζ/d ln A of the model at a line.
fn slopes(model: &Model, values: &Values, line: &BackboneLine) -> [f64; 2] {
    let at = |side: f64| {
        let amplitude_m = line.amplitude_m * (side * STEP).exp();
        BackboneLine {
            amplitude_m,
            ..*line
        }
        .beyond(model, values)
    };
    let (above, below) = (at(1.0), at(-1.0));
    // what is measured stands still
    [0, 1].map(|kind| -(above[kind] - below[kind]) / (2.0 * STEP))
}

/// By how much the logarithm of each frequency and each damping ratio is read too large.
fn corrections(
    model: &Model,
    values: &Values,
    run: &BackboneRun,
    read: &[BackboneLine],
) -> Vec<[f64; 2]> {
    // What is read is smooth over many half-periods, while the model's curve may have a corner: it is what is read that may
    // be interpolated, not what it is beyond the model.
    let lines = run.lines.iter();
    let at = lines.map(|line| read_at(read, line.amplitude_m));
    at.map(|own| own.map_or([0.0; 2], |own| own.beyond(model, values)))
        .collect()
}

/// What is read of the model's own decay. `None` where the model has none.
fn read(model: &Model, values: &Values, run: &BackboneRun) -> Option<Vec<BackboneLine>> {
    let sigma_s = run.errors.as_ref()?.sigma_s;
    let mut read = simulated(values, &run.lines, sigma_s)?.lines(0, 1.0);
    let is_finite = |line: &BackboneLine| {
        let beyond = line.beyond(model, values);
        beyond.iter().all(|value| value.is_finite())
    };
    read.retain(is_finite);
    (!read.is_empty()).then_some(read)
}

/// What is read at an amplitude, or at the nearest. Amplitudes fall.
fn read_at(read: &[BackboneLine], amplitude_m: f64) -> Option<BackboneLine> {
    let (first, last) = (read.first()?, read.last()?);
    let mut pairs = read.windows(2);
    let found = match pairs.find(|pair| pair[1].amplitude_m <= amplitude_m) {
        _ if amplitude_m >= first.amplitude_m => *first,
        None => *last,
        Some(pair) => between(&pair[0], &pair[1], amplitude_m),
    };
    Some(found)
}

/// What is read at an amplitude between those of two lines.
fn between(above: &BackboneLine, below: &BackboneLine, amplitude_m: f64) -> BackboneLine {
    let share =
        (amplitude_m / above.amplitude_m).ln() / (below.amplitude_m / above.amplitude_m).ln();
    let between = |above: Option<f64>, below: Option<f64>| {
        let pair = above.zip(below);
        pair.map(|(above, below)| above + share * (below - above))
    };
    BackboneLine {
        amplitude_m,
        omega: above.omega * (below.omega / above.omega).powf(share),
        damping_ratio: between(above.damping_ratio, below.damping_ratio),
        force_n: None,
        time_s: between(above.time_s, below.time_s),
    }
}

/// The model's decay over the amplitudes of these points.
fn simulated(values: &Values, lines: &[BackboneLine], sigma_s: f64) -> Option<Stretches> {
    let first = lines.first()?;
    let amplitudes = lines.iter().map(|line| line.amplitude_m);
    let least = amplitudes.fold(f64::INFINITY, f64::min);
    let omega = first.omega;
    // the window and the first stretch lie before the first point
    let before_s = WINDOW * sigma_s + 0.25 * TAU / omega * HALF_PERIODS as f64;
    let rate = first.damping_ratio.unwrap_or(0.0).max(0.0) * omega;
    let mut released_m = first.amplitude_m * (rate * before_s).exp() * ABOVE;
    let times = lines.iter().filter_map(|line| line.time_s);
    let duration_s = times.fold(0.0_f64, f64::max);
    let longest_s = AS_LONG * duration_s + 4.0 * before_s;
    let read = |released_m: f64| {
        let record = decay(values, released_m, least, omega, (before_s, longest_s))?;
        let points = record.points(omega, sigma_s, 0.0);
        let stretches = points.windows(HALF_PERIODS);
        let stretches = stretches.map(|own| Stretch::of(own, sigma_s));
        Some(stretches.collect::<Vec<_>>())
    };
    let mut stretches = read(released_m)?;
    // above the first point there may be more damping than at it
    for _ in 0..RELEASES {
        let above = stretches.first()?.amplitude / first.amplitude_m;
        if above > 1.0 {
            break;
        }
        released_m *= ABOVE / above;
        stretches = read(released_m)?;
    }
    Some(Stretches {
        omega,
        sigma_s,
        of_noise: 0.0,
        stretches,
    })
}

/// Displacements after a release at rest, to which the law came straight, until `before_s` after the amplitude is `least_m`.
fn decay(
    values: &Values,
    released_m: f64,
    least_m: f64,
    omega: f64,
    (before_s, longest_s): (f64, f64),
) -> Option<Record> {
    let h = TAU / omega / STEPS;
    let most = ((longest_s / h) as usize).min(MOST * EVERY);
    // sin ½ω′h = ½ωh of Verlet's ω′: a mass and a damper that are larger by (ωh)²/12 give back ω
    let slower = 1.0 + (TAU / STEPS).powi(2) / 12.0;
    let mass = 0.5 * values.mass * slower;
    let slider = values.slider.map(|slider| slider.first_loading());
    let (spring, damper) = (
        0.5 * values.support_stiffness + values.spring(),
        values.relative_damping(),
    );
    let loading = |way: f64| slider.as_ref().map_or(0.0, |law| law.at(way));
    let of_spring = |u: f64| spring * u + values.terms.load::<f64>(&[], u, 0.0);
    // Masing: f = f_r ∓ 2 F(|u − u_r|/2) from the last turn; as the motion decays no loop closes
    let (mut u, mut v) = (released_m, 0.0_f64);
    let (mut turn, mut at_turn) = (u, loading(u));
    let load = |u: f64, turn: f64, at_turn: f64| {
        at_turn + 2.0 * (u - turn).signum() * loading(0.5 * (u - turn).abs())
    };
    let mut a = -(of_spring(u) + at_turn) / mass;
    let mut samples = Vec::new();
    let (mut largest, mut left) = (released_m, None);
    for step in 0..most {
        if step % EVERY == 0 {
            samples.push(u);
        }
        let (at, before) = (u, v);
        u += h * v + 0.5 * h * h * a;
        let damping = slower * (damper + values.terms.damping(u));
        // v′ = v + ½h (a + a′), a′ = −(f + c v′)/M
        let moved = |force: f64| {
            let v = (before + 0.5 * h * (a - force / mass)) / (1.0 + 0.5 * h * damping / mass);
            (v, -(force + damping * v) / mass)
        };
        let (v_next, a_next) = moved(of_spring(u) + load(u, turn, at_turn));
        (v, a) = match before * v_next < 0.0 {
            false => (v_next, a_next),
            true => {
                // the turn lies within the step, where v = v₀ + (v₁ − v₀) t/h passes zero; behind it the law is another
                let farthest = at + 0.5 * h * before * before / (before - v_next);
                (turn, at_turn) = (farthest, load(farthest, turn, at_turn));
                largest = farthest.abs();
                moved(of_spring(u) + load(u, turn, at_turn))
            }
        };
        if !u.is_finite() || u.abs() > 2.0 * released_m {
            return None;
        }
        if left.is_none() && largest < least_m {
            // until the window and a stretch behind it are there
            left = Some(step + (2.0 * before_s / h) as usize);
        }
        if left.is_some_and(|end| step > end) {
            break;
        }
    }
    Some(Record {
        interval_s: h * EVERY as f64,
        values: samples,
    })
}
