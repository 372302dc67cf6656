//! A study of method `lap-response`, read with its data and checked before anything is computed.

use std::path::{Path, PathBuf};

use bolted_joint_dynamics::law::Term;
use serde::{Deserialize, Serialize};

use super::backbone::{BackboneRun, read_backbone, read_decay};
use super::data::{PhaseOf, SineLine, SineOptions, SineRun, Use, read_sine};
use super::model::{Model, ResponseUnknown, Values};
use super::slider::Slider;
use super::terms::{NamedTerm, TermSet};
use crate::error::LapError;
use bolted_joint_study::{FrequencyTable, Method, StudyError, StudyText};

/// Where a force acts or a motion is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Place {
    /// Body a.
    A,
    /// Body b.
    B,
    /// The relative motion: a force on a with its opposite on b, or x_a − x_b.
    Relative,
}

/// Standard deviations of what was measured, as fractions of it: of the complex errors of response and force, so that each part and
/// each logarithm and angle has the √2-th part.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Noise {
    /// Of the response.
    pub response: f64,
    /// Of the force.
    pub force: f64,
    /// Part of the response's that does not depend on it, m.
    pub floor_m: f64,
    /// Of the frequencies of a backbone.
    pub frequency: f64,
    /// Of damping ratios and forces of a backbone.
    pub damping: f64,
    /// Whether the study stated them; else their common factor is estimated from the residual.
    pub is_stated: bool,
}

impl Noise {
    /// Stated noise of force and response.
    #[must_use]
    pub fn stated(response: f64, force: f64) -> Self {
        Self {
            response,
            force,
            is_stated: true,
            ..Self::default()
        }
    }

    /// Reciprocal standard deviations of ln F, ln x and the phase. A force without error would leave its line without an amplitude
    /// to adjust, so that it has a very small one.
    pub(super) fn weights(&self, line: &SineLine) -> [f64; 3] {
        let floor = self.floor_m / line.displacement_m;
        let response = self.response * self.response + floor * floor;
        let force = (self.force * self.force).max(EXACT * EXACT * response);
        [force, response, force + response].map(|variance| (0.5 * variance).sqrt().recip())
    }
}

/// Highest harmonic where the study names none, and the highest that it may name.
const HARMONICS: usize = 3;
const MOST_HARMONICS: usize = 99;

/// A force without error counts as one with this part of the response's.
const EXACT: f64 = 1e-4;

impl Default for Noise {
    fn default() -> Self {
        Self {
            response: 0.01,
            force: 0.01,
            floor_m: 0.0,
            frequency: 1e-4,
            damping: 0.01,
            is_stated: false,
        }
    }
}

/// A validated study of method `lap-response`, with its data.
#[derive(Clone, Debug)]
pub struct LapResponseStudy {
    /// The study's own file.
    pub path: PathBuf,
    /// Name of the joint.
    pub name: String,
    /// Where the force acts.
    pub drive: Place,
    /// What is measured.
    pub response: Place,
    /// The terms of the model; `None` leaves the choice to the data.
    pub terms: Option<TermSet>,
    /// Highest harmonic of the relative motion.
    pub harmonics: usize,
    /// Whether other modes may add a constant to the receptance.
    pub other_modes: bool,
    /// What is known of k, m, c, k12, c12; the others are unknown.
    pub known: Vec<(ResponseUnknown, f64)>,
    /// Noise.
    pub noise: Noise,
    /// Tightening torque, N·m.
    pub torque_n_m: Option<f64>,
    /// Stepped sines.
    pub sines: Vec<SineRun>,
    /// Backbones, and free decays turned into them.
    pub backbones: Vec<BackboneRun>,
    /// Remarks that go into the joint file.
    pub notes: Vec<String>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct StudyFile {
    method: Method,
    name: String,
    #[serde(default)]
    notes: Vec<String>,
    torque: Option<f64>,
    model: ModelTable,
    #[serde(default)]
    known: KnownTable,
    #[serde(default)]
    noise: NoiseTable,
    #[serde(default)]
    frequency: FrequencyTable,
    #[serde(default)]
    sine: Vec<SineTable>,
    #[serde(default)]
    backbone: Vec<FileTable>,
    #[serde(default)]
    decay: Vec<DecayTable>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct ModelTable {
    drive: Place,
    response: Place,
    terms: Option<Vec<NamedTerm>>,
    harmonics: Option<usize>,
    #[serde(default)]
    other_modes: bool,
}

#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields)]
struct KnownTable {
    k: Option<f64>,
    m: Option<f64>,
    c: Option<f64>,
    k12: Option<f64>,
    c12: Option<f64>,
}

#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields)]
struct NoiseTable {
    response: Option<f64>,
    force: Option<f64>,
    floor_m: Option<f64>,
    frequency: Option<f64>,
    damping: Option<f64>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct SineTable {
    file: PathBuf,
    name: Option<String>,
    #[serde(default, rename = "use")]
    used_for: Use,
    phase_of: Option<PhaseOf>,
    phase_sign: Option<i8>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct FileTable {
    file: PathBuf,
    name: Option<String>,
    #[serde(default, rename = "use")]
    used_for: Use,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct DecayTable {
    file: PathBuf,
    name: Option<String>,
    #[serde(default, rename = "use")]
    used_for: Use,
    /// Hz
    band: Option<[f64; 2]>,
}

/// A run's name: the stated one, or the file's.
fn name_of(stated: Option<String>, file: &Path) -> String {
    stated.unwrap_or_else(|| {
        file.file_stem()
            .unwrap_or_default()
            .to_string_lossy()
            .into_owned()
    })
}

impl LapResponseStudy {
    /// Noise of each kind of data that there is: its name and the fraction.
    #[must_use]
    pub fn noise_by_kind(&self) -> Vec<(&'static str, f64)> {
        let of_sines = [
            ("response", self.noise.response),
            ("force", self.noise.force),
        ];
        let of_curves = [
            ("frequency", self.noise.frequency),
            ("damping", self.noise.damping),
        ];
        let sines = of_sines.iter().filter(|_| !self.sines.is_empty());
        let curves = of_curves.iter().filter(|_| !self.backbones.is_empty());
        sines.chain(curves).copied().collect()
    }

    /// Reads and checks a study and its data.
    ///
    /// # Errors
    /// [`LapError`] that names the file and the key or line.
    pub fn read(path: &Path) -> Result<Self, LapError> {
        Self::of(&StudyText::read(path)?)
    }

    /// A study from its text, with its data.
    ///
    /// # Errors
    /// [`LapError`] that names the file and the key or line.
    pub fn of(study: &StudyText) -> Result<Self, LapError> {
        let file: StudyFile = study.tables()?;
        study.check_method(file.method, &[Method::LapResponse])?;
        study.check_name("name", &file.name)?;
        let noise = noise(study, &file.noise)?;
        let terms = file.model.terms.as_deref();
        let terms = terms.map(|named| terms_of(study, named)).transpose()?;
        if let Some(torque) = file.torque {
            study.not_negative("torque", torque, "N·m, not negative")?;
        }
        let harmonics = file.model.harmonics.unwrap_or(HARMONICS);
        study.ensure(
            !harmonics.is_multiple_of(2) && harmonics <= MOST_HARMONICS,
            "model.harmonics",
            harmonics,
            format_args!(
                "an odd number up to {MOST_HARMONICS}: the joint's law is odd, so the even harmonics vanish"
            ),
        )?;
        let range_hz = study.frequency_range_hz(&file.frequency)?;
        let known = known(study, &file)?;
        let sines = file.sine.into_iter().map(|table| {
            let phase_sign = match table.phase_sign {
                None | Some(1) => 1.0,
                Some(-1) => -1.0,
                Some(other) => return Ok(study.refuse("sine.phase_sign", other, "1 or -1")?),
            };
            let options = SineOptions {
                name: name_of(table.name, &table.file),
                used_for: table.used_for,
                phase_of: table.phase_of,
                phase_sign,
                range_hz,
                is_drive_point: file.model.drive == file.model.response,
            };
            read_sine(&study.resolved(&table.file), options)
        });
        let sines: Vec<SineRun> = sines.collect::<Result<_, LapError>>()?;
        let share = match file.model.response {
            Place::Relative => 1.0,
            Place::A | Place::B => 0.5,
        };
        let backbones = file.backbone.into_iter().map(|table| {
            let path = study.resolved(&table.file);
            Ok::<_, LapError>(BackboneRun {
                name: name_of(table.name, &table.file),
                lines: read_backbone(&path, share)?,
                path,
                used_for: table.used_for,
            })
        });
        let decays = file.decay.into_iter().map(|table| {
            let path = study.resolved(&table.file);
            let band_hz = table.band.map(|band| band_hz(study, band)).transpose()?;
            Ok(BackboneRun {
                name: name_of(table.name, &table.file),
                lines: read_decay(&path, band_hz, share)?,
                path,
                used_for: table.used_for,
            })
        });
        let backbones: Vec<BackboneRun> = backbones.chain(decays).collect::<Result<_, _>>()?;
        let fitted = sines.iter().any(|run| run.used_for == Use::Fit)
            || backbones.iter().any(|run| run.used_for == Use::Fit);
        study.ensure(
            fitted,
            "sine",
            "no run for the estimate",
            "at least one [[sine]], [[backbone]] or [[decay]] whose `use` is \"fit\"",
        )?;
        let found = Self {
            path: study.path().to_owned(),
            name: file.name,
            drive: file.model.drive,
            response: file.model.response,
            terms,
            harmonics,
            other_modes: file.model.other_modes,
            known,
            noise,
            torque_n_m: file.torque,
            sines,
            backbones,
            notes: file.notes,
        };
        study.ensure(
            found.backbones.is_empty() || !found.model(&TermSet::default()).sees_sum(),
            "backbone",
            "a curve of one mode beside responses of both bodies",
            "model.drive or model.response = \"relative\" with backbones and decays",
        )?;
        Ok(found)
    }

    /// The model with some terms: what is not known is unknown. Where the bodies' motion together is not seen, their supports count
    /// as part of the joint, unless they are known: k and c are then zero.
    #[must_use]
    pub fn model(&self, terms: &TermSet) -> Model {
        let mut model = Model {
            drive: self.drive,
            response: self.response,
            terms: terms.clone(),
            unknowns: Vec::new(),
            harmonics: self.harmonics,
        };
        let linear = [
            ResponseUnknown::Mass,
            ResponseUnknown::SupportStiffness,
            ResponseUnknown::SupportDamping,
            ResponseUnknown::JointStiffness,
            ResponseUnknown::JointDamping,
        ];
        let sees_sum = model.sees_sum();
        let of_support = |unknown: &ResponseUnknown| {
            matches!(
                unknown,
                ResponseUnknown::SupportStiffness | ResponseUnknown::SupportDamping
            )
        };
        let is_known =
            |unknown: &ResponseUnknown| self.known.iter().any(|(known, _)| known == unknown);
        model.unknowns = linear
            .into_iter()
            .filter(|unknown| !is_known(unknown) && (sees_sum || !of_support(unknown)))
            .chain(terms.unknowns())
            .collect();
        if self.other_modes {
            model.unknowns.extend([
                ResponseUnknown::OtherModesReal,
                ResponseUnknown::OtherModesImaginary,
            ]);
        }
        model
    }

    /// What is known, zero elsewhere.
    #[must_use]
    pub fn known_values(&self) -> Values {
        let mut values = Values::default();
        for (unknown, value) in &self.known {
            if let Some(place) = values.place(*unknown) {
                *place = *value;
            }
        }
        values
    }
}

/// The terms that a study names.
fn terms_of(study: &StudyText, named: &[NamedTerm]) -> Result<TermSet, StudyError> {
    let mut terms: Vec<Term> = Vec::new();
    let mut sliders: Vec<Slider> = Vec::new();
    for name in named {
        match *name {
            NamedTerm::Term(term) => {
                let found = format!("{} twice", term.row().symbol);
                let is_new = !terms.contains(&term);
                study.ensure(is_new, "model.terms", found, "every term once")?;
                terms.push(term);
            }
            NamedTerm::Slider(slider) => sliders.push(slider),
        }
    }
    let names: Vec<&str> = sliders.iter().map(|slider| slider.name()).collect();
    let expected = "one law that slips at most";
    study.ensure(
        sliders.len() < 2,
        "model.terms",
        names.join(" and "),
        expected,
    )?;
    let set = TermSet::of(&terms);
    Ok(sliders.into_iter().fold(set, TermSet::beside))
}

fn known(study: &StudyText, file: &StudyFile) -> Result<Vec<(ResponseUnknown, f64)>, StudyError> {
    let table = &file.known;
    let all = [
        (ResponseUnknown::Mass, table.m),
        (ResponseUnknown::SupportStiffness, table.k),
        (ResponseUnknown::SupportDamping, table.c),
        (ResponseUnknown::JointStiffness, table.k12),
        (ResponseUnknown::JointDamping, table.c12),
    ];
    let mut known = Vec::new();
    for (unknown, value) in all {
        let Some(value) = value else { continue };
        let is_there = unknown != ResponseUnknown::Mass || value != 0.0;
        study.ensure(
            is_there && value >= 0.0 && value.is_finite(),
            format_args!("known.{}", unknown.symbol()),
            value,
            format_args!(
                "a value in {} that is not negative, a mass above zero",
                unknown.unit()
            ),
        )?;
        known.push((unknown, value));
    }
    Ok(known)
}

fn band_hz(study: &StudyText, [from, to]: [f64; 2]) -> Result<[f64; 2], StudyError> {
    let is_band = from >= 0.0 && to > from && to.is_finite();
    let expected = "[lowest, highest] frequency in Hz, such as [60, 100]";
    study.ensure(
        is_band,
        "decay.band",
        format_args!("[{from}, {to}]"),
        expected,
    )?;
    Ok([from, to])
}

fn noise(study: &StudyText, table: &NoiseTable) -> Result<Noise, StudyError> {
    for (name, value, may_vanish) in [
        ("response", table.response, false),
        ("force", table.force, true),
        ("floor_m", table.floor_m, true),
        ("frequency", table.frequency, false),
        ("damping", table.damping, false),
    ] {
        let Some(value) = value else { continue };
        let key = format!("noise.{name}");
        study.not_negative(&key, value, "a number that is not negative")?;
        let expected = "a fraction above zero: a measurement has errors";
        study.ensure(may_vanish || value != 0.0, key, value, expected)?;
    }
    let otherwise = Noise::default();
    let response = table.response.unwrap_or(otherwise.response);
    Ok(Noise {
        response,
        // What is not said of the force is as of the response.
        force: table.force.unwrap_or(response),
        floor_m: table.floor_m.unwrap_or(0.0),
        frequency: table.frequency.unwrap_or(otherwise.frequency),
        damping: table.damping.unwrap_or(otherwise.damping),
        is_stated: table.response.is_some() || table.frequency.is_some(),
    })
}
