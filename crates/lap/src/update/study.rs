//! A study of method `lap-update`, checked before anything is computed.

use std::f64::consts::TAU;
use std::path::{Path, PathBuf};

use serde::Deserialize;

use super::super::parameter::LapParameter;
use super::firefly::Firefly;
use super::problem::{Range, UpdateProblem};
use bolted_joint_study::{Method, StudyError, StudyText, schema};

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
    method: Method,
    name: String,
    #[serde(default)]
    notes: Vec<String>,
    assembly: Vec<AssemblyTable>,
    #[serde(default)]
    bounds: ParameterTable<[f64; 2]>,
    #[serde(default)]
    known: ParameterTable<f64>,
    #[serde(default)]
    prior: ParameterTable<f64>,
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

/// Something of each parameter.
#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields)]
struct ParameterTable<T> {
    k: Option<T>,
    m: Option<T>,
    k12: Option<T>,
    c: Option<T>,
    c12: Option<T>,
    #[serde(rename = "kN")]
    cubic: Option<T>,
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

impl<T: Copy> ParameterTable<T> {
    fn of(&self, parameter: LapParameter) -> Option<T> {
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
    /// The JSON Schema of its file.
    #[must_use]
    pub fn schema() -> schema::Schema {
        schema::of::<StudyFile>()
    }

    /// Reads and checks a study.
    ///
    /// # Errors
    /// [`StudyError`] that names the file and the key or line.
    pub fn read(path: &Path) -> Result<Self, StudyError> {
        Self::of(&StudyText::read(path)?)
    }

    /// A study from its text.
    ///
    /// # Errors
    /// [`StudyError`] that names the file and the key or line.
    pub fn of(study: &StudyText) -> Result<Self, StudyError> {
        let file: StudyFile = study.tables()?;
        study.check_method(file.method, &[Method::LapUpdate])?;
        study.check_name("name", &file.name)?;
        let mut ranges = [Range::Absent; 6];
        for parameter in LapParameter::ALL {
            ranges[parameter.index()] = range(study, &file, parameter)?;
        }
        Ok(Self {
            path: study.path().to_owned(),
            torques: torques(study, &file.assembly)?,
            name: file.name,
            ranges,
            firefly: firefly(study, &file.firefly)?,
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
fn range(
    study: &StudyText,
    file: &StudyFile,
    parameter: LapParameter,
) -> Result<Range, StudyError> {
    let (bounds, known, prior) = (
        file.bounds.of(parameter),
        file.known.of(parameter),
        file.prior.of(parameter),
    );
    let unit = parameter.unit();
    if let Some(value) = known {
        let key = format!("known.{parameter}");
        study.ensure(
            bounds.is_none() && prior.is_none(),
            &key,
            format_args!("{value} beside a bound or prior of the same parameter"),
            "what is known in [known] alone",
        )?;
        let fits = match parameter {
            LapParameter::JointCubic => true,
            LapParameter::Mass => value > 0.0,
            _ => value >= 0.0,
        };
        let expected = format!("a value in {unit} that is not negative, a mass above zero");
        study.ensure(value.is_finite() && fits, key, value, expected)?;
        return Ok(Range::Known(value));
    }
    let Some([low, high]) = bounds else {
        if let Some(value) = prior {
            return study.refuse(
                format_args!("prior.{parameter}"),
                format_args!("{value} without bounds"),
                format_args!("bounds.{parameter} = [low, high] beside it, or the value in [known]"),
            );
        }
        return match parameter.moves_frequencies() {
            true => study.refuse(
                format_args!("bounds.{parameter}"),
                "nothing",
                format_args!("[low, high] in {unit}, or a value in known.{parameter}"),
            ),
            false => Ok(Range::Absent),
        };
    };
    let hint = match low > high && high > 0.0 {
        true => format!("; they are upside down: write [{high}, {low}]"),
        false => String::new(),
    };
    study.ensure(
        low > 0.0 && low < high && high.is_finite(),
        format_args!("bounds.{parameter}"),
        format_args!("[{low}, {high}]"),
        format_args!("[low, high] in {unit} with 0 < low < high{hint}"),
    )?;
    if let Some(value) = prior {
        let expected = format!("a value within bounds.{parameter}, from {low} to {high} {unit}");
        study.within(
            format_args!("prior.{parameter}"),
            value,
            low..=high,
            expected,
        )?;
    }
    Ok(Range::Between { low, high, prior })
}

fn torques(study: &StudyText, tables: &[AssemblyTable]) -> Result<Vec<TorqueData>, StudyError> {
    study.ensure(
        !tables.is_empty(),
        "assembly",
        "none",
        "at least one [[assembly]]",
    )?;
    let mut torques = Vec::new();
    for (place, table) in tables.iter().enumerate() {
        let key = |name: &str| format!("assembly[{}].{name}", place + 1);
        match table.torque {
            Some(torque) => drop(study.not_negative(key("torque"), torque, "N·m, not negative")?),
            None => study.ensure(
                tables.len() == 1,
                key("torque"),
                "nothing",
                "the torque of each assembly, N·m",
            )?,
        }
        let (name, given, to_omega) = match (&table.frequency_hz, &table.omega_rad_per_s) {
            (Some(hz), None) => ("frequency_hz", hz, TAU),
            (None, Some(omega)) => ("omega_rad_per_s", omega, 1.0),
            (None, None) => {
                return study.refuse(
                    key("frequency_hz"),
                    "nothing",
                    "natural frequencies as frequency_hz = [f1, f2] or omega_rad_per_s = [ω1, ω2]",
                );
            }
            (Some(_), Some(_)) => {
                let found = "omega_rad_per_s beside it";
                return study.refuse(key("frequency_hz"), found, "one of them");
            }
        };
        check_frequencies(study, &key(name), given)?;
        let weights = table.weights.clone();
        let weights = weights.unwrap_or_else(|| vec![1.0; given.len()]);
        let usable = |weight: &f64| *weight > 0.0 && weight.is_finite();
        study.ensure(
            weights.len() == given.len() && weights.iter().all(usable),
            key("weights"),
            format_args!("{weights:?}"),
            format_args!(
                "{} number(s) above zero, one for each frequency",
                given.len()
            ),
        )?;
        if let Some(value) = table.relative_deviation {
            let expected = "a fraction of the frequency above zero and below one";
            study.ensure(
                value > 0.0 && value < 1.0,
                key("relative_deviation"),
                value,
                expected,
            )?;
        }
        torques.push(TorqueData {
            torque_n_m: table.torque,
            omega_rad_per_s: given.iter().map(|value| to_omega * value).collect(),
            weights,
            relative_deviation: table.relative_deviation,
        });
    }
    let torque = |data: &TorqueData| data.torque_n_m.unwrap_or(0.0);
    torques.sort_by(|a, b| torque(a).total_cmp(&torque(b)));
    let mut pairs = torques.windows(2);
    match pairs.find(|pair| torque(&pair[0]) == torque(&pair[1])) {
        Some(pair) => {
            let found = format!("{} N·m twice", torque(&pair[0]));
            study.refuse("assembly.torque", found, "every torque once")
        }
        None => Ok(torques),
    }
}

/// One or two frequencies above zero, ascending.
fn check_frequencies(study: &StudyText, key: &str, given: &[f64]) -> Result<(), StudyError> {
    study.ensure(
        given.len() <= 2,
        key,
        format_args!("{} frequencies, {given:?}", given.len()),
        "at most two: the lap model has two degrees of freedom, so a third frequency cannot be compared with anything",
    )?;
    let usable = |value: &f64| *value > 0.0 && value.is_finite();
    study.ensure(
        !given.is_empty() && given.iter().all(usable),
        key,
        format_args!("{given:?}"),
        "one or two frequencies above zero",
    )?;
    match given {
        [first, second] if first >= second => study.refuse(
            key,
            format_args!("{given:?}"),
            format_args!(
                "ascending frequencies, the mode in phase first: the joint's stiffness only raises the other one; write [{second}, {first}] if they are swapped"
            ),
        ),
        _ => Ok(()),
    }
}

fn firefly(study: &StudyText, table: &FireflyTable) -> Result<Firefly, StudyError> {
    let otherwise = Firefly::default();
    let count = |key: &str, value: Option<usize>, least: usize, otherwise: usize| {
        let expected = format!("a number from {least} to {MOST}");
        let key = format!("firefly.{key}");
        study.within(key, value.unwrap_or(otherwise), least..=MOST, expected)
    };
    let size = |key: &str, value: Option<f64>, most: f64, otherwise: f64| {
        let expected = format!("a number from 0 to {most}");
        let key = format!("firefly.{key}");
        study.within(key, value.unwrap_or(otherwise), 0.0..=most, expected)
    };
    let (attractiveness, absorption) = (otherwise.attractiveness, otherwise.absorption);
    Ok(Firefly {
        population: count("population", table.population, 2, otherwise.population)?,
        iterations: count("iterations", table.iterations, 1, otherwise.iterations)?,
        attractiveness: size("attractiveness", table.attractiveness, 10.0, attractiveness)?,
        absorption: size("absorption", table.absorption, 1e6, absorption)?,
        step: size("step", table.step, 1.0, otherwise.step)?,
        decay: size("decay", table.decay, 1.0, otherwise.decay)?,
        seed: table.seed.unwrap_or(otherwise.seed),
    })
}
