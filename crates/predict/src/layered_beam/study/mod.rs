//! A study of a layered beam: which beam, which fasteners, which motion; checked before anything is computed.

mod check;
mod tables;

use std::path::{Path, PathBuf};

use bolted_joint_joint::InputFile;
use bolted_joint_study::{Method, StudyError, StudyText, schema};

use super::beam::LayeredBeam;
use super::beam_mode::{Route, StoredEnergy};
use super::fasteners::Fasteners;
use super::lap::EquivalentDamping;
use super::outcome::Outcome;
use super::scatter::Scatter;
use tables::StudyFile;

/// A validated study of method `layered-beam`.
#[derive(Clone, Debug)]
pub struct LayeredBeamStudy {
    /// The study's own file.
    pub path: PathBuf,
    /// The record of it that goes into the joint file.
    pub record: InputFile,
    /// Its name.
    pub name: String,
    /// Remarks that go into the joint file.
    pub notes: Vec<String>,
    /// The beam.
    pub beam: LayeredBeam,
    /// Its fasteners, at the nominal torque where there are several.
    pub fasteners: Fasteners,
    /// The fasteners over the tightening torque (N·m, ascending), where the study gives several.
    pub over_torque: Vec<(f64, Fasteners)>,
    /// The torque of `fasteners`, N·m, where it is given.
    pub nominal_torque_n_m: Option<f64>,
    /// α′μ, or where it comes from.
    pub friction: Friction,
    /// The mode that the joint file stands for, counted from one.
    pub mode: usize,
    /// How many modes are listed.
    pub modes: usize,
    /// Where the mode is driven and its amplitude counts, from the first end, m; `None` for the largest deflection.
    pub drive_point_m: Option<f64>,
    /// Amplitudes of the drive point, m, ascending.
    pub amplitudes_m: Vec<f64>,
    /// Which route the joint file takes.
    pub route: Route,
    /// What the stored energy is taken from.
    pub stored: StoredEnergy,
    /// How damping goes into the joint file.
    pub damping: EquivalentDamping,
    /// What is drawn, where a value has a standard deviation.
    pub scatter: Option<Scatter>,
}

/// Where α′μ comes from.
#[derive(Clone, Debug)]
pub enum Friction {
    /// It is given.
    Known(f64),
    /// It is what one measured damping ratio asks for.
    Calibrated(Box<Calibration>),
}

/// A damping ratio measured on a beam.
#[derive(Clone, Debug)]
pub struct Calibration {
    /// ζ.
    pub damping_ratio: f64,
    /// Amplitude of the drive point at which it was measured, m.
    pub amplitude_m: f64,
    /// The mode, counted from one.
    pub mode: usize,
    /// Where its amplitude counts, from the first end, m; `None` for the largest deflection.
    pub drive_point_m: Option<f64>,
    /// The beam.
    pub beam: LayeredBeam,
    /// Its fasteners.
    pub fasteners: Fasteners,
}

impl LayeredBeamStudy {
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
        study.check_method(file.method, &[Method::LayeredBeam])?;
        study.check_name("name", &file.name)?;
        check::checked(study, file)
    }

    /// Computes frequencies, damping and the equivalent lap.
    ///
    /// # Errors
    /// [`StudyError::Model`] where the model does not hold.
    pub fn run(&self) -> Result<Outcome, StudyError> {
        self.run_watched(&|| ())
    }

    /// As [`run`](Self::run); `progress` is called after each draw, from any thread.
    ///
    /// # Errors
    /// As [`run`](Self::run).
    pub fn run_watched(&self, progress: &(dyn Fn() + Sync)) -> Result<Outcome, StudyError> {
        let found = Outcome::of(self, progress);
        found.map_err(|source| StudyError::model(&self.path, None, source))
    }

    /// How many draws [`run`](Self::run) makes; none where no value is uncertain.
    #[must_use]
    pub fn draws(&self) -> u64 {
        self.scatter.as_ref().map_or(0, Scatter::draws)
    }
}
