//! A study of method `lap-response`, read with its data and checked before anything is computed.

mod checks;
mod noise;
mod repeats;
mod tables;

use std::path::{Path, PathBuf};
use std::sync::Arc;

use serde::{Deserialize, Serialize};

use self::checks::{band_hz, known, terms_of};
use self::noise::noise;
use self::repeats::Repeats;
use self::tables::StudyFile;
use super::backbone::{BackboneRun, read_backbone, read_decay};
use super::data::{SineOptions, SineRun, Use, read_sine};
use super::fit::Fit;
use super::model::{Model, ResponseUnknown, Values};
use super::terms::TermSet;
use crate::error::LapError;
use bolted_joint_study::{LineChoice, Method, StudyText, schema};

pub use self::noise::Noise;

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

/// Highest harmonic where the study names none, and the highest that it may name.
const HARMONICS: usize = 3;
const MOST_HARMONICS: usize = 99;

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
    /// Whether these terms are compared with all other models.
    pub compare: bool,
    /// Highest harmonic of the relative motion.
    pub harmonics: usize,
    /// That where the study names it.
    pub(in crate::response) stated_harmonics: Option<usize>,
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
    /// Rows that stand in the data more than once.
    pub(in crate::response) repeats: Repeats,
    /// That the stepped sines do not reach as far as the stated range, in words.
    pub(in crate::response) cut_back: Option<String>,
    /// Remarks that go into the joint file.
    pub notes: Vec<String>,
}

/// Where the level of the noise is from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NoiseIs {
    /// The study states it.
    Stated,
    /// Decays alone are fitted, and their records tell it.
    OfRecords,
    /// A nominal one, which the residual scales.
    Nominal,
}

impl NoiseIs {
    /// In a word or a few.
    #[must_use]
    pub fn words(self) -> &'static str {
        match self {
            Self::Stated => "stated",
            Self::OfRecords => "the records' own",
            Self::Nominal => "nominal",
        }
    }
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
    /// The JSON Schema of its file.
    #[must_use]
    pub fn schema() -> schema::Schema {
        schema::of::<StudyFile>()
    }

    /// By how much variances are raised where the residual is larger than the stated noise; the factor that makes the nominal noise
    /// that of the residual, where none is stated.
    pub(in crate::response) fn raised_by(&self, fit: &Fit) -> f64 {
        let reduced = fit.reduced_chi_squared();
        match self.noise.is_stated {
            true => reduced.max(1.0),
            false => reduced,
        }
    }

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
        let is_told = |run: &BackboneRun| run.errors.is_none() || self.noise.is_of_curves;
        let has_curves = self.backbones.iter().any(is_told);
        let curves = of_curves.iter().filter(|_| has_curves);
        sines.chain(curves).copied().collect()
    }

    /// Whether a χ² per degree of freedom of one is expected: the noise is stated, or records tell it.
    #[must_use]
    pub(in crate::response) fn knows_noise(&self) -> bool {
        self.noise_is() != NoiseIs::Nominal
    }

    /// Where the level of the noise is from.
    #[must_use]
    pub fn noise_is(&self) -> NoiseIs {
        let is_fitted = |used_for: Use| used_for == Use::Fit;
        let has_sines = self.sines.iter().any(|run| is_fitted(run.used_for));
        let mut backbones = self.backbones.iter().filter(|run| is_fitted(run.used_for));
        if self.noise.is_stated {
            NoiseIs::Stated
        } else if !has_sines && backbones.all(|run| run.errors.is_some()) {
            NoiseIs::OfRecords
        } else {
            NoiseIs::Nominal
        }
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
        let is_fitted = |used_for: Use| used_for == Use::Fit;
        let has_sines = file.sine.iter().any(|own| is_fitted(own.used_for));
        let has_curves = file.backbone.iter().any(|own| is_fitted(own.used_for))
            || file.decay.iter().any(|own| is_fitted(own.used_for));
        let noise = noise(study, &file.noise, [has_sines, has_curves])?;
        let terms = file.model.terms.as_deref();
        let terms = terms.map(|named| terms_of(study, named)).transpose()?;
        study.ensure(
            file.model.compare || terms.is_some(),
            "model.compare",
            "false without model.terms",
            "model.terms beside it: without a comparison nothing chooses the terms",
        )?;
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
        let fitted = file.sine.iter().filter(|own| is_fitted(own.used_for));
        study.every_file_once("sine.file", fitted.map(|own| own.file.as_path()))?;
        let fitted = file.backbone.iter().filter(|own| is_fitted(own.used_for));
        study.every_file_once("backbone.file", fitted.map(|own| own.file.as_path()))?;
        let fitted = file.decay.iter().filter(|own| is_fitted(own.used_for));
        study.every_file_once("decay.file", fitted.map(|own| own.file.as_path()))?;
        let mut repeats = Repeats::default();
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
            let name = options.name.clone();
            let (run, repeated) = read_sine(&study.resolved(&table.file), options)?;
            repeats.of_table(name, repeated);
            Ok(run)
        });
        let sines: Vec<SineRun> = sines.collect::<Result<_, LapError>>()?;
        let share = match file.model.response {
            Place::Relative => 1.0,
            Place::A | Place::B => 0.5,
        };
        let backbones = file.backbone.into_iter().map(|table| {
            let path = study.resolved(&table.file);
            let name = name_of(table.name, &table.file);
            let (lines, repeated) = read_backbone(&path, share)?;
            repeats.of_table(name.clone(), repeated);
            Ok::<_, LapError>(BackboneRun {
                name,
                lines,
                errors: None,
                following: None,
                recorded: None,
                rows: None,
                path,
                used_for: table.used_for,
            })
        });
        let decays = file.decay.into_iter().map(|table| {
            let path = study.resolved(&table.file);
            let band_hz = table.band.map(|band| band_hz(study, band)).transpose()?;
            let read = read_decay(&path, band_hz, share, &noise)?;
            Ok(BackboneRun {
                name: name_of(table.name, &table.file),
                lines: read.lines,
                errors: Some(read.errors),
                following: None,
                recorded: Some(Arc::new(read.recorded)),
                rows: None,
                path,
                used_for: table.used_for,
            })
        });
        let backbones: Vec<BackboneRun> = backbones.chain(decays).collect::<Result<_, _>>()?;
        let all_hz: Vec<Vec<f64>> = sines.iter().map(SineRun::frequencies_hz).collect();
        let cut_back = LineChoice::every_line_of(range_hz)
            .cut_back(all_hz.iter().map(Vec::as_slice), "the stepped sines");
        repeats.between_sines(study, &sines)?;
        repeats.between_backbones(study, &backbones)?;
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
            cut_back,
            drive: file.model.drive,
            response: file.model.response,
            terms,
            compare: file.model.compare,
            harmonics,
            stated_harmonics: file.model.harmonics,
            other_modes: file.model.other_modes,
            known,
            noise,
            torque_n_m: file.torque,
            sines,
            backbones,
            repeats,
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
