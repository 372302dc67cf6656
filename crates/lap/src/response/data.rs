//! Measured responses to stepped sines: force, response and phase at each line, as displacement over force.

use std::f64::consts::{PI, TAU};
use std::path::{Path, PathBuf};

use serde::Deserialize;

use super::table::NumberTable;
use crate::error::LapError;

/// What a run is for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Use {
    /// It goes into the estimate.
    #[default]
    Fit,
    /// It is left out, and its resonance predicted.
    Predict,
}

/// What a phase belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum PhaseOf {
    Displacement,
    Velocity,
    Acceleration,
}

impl PhaseOf {
    const ALL: [Self; 3] = [Self::Displacement, Self::Velocity, Self::Acceleration];

    /// Derivatives of the displacement.
    fn order(self) -> i32 {
        self as i32
    }
}

/// A run of stepped sines.
#[derive(Clone, Debug, PartialEq)]
pub struct SineRun {
    /// Its name.
    pub name: String,
    /// Its file.
    pub path: PathBuf,
    /// What it is for.
    pub used_for: Use,
    /// Its lines, ascending in frequency.
    pub lines: Vec<SineLine>,
}

/// One line of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SineLine {
    /// Frequency, rad/s.
    pub omega: f64,
    /// Amplitude of the force, N.
    pub force_n: f64,
    /// Amplitude of the displacement, m.
    pub displacement_m: f64,
    /// Phase of the displacement against the force, rad, from −π to π.
    pub phase_rad: f64,
}

impl SineRun {
    /// Its frequencies, ascending, Hz.
    pub(super) fn frequencies_hz(&self) -> Vec<f64> {
        self.lines.iter().map(|line| line.omega / TAU).collect()
    }

    /// The largest displacement, m.
    #[must_use]
    pub fn amplitude_m(&self) -> f64 {
        let lines = self.lines.iter().map(|line| line.displacement_m);
        lines.fold(0.0, f64::max)
    }
}

/// How a file of stepped sines is to be read.
pub(super) struct SineOptions {
    pub(super) name: String,
    pub(super) used_for: Use,
    pub(super) phase_of: Option<PhaseOf>,
    /// +1, or −1 where the file counts the lag as positive.
    pub(super) phase_sign: f64,
    /// Frequencies to use, Hz.
    pub(super) range_hz: [f64; 2],
    /// Whether force and response are at the same place, so that the structure can only take energy.
    pub(super) is_drive_point: bool,
}

const FREQUENCY: [&str; 2] = ["frequency_hz", "omega_rad_per_s"];
pub(super) const RESPONSE: [&str; 3] = [
    "displacement_m",
    "velocity_m_per_s",
    "acceleration_m_per_s2",
];
const PHASE: [&str; 2] = ["phase_rad", "phase_deg"];

/// Phases that go on over several turns are not wrapped; beyond so many most of them are degrees.
const TURNS: f64 = 2.0;

/// Phases of a column of degrees that are within π, as rounded, and go over so much, are radian where the receptance rises so many
/// times above both of its sides.
const LARGEST_RAD: f64 = 3.2;
const TURNED_RAD: f64 = 1.0;
const PEAK: f64 = 1.5;

/// Reads a run; rows that stand in the table again count once, and the second value is how many those are.
pub(super) fn read_sine(path: &Path, options: SineOptions) -> Result<(SineRun, usize), LapError> {
    let mut table = NumberTable::read(path)?;
    let repeated = table.without_repeats();
    let frequency = table.required(&FREQUENCY, "")?;
    let force = table.required(&["force_n"], "")?;
    let response = table.required(&RESPONSE, "")?;
    let phase = table.required(
        &PHASE,
        ": a level without phase does not tell damping from stiffness",
    )?;
    let phases = table.rows().iter();
    let phases = phases.filter_map(|(_, values)| values[phase.0]);
    let phases: Vec<f64> = phases.collect();
    if phase.1 == 0 {
        refuse_degrees(path, &phases)?;
    }
    let own = PhaseOf::ALL[response.1];
    let phase_of = options.phase_of.unwrap_or(own);
    let mut lines = Vec::new();
    for (number, values) in table.rows() {
        let value = |(place, _): (usize, usize), name: &str, expected: &str| {
            values[place].ok_or_else(|| table.problem(*number, format!("no {name}"), expected))
        };
        let frequency_value = value(frequency, "frequency", "a number")?;
        let hz = match frequency.1 {
            0 => frequency_value,
            _ => frequency_value / TAU,
        };
        let force_n = value(force, "force", "a number")?;
        let amplitude = value(response, "response", "a number")?;
        let phase_value = value(
            phase,
            "phase",
            "a number: a level without phase does not tell damping from stiffness",
        )?;
        for (what, found) in [
            ("frequency", hz),
            ("force", force_n),
            ("response", amplitude),
        ] {
            if found <= 0.0 {
                return Err(table.problem(
                    *number,
                    format!("a {what} of {found}"),
                    "a value above zero",
                ));
            }
        }
        if !(options.range_hz[0]..=options.range_hz[1]).contains(&hz) {
            continue;
        }
        let omega = TAU * hz;
        let radian = match phase.1 {
            0 => phase_value,
            _ => phase_value.to_radians(),
        };
        // v = jω x, a = (jω)² x
        let displacement_phase =
            options.phase_sign * radian - 0.5 * PI * f64::from(phase_of.order());
        lines.push(SineLine {
            omega,
            force_n,
            displacement_m: amplitude / omega.powi(own.order()),
            phase_rad: wrapped(displacement_phase),
        });
    }
    if lines.len() < 2 {
        return Err(table.problem(
            1,
            format!("{} line(s) in the frequency range", lines.len()),
            "at least two",
        ));
    }
    lines.sort_by(|a, b| a.omega.total_cmp(&b.omega));
    if phase.1 == 1 {
        refuse_radians(path, &phases, &lines)?;
    }
    let leading = lines
        .iter()
        .filter(|line| line.phase_rad.sin() > 0.0)
        .count();
    if options.is_drive_point && 2 * leading > lines.len() {
        return Err(LapError::Leading {
            path: path.to_owned(),
            leading,
            lines: lines.len(),
        });
    }
    let run = SineRun {
        name: options.name,
        path: path.to_owned(),
        used_for: options.used_for,
        lines,
    };
    Ok((run, repeated))
}

/// Refuses phases in radian of which most are beyond a turn, and the largest beyond several.
fn refuse_degrees(path: &Path, phases: &[f64]) -> Result<(), LapError> {
    let beyond = phases.iter().filter(|phase| phase.abs() > TAU).count();
    let largest = phases.iter().copied().fold(0.0, |largest: f64, phase| {
        if phase.abs() > largest.abs() {
            phase
        } else {
            largest
        }
    });
    if 2 * beyond > phases.len() && largest.abs() > TURNS * TAU {
        return Err(LapError::Degrees {
            path: path.to_owned(),
            beyond,
            lines: phases.len(),
            largest,
        });
    }
    Ok(())
}

/// Refuses phases in degrees that stay within ±π and go over more than one, while the receptance passes a resonance: there a
/// phase turns by most of half a turn.
fn refuse_radians(path: &Path, phases: &[f64], lines: &[SineLine]) -> Result<(), LapError> {
    let [low, high] = ends(phases);
    let sizes: Vec<f64> = lines
        .iter()
        .map(|line| line.displacement_m / line.force_n)
        .collect();
    let side = |values: &[f64]| values.iter().copied().fold(f64::INFINITY, f64::min);
    let highest = (0..sizes.len()).max_by(|&one, &other| sizes[one].total_cmp(&sizes[other]));
    let passes = highest.is_some_and(|place| {
        let least = PEAK * side(&sizes[..=place]).max(side(&sizes[place..]));
        sizes[place] > least
    });
    if passes && low.abs().max(high.abs()) < LARGEST_RAD && high - low > TURNED_RAD {
        return Err(LapError::Radians {
            path: path.to_owned(),
            least: low,
            largest: high,
        });
    }
    Ok(())
}

/// The least and the largest of values.
fn ends(values: &[f64]) -> [f64; 2] {
    let first = [f64::INFINITY, f64::NEG_INFINITY];
    let wider = |[low, high]: [f64; 2], value: &f64| [low.min(*value), high.max(*value)];
    values.iter().fold(first, wider)
}

/// An angle between −π and π.
pub(super) fn wrapped(angle: f64) -> f64 {
    angle - TAU * (angle / TAU).round()
}
