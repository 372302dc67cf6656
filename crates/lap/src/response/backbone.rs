//! Backbone and damping curves, measured or taken from a free decay: frequency, damping ratio and force of phase resonance over
//! the amplitude.

use std::f64::consts::TAU;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use bolted_joint_dynamics::law::Term;

use super::data::{RESPONSE, Use};
use super::decay::{Decay, DecayProblem, Following, ReadingErrors, Recorded, Rows, backbone_of};
use super::dynamic_stiffness::RelativeMotion;
use super::fit::Data;
use super::model::{Model, ResponseUnknown, Values};
use super::study::Noise;
use super::table::NumberTable;
use crate::error::LapError;

/// Damping ratio from which on nothing vibrates.
const CRITICAL: f64 = 1.0;

/// What a record of several modes should be instead.
const ONE_MODE: &str =
    "one mode alone; name the band that holds it and no other, such as band = [60, 100] in Hz";

/// A backbone with its damping curve.
#[derive(Clone, Debug, PartialEq)]
pub struct BackboneRun {
    /// Its name.
    pub name: String,
    /// Its file.
    pub path: PathBuf,
    /// What it is for.
    pub used_for: Use,
    /// Its points.
    pub lines: Vec<BackboneLine>,
    /// Errors of the points where they were read from a free decay.
    pub(super) errors: Option<ReadingErrors>,
    /// How the reading of the model's own decay follows its unknowns, where that is known.
    pub(super) following: Option<Following>,
    /// The record of a free decay.
    pub(super) recorded: Option<Arc<Recorded>>,
    /// What the samples of that record say of the unknowns, where they are fitted in place of the points.
    pub(super) rows: Option<Rows>,
}

/// A residual with its derivatives by the model's unknowns.
pub(super) type Row = (f64, Vec<f64>);

impl BackboneRun {
    /// Numbers that it brings beyond what is its own.
    pub(super) fn count(&self) -> usize {
        let of_points = || self.lines.iter().map(BackboneLine::count).sum();
        self.rows.as_ref().map_or_else(of_points, Rows::count)
    }

    /// The largest displacement of the relative motion in it, m.
    pub(super) fn largest_m(&self) -> f64 {
        let of_points = self.lines.iter().map(|line| line.amplitude_m);
        let released = self.rows.as_ref().map(Rows::released_m);
        of_points.chain(released).fold(0.0, f64::max)
    }

    /// Residuals in standard deviations with their derivatives by the model's unknowns.
    pub(super) fn residuals(&self, model: &Model, values: &Values, noise: &Noise) -> Vec<Row> {
        if let Some(rows) = &self.rows {
            return rows.at(model, values);
        }
        let motion = RelativeMotion::fundamental(values);
        let lines = self.lines.iter();
        let deviations = lines.map(|line| line.deviations(model, values, &motion));
        match (&self.errors, &self.following) {
            (None, _) => deviations.flat_map(|own| own.in_parts_of(noise)).collect(),
            (Some(errors), None) => {
                let (mut all, ratios): (Vec<Row>, Vec<Row>) = deviations
                    .map(|own| (own.frequency, own.ratio.unwrap_or_default().plain))
                    .unzip();
                all.extend(ratios);
                errors.whitened(&all)
            }
            (Some(errors), Some(following)) => {
                let both = [0, 1].map(|kind| following.rows(model, values, kind));
                errors.whitened(&both.concat())
            }
        }
    }
}

/// One point of a backbone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BackboneLine {
    /// Amplitude of the relative displacement, m.
    pub amplitude_m: f64,
    /// Frequency, rad/s.
    pub omega: f64,
    /// Damping ratio, where it was measured. Read from a decay it may be negative by noise.
    pub damping_ratio: Option<f64>,
    /// Force that holds the amplitude, N, where it was measured.
    pub force_n: Option<f64>,
    /// When a decay had it, s.
    pub time_s: Option<f64>,
}

impl BackboneLine {
    /// Numbers that it brings.
    pub(super) fn count(&self) -> usize {
        1 + usize::from(self.damping_ratio.is_some()) + usize::from(self.force_n.is_some())
    }

    /// By how much the logarithm of the frequency and the damping ratio are above the model's.
    pub(super) fn beyond(&self, model: &Model, values: &Values) -> [f64; 2] {
        let own = self.deviations(model, values, &RelativeMotion::fundamental(values));
        [
            own.frequency.0,
            own.ratio.map_or(0.0, |ratio| ratio.plain.0),
        ]
    }

    /// What was measured less what the model has.
    fn deviations(
        &self,
        model: &Model,
        values: &Values,
        motion: &RelativeMotion<'_>,
    ) -> Deviations {
        let z = motion.stiffness(self.amplitude_m, self.omega);
        // K = k/2 + k₁₂ + …, M = m/2, C = c/2 + c₁₂ + …
        let mass = 0.5 * values.mass;
        let stiffness = z.value.re + mass * self.omega * self.omega;
        let damping = z.value.im / self.omega;
        let parts = |unknown: &ResponseUnknown| match *unknown {
            ResponseUnknown::Mass => [0.0, 0.5, 0.0],
            ResponseUnknown::SupportStiffness => [0.5, 0.0, 0.0],
            ResponseUnknown::JointStiffness => [1.0, 0.0, 0.0],
            ResponseUnknown::SupportDamping => [0.0, 0.0, 0.5],
            ResponseUnknown::JointDamping => [0.0, 0.0, 1.0],
            ResponseUnknown::Term(term) => {
                let by = z.by_term[term.index()];
                [by.re, 0.0, by.im / self.omega]
            }
            ResponseUnknown::Slider(parameter) => {
                let by = z.by_slider(parameter);
                [by.re, 0.0, by.im / self.omega]
            }
            ResponseUnknown::OtherModesReal | ResponseUnknown::OtherModesImaginary => [0.0; 3],
        };
        let row = |by: [f64; 3]| {
            let rows = model.unknowns.iter().map(|unknown| {
                let [k, m, c] = parts(unknown);
                -(by[0] * k + by[1] * m + by[2] * c)
            });
            rows.collect::<Vec<f64>>()
        };
        // ω² = K/M
        let found = 0.5 * (stiffness / mass).ln();
        let frequency = (
            self.omega.ln() - found,
            row([0.5 / stiffness, -0.5 / mass, 0.0]),
        );
        // ζ = C/(2 M ω)
        let ratio = self.damping_ratio.map(|ratio| {
            let found = damping / (2.0 * mass * self.omega);
            let by_mass = -found / mass;
            OfRatio {
                logarithm: (
                    (ratio / found).ln(),
                    row([0.0, -mass.recip(), damping.recip()]),
                ),
                plain: (
                    ratio - found,
                    row([0.0, by_mass, (2.0 * mass * self.omega).recip()]),
                ),
            }
        });
        // F = C ω R/|d|
        let force = self.force_n.map(|force| {
            let load = model.relative_load().abs();
            let found = (damping * self.omega * self.amplitude_m / load).ln();
            (force.ln() - found, row([0.0, 0.0, damping.recip()]))
        });
        Deviations {
            frequency,
            ratio,
            force,
        }
    }
}

/// What one point has beyond the model: logarithms of frequency and force, and the damping ratio.
struct Deviations {
    frequency: Row,
    ratio: Option<OfRatio>,
    force: Option<Row>,
}

/// A damping ratio's deviation: of its logarithm, and as it is.
#[derive(Default)]
struct OfRatio {
    logarithm: Row,
    plain: Row,
}

impl Deviations {
    /// In standard deviations that are parts of what was measured.
    fn in_parts_of(self, noise: &Noise) -> Vec<Row> {
        let weighted = |(deviation, by): Row, noise: f64| {
            let by = by.into_iter().map(|entry| entry / noise).collect();
            (deviation / noise, by)
        };
        let damping = self.ratio.map(|ratio| ratio.logarithm);
        let of_damping = damping.into_iter().chain(self.force);
        let of_damping = of_damping.map(|row| weighted(row, noise.damping));
        let frequency = weighted(self.frequency, noise.frequency);
        std::iter::once(frequency).chain(of_damping).collect()
    }
}

/// A start: a linear oscillator of the lowest point. Where nothing fixes the mass it is 1 kg, and named as not identified.
pub(super) fn start(model: &Model, data: Data<'_>, known: &Values) -> Option<Values> {
    // what a decay tells at its end is the least certain of all
    let is_told = |line: &&BackboneLine| line.damping_ratio.is_none_or(|ratio| ratio > 0.0);
    let lowest = data
        .points()
        .filter(is_told)
        .min_by(|a, b| a.amplitude_m.total_cmp(&b.amplitude_m))?;
    let damping_of_force = lowest
        .force_n
        .map(|force| force * model.relative_load().abs() / (lowest.omega * lowest.amplitude_m));
    let mass = match (
        model.unknowns.contains(&ResponseUnknown::Mass),
        damping_of_force,
        lowest.damping_ratio,
    ) {
        (false, _, _) => known.mass,
        (true, Some(damping), Some(ratio)) => damping / (ratio * lowest.omega),
        (true, _, _) => 1.0,
    };
    let damping = damping_of_force
        .or(lowest
            .damping_ratio
            .map(|ratio| ratio * mass * lowest.omega))
        .unwrap_or(1e-3 * mass * lowest.omega);
    let mut start = *known;
    start.mass = mass;
    if model.unknowns.contains(&ResponseUnknown::JointStiffness) {
        start.joint_stiffness =
            0.5 * (mass * lowest.omega * lowest.omega - known.support_stiffness);
    }
    if model.unknowns.contains(&ResponseUnknown::JointDamping) {
        start.joint_damping = damping - 0.5 * known.support_damping;
    }
    debug_assert!(Term::ALL.iter().all(|term| start.term(*term) == 0.0));
    Some(start)
}

/// Reads a backbone; `share` is that of the relative motion in what was measured. Rows that stand in the table again count once,
/// and the second value is how many those are.
pub(super) fn read_backbone(
    path: &Path,
    share: f64,
) -> Result<(Vec<BackboneLine>, usize), LapError> {
    let mut table = NumberTable::read(path)?;
    let repeated = table.without_repeats();
    let (frequency, by) = table.required(&["frequency_hz", "omega_rad_per_s"], "")?;
    let (response, order) = table.required(&RESPONSE, "")?;
    let ratio = table.column(&["damping_ratio"]);
    let force = table.column(&["force_n"]);
    let mut lines = Vec::new();
    for (number, values) in table.rows() {
        let positive = |place: usize, what: &str| match values[place] {
            Some(value) if value > 0.0 => Ok(value),
            other => {
                let other = other.map_or("nothing".to_owned(), |value| value.to_string());
                let found = format!("a {what} of {other}");
                Err(table.problem(*number, found, "a value above zero"))
            }
        };
        let frequency = positive(frequency, "frequency")?;
        let omega = if by == 0 { TAU * frequency } else { frequency };
        let response = positive(response, "response")?;
        let below_critical = |place: usize| match positive(place, "damping ratio")? {
            found if found < CRITICAL => Ok(found),
            found => Err(table.problem(
                *number,
                format!("a damping ratio of {found}"),
                "a part of the critical damping, below 1: 2 % is 0.02",
            )),
        };
        lines.push(BackboneLine {
            amplitude_m: response / omega.powi(order as i32) / share.abs(),
            omega,
            damping_ratio: ratio.map(|(place, _)| below_critical(place)).transpose()?,
            force_n: force
                .map(|(place, _)| positive(place, "force"))
                .transpose()?,
            time_s: None,
        });
    }
    if lines.is_empty() {
        return Err(table.problem(1, "no rows".to_owned(), "at least one"));
    }
    Ok((lines, repeated))
}

/// Reads a free decay and turns one mode of it into a backbone, that in the band where one is given.
pub(super) fn read_decay(
    path: &Path,
    band_hz: Option<[f64; 2]>,
    share: f64,
    noise: &Noise,
) -> Result<Decay, LapError> {
    let table = NumberTable::read(path)?;
    let (time, _) = table.required(&["time_s"], "")?;
    let (response, order) = table.required(&RESPONSE, "")?;
    let rows = table.rows().iter();
    let samples: Vec<(f64, f64)> = rows
        .filter_map(|(_, values)| Some((values[time]?, values[response]?)))
        .collect();
    // what is stated of curves is what a decay has beside the noise of its record
    let stated = [noise.frequency, noise.damping].map(|part| match noise.is_of_curves {
        true => part,
        false => 0.0,
    });
    let found = backbone_of(&samples, band_hz, order as i32, share, stated);
    found.map_err(|problem| {
        let (found, expected) = match problem {
            DecayProblem::Uneven => (
                "times that do not ascend evenly".to_owned(),
                "samples at equal distances".to_owned(),
            ),
            DecayProblem::Clipped {
                limit,
                samples,
                last_s,
            } => (
                format!(
                    "a clipped record: {samples} samples stand at exactly {limit:e}, several in a row at one peak after the other, the last \
                     at {last_s:.4} s"
                ),
                "a record within the instrument's range: measure with less gain, or begin the table behind the last clipped peak"
                    .to_owned(),
            ),
            DecayProblem::NoMode => (
                "no vibration that stands out of the noise".to_owned(),
                "a free decay of one mode; `band` in Hz may be beside it".to_owned(),
            ),
            DecayProblem::Several(hz) => {
                let hz: Vec<String> = hz.iter().map(|hz| format!("{hz:.1} Hz")).collect();
                (
                    format!("modes at {}", hz.join(", ")),
                    ONE_MODE.to_owned(),
                )
            }
            DecayProblem::Rises {
                at_s,
                times,
                apart_hz,
                mode_hz,
            } => (
                format!(
                    "an amplitude that rises {times:.2} times after {at_s:.3} s, as two modes make it that are {apart_hz:.1} Hz apart, \
                     another impact, or a frequency that moves out of the band"
                ),
                format!(
                    "the free decay of one mode, behind the last impact; name the band that holds it and no other, such as \
                     band = [60, 100] in Hz; where the frequency itself moves far with the amplitude, a wide one, such as {}",
                    wide(mode_hz)
                ),
            ),
            DecayProblem::Leaves {
                mode_hz,
                other_hz,
                part,
            } => (
                format!(
                    "a mode at {mode_hz:.1} Hz, and beside it {:.0} % of its size, most at {other_hz:.1} Hz",
                    100.0 * part
                ),
                format!(
                    "{ONE_MODE}; where the frequency itself moves that far with the amplitude, a wide one, such as {}",
                    wide(mode_hz)
                ),
            ),
            DecayProblem::TooShort(count) => (
                format!("{count} stretch(es) of ten half-periods in the decay"),
                "at least two: a longer record, with less noise, or a wider band".to_owned(),
            ),
        };
        table.problem(1, found, &expected)
    })
}

/// A band about a mode whose frequency moves: half of it to either side, as where no band is named.
fn wide(mode_hz: f64) -> String {
    format!("band = [{:.0}, {:.0}]", 0.5 * mode_hz, 1.5 * mode_hz)
}
