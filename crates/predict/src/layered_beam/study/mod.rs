//! A study of a layered beam: which beam, which fasteners, which motion; checked before anything is computed.

mod check;
mod tables;

use std::path::{Path, PathBuf};

use thiserror::Error;

use bolted_joint_files::text_file::{self, TextFileError};

use super::beam::LayeredBeam;
use super::beam_mode::{Route, StoredEnergy};
use super::error::LayeredBeamError;
use super::fasteners::Fasteners;
use super::lap::EquivalentDamping;
use super::outcome::Outcome;
use super::scatter::Scatter;
use tables::StudyFile;

/// Why a study of a layered beam cannot be used.
#[derive(Debug, Error)]
pub enum StudyError {
    /// The file cannot be read.
    #[error(transparent)]
    File(#[from] TextFileError),
    /// The study is not TOML, or has keys or types that do not belong.
    #[error("{}: {message}", path.display())]
    Syntax {
        /// The study.
        path: PathBuf,
        /// What is wrong, with line and column.
        message: String,
    },
    /// A value in the study cannot be used.
    #[error("{}: `{key}`: found {found}, expected {expected}", path.display())]
    Value {
        /// The study.
        path: PathBuf,
        /// Key in the study.
        key: String,
        /// What was found.
        found: String,
        /// What was expected.
        expected: String,
    },
    /// The beam, its fasteners or its motion make no sense.
    #[error("{}: {source}", path.display())]
    Model {
        /// The study.
        path: PathBuf,
        /// What does not.
        source: LayeredBeamError,
    },
}

/// A validated study of method `layered-beam`.
#[derive(Clone, Debug)]
pub struct Study {
    /// The study's own file.
    pub path: PathBuf,
    /// SHA-256 of its text, hexadecimal.
    pub sha256: String,
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

impl Study {
    /// Reads and checks a study.
    ///
    /// # Errors
    /// [`StudyError`] that names the file and the key or line.
    pub fn read(path: &Path) -> Result<Self, StudyError> {
        let text = text_file::read(path, "a study (TOML)")?;
        Self::from_toml(&text, path)
    }

    /// A study from the text of its file; `path` tells where that lies.
    ///
    /// # Errors
    /// [`StudyError`] that names the file and the key or line.
    pub fn from_toml(text: &str, path: &Path) -> Result<Self, StudyError> {
        let file: StudyFile = toml::from_str(text).map_err(|error| StudyError::Syntax {
            path: path.to_owned(),
            message: error.to_string().trim_end().to_owned(),
        })?;
        check::Checker { path, text }.study(file)
    }

    /// Name of the study's file without its folder.
    pub(super) fn file_name(&self) -> String {
        let name = self.path.file_name().unwrap_or(self.path.as_os_str());
        name.to_string_lossy().into_owned()
    }

    /// Computes frequencies, damping and the equivalent lap.
    ///
    /// # Errors
    /// [`StudyError::Model`] where the model does not hold.
    pub fn run(&self) -> Result<Outcome, StudyError> {
        Outcome::of(self).map_err(|source| StudyError::Model {
            path: self.path.clone(),
            source,
        })
    }
}
