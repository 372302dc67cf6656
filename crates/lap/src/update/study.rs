//! A study of method `lap-update`, checked before anything is computed.

use std::f64::consts::TAU;
use std::path::{Path, PathBuf};

use serde::Deserialize;

use super::super::input::{check_name, refuse};
use super::super::parameter::LapParameter;
use super::firefly::Firefly;
use super::problem::{Range, UpdateProblem};
use crate::error::LapError;
use bolted_joint_files::text_file;
use bolted_joint_identify::{IdentifyError, StudyMethod};

/// More fireflies or generations than any search needs.
const MOST: usize = 100_000;

/// A validated study of method `lap-update`.
#[derive(Clone, Debug)]
pub struct LapUpdateStudy {
    /// The study's own file.
    pub path: PathBuf,
    /// Name of the joint.
    pub name: String,
    /// What was measured, by torque, ascending.
    pub torques: Vec<TorqueData>,
    /// What is known of each parameter, in the order of [`LapParameter::ALL`].
    pub ranges: [Range; 6],
    /// How the fireflies search.
    pub firefly: Firefly,
    /// Remarks that go into the joint files.
    pub notes: Vec<String>,
}

/// Natural frequencies at one torque.
#[derive(Clone, Debug, PartialEq)]
pub struct TorqueData {
    /// Tightening torque, N·m; `None` for a single assembly whose torque is not known.
    pub torque_n_m: Option<f64>,
    /// Natural frequencies, rad/s, ascending.
    pub omega_rad_per_s: Vec<f64>,
    /// Weight of each.
    pub weights: Vec<f64>,
    /// Relative standard deviation of each frequency, where it is stated.
    pub relative_deviation: Option<f64>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct StudyFile {
    method: StudyMethod,
    name: String,
    #[serde(default)]
    notes: Vec<String>,
    assembly: Vec<AssemblyTable>,
    #[serde(default)]
    bounds: BoundsTable,
    #[serde(default)]
    known: ValuesTable,
    #[serde(default)]
    prior: ValuesTable,
    #[serde(default)]
    firefly: FireflyTable,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct AssemblyTable {
    torque: Option<f64>,
    frequency_hz: Option<Vec<f64>>,
    omega_rad_per_s: Option<Vec<f64>>,
    weights: Option<Vec<f64>>,
    relative_deviation: Option<f64>,
}

#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
struct BoundsTable {
    k: Option<[f64; 2]>,
    m: Option<[f64; 2]>,
    k12: Option<[f64; 2]>,
    c: Option<[f64; 2]>,
    c12: Option<[f64; 2]>,
    #[serde(rename = "kN")]
    cubic: Option<[f64; 2]>,
}

#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields)]
struct ValuesTable {
    k: Option<f64>,
    m: Option<f64>,
    k12: Option<f64>,
    c: Option<f64>,
    c12: Option<f64>,
    #[serde(rename = "kN")]
    cubic: Option<f64>,
}

#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields)]
struct FireflyTable {
    population: Option<usize>,
    iterations: Option<usize>,
    attractiveness: Option<f64>,
    absorption: Option<f64>,
    step: Option<f64>,
    decay: Option<f64>,
    seed: Option<u64>,
}

impl BoundsTable {
    fn of(&self, parameter: LapParameter) -> Option<[f64; 2]> {
        match parameter {
            LapParameter::SupportStiffness => self.k,
            LapParameter::Mass => self.m,
            LapParameter::JointStiffness => self.k12,
            LapParameter::SupportDamping => self.c,
            LapParameter::JointDamping => self.c12,
            LapParameter::JointCubic => self.cubic,
        }
    }
}

impl ValuesTable {
    fn of(&self, parameter: LapParameter) -> Option<f64> {
        match parameter {
            LapParameter::SupportStiffness => self.k,
            LapParameter::Mass => self.m,
            LapParameter::JointStiffness => self.k12,
            LapParameter::SupportDamping => self.c,
            LapParameter::JointDamping => self.c12,
            LapParameter::JointCubic => self.cubic,
        }
    }
}

impl LapUpdateStudy {
    /// Reads and checks a study.
    ///
    /// # Errors
    /// [`LapError`] that names the file and the key or line.
    pub fn read(path: &Path) -> Result<Self, LapError> {
        let text = text_file::read(path, "a study (TOML)")?;
        Self::from_toml(&text, path)
    }

    /// A study from the text of its file; `path` tells where that lies.
    ///
    /// # Errors
    /// [`LapError`] that names the file and the key or line.
    pub fn from_toml(text: &str, path: &Path) -> Result<Self, LapError> {
        let file: StudyFile = toml::from_str(text).map_err(|error| IdentifyError::Syntax {
            path: path.to_owned(),
            message: error.to_string().trim_end().to_owned(),
        })?;
        if file.method != StudyMethod::LapUpdate {
            return refuse(path, "method", "another method", "\"lap-update\"");
        }
        check_name(path, &file.name)?;
        let mut ranges = [Range::Absent; 6];
        for parameter in LapParameter::ALL {
            ranges[parameter.index()] = range(path, &file, parameter)?;
        }
        Ok(Self {
            path: path.to_owned(),
            torques: torques(path, &file.assembly)?,
            name: file.name,
            ranges,
            firefly: firefly(path, &file.firefly)?,
            notes: file.notes,
        })
    }

    /// The problem at one torque.
    #[must_use]
    pub fn problem(&self, data: &TorqueData) -> UpdateProblem {
        UpdateProblem {
            omega_rad_per_s: data.omega_rad_per_s.clone(),
            weights: data.weights.clone(),
            ranges: self.ranges,
        }
    }
}

/// What the study says of a parameter.
fn range(path: &Path, file: &StudyFile, parameter: LapParameter) -> Result<Range, LapError> {
    let (bounds, known, prior) = (
        file.bounds.of(parameter),
        file.known.of(parameter),
        file.prior.of(parameter),
    );
    let unit = parameter.unit();
    if let Some(value) = known {
        if bounds.is_some() || prior.is_some() {
            return refuse(
                path,
                format!("known.{parameter}"),
                format!("{value} beside a bound or prior of the same parameter"),
                "what is known in [known] alone",
            );
        }
        let fits = value.is_finite()
            && match parameter {
                LapParameter::JointCubic => true,
                LapParameter::Mass => value > 0.0,
                _ => value >= 0.0,
            };
        if !fits {
            return refuse(
                path,
                format!("known.{parameter}"),
                value.to_string(),
                format!("a value in {unit} that is not negative, a mass above zero"),
            );
        }
        return Ok(Range::Known(value));
    }
    let Some([low, high]) = bounds else {
        if let Some(value) = prior {
            return refuse(
                path,
                format!("prior.{parameter}"),
                format!("{value} without bounds"),
                format!("bounds.{parameter} = [low, high] beside it, or the value in [known]"),
            );
        }
        return match parameter.moves_frequencies() {
            true => refuse(
                path,
                format!("bounds.{parameter}"),
                "nothing",
                format!("[low, high] in {unit}, or a value in known.{parameter}"),
            ),
            false => Ok(Range::Absent),
        };
    };
    if !(low > 0.0 && low < high && high.is_finite()) {
        let hint = if low > high && high > 0.0 {
            format!("; they are upside down: write [{high}, {low}]")
        } else {
            String::new()
        };
        return refuse(
            path,
            format!("bounds.{parameter}"),
            format!("[{low}, {high}]"),
            format!("[low, high] in {unit} with 0 < low < high{hint}"),
        );
    }
    if let Some(value) = prior.filter(|value| !(low..=high).contains(value)) {
        return refuse(
            path,
            format!("prior.{parameter}"),
            value.to_string(),
            format!("a value within bounds.{parameter}, from {low} to {high} {unit}"),
        );
    }
    Ok(Range::Between { low, high, prior })
}

fn torques(path: &Path, tables: &[AssemblyTable]) -> Result<Vec<TorqueData>, LapError> {
    if tables.is_empty() {
        return refuse(path, "assembly", "none", "at least one [[assembly]]");
    }
    let mut torques = Vec::new();
    for (place, table) in tables.iter().enumerate() {
        let key = |name: &str| format!("assembly[{}].{name}", place + 1);
        match table.torque {
            None if tables.len() > 1 => {
                return refuse(
                    path,
                    key("torque"),
                    "nothing",
                    "the torque of each assembly, N·m",
                );
            }
            Some(torque) if !(torque >= 0.0 && torque.is_finite()) => {
                return refuse(path, key("torque"), torque.to_string(), "N·m, not negative");
            }
            _ => {}
        }
        let (name, omega) = match (&table.frequency_hz, &table.omega_rad_per_s) {
            (Some(hz), None) => ("frequency_hz", hz.iter().map(|hz| TAU * hz).collect()),
            (None, Some(omega)) => ("omega_rad_per_s", omega.clone()),
            (None, None) => {
                return refuse(
                    path,
                    key("frequency_hz"),
                    "nothing",
                    "natural frequencies as frequency_hz = [f1, f2] or omega_rad_per_s = [ω1, ω2]",
                );
            }
            (Some(_), Some(_)) => {
                return refuse(
                    path,
                    key("frequency_hz"),
                    "omega_rad_per_s beside it",
                    "one of them",
                );
            }
        };
        let given = match name {
            "frequency_hz" => table.frequency_hz.as_ref(),
            _ => table.omega_rad_per_s.as_ref(),
        };
        check_frequencies(path, &key(name), given.map_or(&[], Vec::as_slice))?;
        let omega: Vec<f64> = omega;
        let weights = table
            .weights
            .clone()
            .unwrap_or_else(|| vec![1.0; omega.len()]);
        let usable = |weight: &f64| *weight > 0.0 && weight.is_finite();
        if weights.len() != omega.len() || !weights.iter().all(usable) {
            return refuse(
                path,
                key("weights"),
                format!("{weights:?}"),
                format!(
                    "{} number(s) above zero, one for each frequency",
                    omega.len()
                ),
            );
        }
        let deviation = table.relative_deviation;
        if let Some(value) = deviation.filter(|value| !(*value > 0.0 && *value < 1.0)) {
            return refuse(
                path,
                key("relative_deviation"),
                value.to_string(),
                "a fraction of the frequency above zero and below one",
            );
        }
        torques.push(TorqueData {
            torque_n_m: table.torque,
            omega_rad_per_s: omega,
            weights,
            relative_deviation: deviation,
        });
    }
    let torque = |data: &TorqueData| data.torque_n_m.unwrap_or(0.0);
    torques.sort_by(|a, b| torque(a).total_cmp(&torque(b)));
    if let Some(pair) = torques
        .windows(2)
        .find(|pair| torque(&pair[0]) == torque(&pair[1]))
    {
        return refuse(
            path,
            "assembly.torque",
            format!("{} N·m twice", torque(&pair[0])),
            "every torque once",
        );
    }
    Ok(torques)
}

/// One or two frequencies above zero, ascending.
fn check_frequencies(path: &Path, key: &str, given: &[f64]) -> Result<(), LapError> {
    let found = format!("{given:?}");
    if given.len() > 2 {
        return refuse(
            path,
            key,
            format!("{} frequencies, {found}", given.len()),
            "at most two: the lap model has two degrees of freedom, so a third frequency cannot be compared with anything",
        );
    }
    if given.is_empty()
        || given
            .iter()
            .any(|value| !(*value > 0.0 && value.is_finite()))
    {
        return refuse(path, key, found, "one or two frequencies above zero");
    }
    if let [first, second] = given
        && first >= second
    {
        return refuse(
            path,
            key,
            found,
            format!(
                "ascending frequencies, the mode in phase first: the joint's stiffness only raises the other one; write [{second}, {first}] if they are swapped"
            ),
        );
    }
    Ok(())
}

fn firefly(path: &Path, table: &FireflyTable) -> Result<Firefly, LapError> {
    let otherwise = Firefly::default();
    let count = |key: &str, value: Option<usize>, least: usize, otherwise: usize| match value {
        Some(value) if !(least..=MOST).contains(&value) => refuse(
            path,
            format!("firefly.{key}"),
            value.to_string(),
            format!("a number from {least} to {MOST}"),
        ),
        Some(value) => Ok(value),
        None => Ok(otherwise),
    };
    let size = |key: &str, value: Option<f64>, most: f64, otherwise: f64| match value {
        Some(value) if !(value >= 0.0 && value <= most) => refuse(
            path,
            format!("firefly.{key}"),
            value.to_string(),
            format!("a number from 0 to {most}"),
        ),
        Some(value) => Ok(value),
        None => Ok(otherwise),
    };
    Ok(Firefly {
        population: count("population", table.population, 2, otherwise.population)?,
        iterations: count("iterations", table.iterations, 1, otherwise.iterations)?,
        attractiveness: size(
            "attractiveness",
            table.attractiveness,
            10.0,
            otherwise.attractiveness,
        )?,
        absorption: size("absorption", table.absorption, 1e6, otherwise.absorption)?,
        step: size("step", table.step, 1.0, otherwise.step)?,
        decay: size("decay", table.decay, 1.0, otherwise.decay)?,
        seed: table.seed.unwrap_or(otherwise.seed),
    })
}
