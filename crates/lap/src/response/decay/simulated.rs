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

/// Steps in a period, and every how many of them there is a sample.
const STEPS: f64 = 400.0;
const EVERY: usize = 8;
/// Half the difference of ln A that slopes are taken over: of the size of what is read at once.
const STEP: f64 = 0.1;
/// Samples at most.
const MOST: usize = 400_000;
/// By how much the first amplitude that is read should be above the first that was measured, and how often that is tried.
const ABOVE: f64 = 1.1;
const RELEASES: usize = 3;
/// Longest step of an unknown that derivatives are taken over, as part of its size; of the logarithm of a law's.
const LONGEST: f64 = 0.05;

/// How the reading of a decay follows the model's unknowns: the measured curve is corrected for one place among them.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::response) struct Following {
    at: Values,
    /// Of the corrections of each line, frequency and ratio, by the unknowns.
    by: [DMatrix<f64>; 2],
}

impl Following {
    /// Deviations of frequencies (0) or damping ratios (1) as they are with the correction for these values.
    pub(in crate::response) fn follow(
        &self,
        model: &Model,
        values: &Values,
        kind: usize,
        rows: &mut [Row],
    ) {
        let change = model.change(&self.at, values);
        let beyond = &self.by[kind] * change;
        for (line, (deviation, by)) in rows.iter_mut().enumerate() {
            *deviation -= beyond[line];
            for (entry, own) in by.iter_mut().zip(self.by[kind].row(line).iter()) {
                *entry -= own;
            }
        }
    }
}

/// A decay corrected for the model that was fitted, with how the correction follows its unknowns.
///
/// What is read depends on the model nearly as much as what the model has. A fit that took the correction as fixed would come
/// to its end slowly, and with too small errors.
pub(in crate::response) fn followed(model: &Model, fit: &Fit, run: &BackboneRun) -> BackboneRun {
    let mut own = corrected(model, &fit.values, run);
    let Some(here) = corrections(model, &fit.values, run) else {
        return own;
    };
    let size = (run.lines.len(), model.unknowns.len());
    let mut by = [0, 1].map(|_| DMatrix::zeros(size.0, size.1));
    for (column, &unknown) in model.unknowns.iter().enumerate() {
        let mut moved = fit.values;
        let Some(place) = moved.place(unknown) else {
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
            continue;
        }
        *place += step;
        let Some(there) = corrections(model, &moved, run) else {
            continue;
        };
        for (line, (there, here)) in there.iter().zip(&here).enumerate() {
            for kind in [0, 1] {
                by[kind][(line, column)] = (there[kind] - here[kind]) / step;
            }
        }
    }
    own.following = Some(Following { at: fit.values, by });
    own
}

/// A decay as it would have been read if reading had no errors, where `values` are those of the joint; others as they are.
pub(in crate::response) fn corrected(
    model: &Model,
    values: &Values,
    run: &BackboneRun,
) -> BackboneRun {
    let mut own = run.clone();
    if let Some(corrections) = corrections(model, values, run) {
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
    }
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

/// By how much the logarithm of each frequency and each damping ratio is read too large. `None` where the model has no such decay.
fn corrections(model: &Model, values: &Values, run: &BackboneRun) -> Option<Vec<[f64; 2]>> {
    let sigma_s = run.errors.as_ref()?.sigma_s;
    let read = simulated(values, &run.lines, sigma_s)?.lines(0, 1.0);
    let own: Vec<(f64, [f64; 2])> = read
        .iter()
        .map(|line| {
            let [frequency, ratio] = line.beyond(model, values);
            (line.amplitude_m.ln(), [frequency, ratio])
        })
        .filter(|(_, own)| own.iter().all(|value| value.is_finite()))
        .collect();
    let (first, last) = (own.first()?, own.last()?);
    // amplitudes fall
    let at = |log: f64| {
        let pair = own.windows(2).find(|pair| pair[1].0 <= log);
        match pair {
            _ if log >= first.0 => first.1,
            None => last.1,
            Some(pair) => {
                let share = (log - pair[0].0) / (pair[1].0 - pair[0].0);
                [0, 1].map(|kind| pair[0].1[kind] + share * (pair[1].1[kind] - pair[0].1[kind]))
            }
        }
    };
    Some(
        run.lines
            .iter()
            .map(|line| at(line.amplitude_m.ln()))
            .collect(),
    )
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
    let read = |released_m: f64| {
        let record = decay(values, released_m, least, omega, before_s)?;
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
    before_s: f64,
) -> Option<Record> {
    let h = TAU / omega / STEPS;
    // sin ½ω′h = ½ωh of Verlet's ω′: a mass and a damper that are larger by (ωh)²/12 give back ω
    let slower = 1.0 + (TAU / STEPS).powi(2) / 12.0;
    let mass = 0.5 * values.mass * slower;
    let slider = values.slider.map(|slider| slider.first_loading());
    let (spring, damper) = (
        0.5 * values.support_stiffness + values.spring(),
        values.relative_damping(),
    );
    let loading = |way: f64| slider.as_ref().map_or(0.0, |law| law(way));
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
    for step in 0..MOST * EVERY {
        if step % EVERY == 0 {
            samples.push(u);
        }
        let before = v;
        u += h * v + 0.5 * h * h * a;
        let slips = load(u, turn, at_turn);
        let force = of_spring(u) + slips;
        let damping = slower * (damper + values.terms.damping(u));
        // v′ = v + ½h (a + a′), a′ = −(f + c v′)/M
        v = (v + 0.5 * h * (a - force / mass)) / (1.0 + 0.5 * h * damping / mass);
        a = -(force + damping * v) / mass;
        if before * v < 0.0 {
            (turn, at_turn) = (u, slips);
            largest = u.abs();
        }
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
