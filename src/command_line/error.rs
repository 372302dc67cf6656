//! Everything that can end a command with exit code 1 or 3.

use std::error::Error;
use std::fmt::Display;
use std::io;
use std::path::{Path, PathBuf};

use bolted_joint_files::whole_file::advice;
use thiserror::Error;

use bolted_joint::assembly::AssemblyError;
use bolted_joint::check::CheckError;
use bolted_joint::compare::CompareError;
use bolted_joint::convert::ConvertError;
use bolted_joint::cosimulation::CouplingError;
use bolted_joint::draws::DrawsError;
use bolted_joint::export::{DateError, ExportError};
use bolted_joint::frf::FrfError;
use bolted_joint::identify::IdentifyError;
use bolted_joint::identify::lap::LapError;
use bolted_joint::identify::space::SpatialError;
use bolted_joint::joint::{JointFileError, LawError};
use bolted_joint::reproduce::ReproduceError;
use bolted_joint::respond::RespondError;
use bolted_joint::show::{DraftError, ShowError};
use bolted_joint::study::StudyError;

/// Why a command did not do what it was asked for.
#[derive(Debug, Error)]
pub(super) enum CliError {
    /// What the library says, file and key included.
    #[error(transparent)]
    Library(Box<dyn Error>),
    #[error("{}: {source}", path.display())]
    Unexportable { path: PathBuf, source: ExportError },
    #[error("{}: {source}", path.display())]
    Preload { path: PathBuf, source: LawError },
    #[error("{}: {source}", path.display())]
    Unconvertible { path: PathBuf, source: ConvertError },
    #[error("communication step: {0}")]
    Coupling(CouplingError),
    #[error("{}: cannot be written: {source}; {}", path.display(), advice(source))]
    Unwritable { path: PathBuf, source: io::Error },
    #[error("{}: found it to be the same file as {}, expected another; give the output a name of its own", path.display(), other.display())]
    SameFile { path: PathBuf, other: PathBuf },
    #[error("{}: found it to be the file that `{key}` of {} names, expected another; give the output a name of its own", path.display(), study.display())]
    Named {
        path: PathBuf,
        study: PathBuf,
        key: String,
    },
    #[error("{}: cannot be read: {source}; give the path of {expected}", path.display())]
    Unreadable {
        path: PathBuf,
        source: io::Error,
        expected: &'static str,
    },
    #[error("{}: found {found}, expected {expected}; {instead}", path.display())]
    Kind {
        path: PathBuf,
        found: String,
        expected: &'static str,
        instead: String,
    },
    #[error("{option}: found {found}, expected {expected}")]
    Option {
        option: &'static str,
        found: String,
        expected: &'static str,
    },
    #[error("{}:\n  {findings}", path.display())]
    Check { path: PathBuf, findings: String },
    #[error("{}: not to be relied on:\n  {reasons}", path.display())]
    NotUsable { path: PathBuf, reasons: String },
    #[error("the result cannot be printed: {0}")]
    Output(#[from] io::Error),
    #[error("the result cannot be written as JSON: {0}")]
    Json(#[from] serde_json::Error),
}

macro_rules! from_the_library {
    ($($error:ty),+) => {
        $(impl From<$error> for CliError {
            fn from(error: $error) -> Self {
                Self::Library(Box::new(error))
            }
        })+
    };
}

from_the_library!(
    AssemblyError,
    CompareError,
    DateError,
    DraftError,
    DrawsError,
    ExportError,
    FrfError,
    IdentifyError,
    CheckError,
    JointFileError,
    LapError,
    ReproduceError,
    RespondError,
    ShowError,
    SpatialError,
    StudyError
);

impl CliError {
    /// Whether the reader of stdout has gone away, as `head` does: no error of the user's.
    pub(super) fn is_closed_output(&self) -> bool {
        matches!(self, Self::Output(error) if error.kind() == io::ErrorKind::BrokenPipe)
    }

    /// What the program ends with: 3 where it did its work but the result is not to be relied on.
    pub(super) fn exit_code(&self) -> u8 {
        match self {
            Self::NotUsable { .. } => 3,
            _ => 1,
        }
    }

    /// Nothing, unless these reasons speak against the joint in a file.
    pub(super) fn unless_usable(path: &Path, reasons: &[String]) -> Result<(), Self> {
        match reasons {
            [] => Ok(()),
            reasons => Err(Self::NotUsable {
                path: path.to_owned(),
                reasons: reasons.join("\n  "),
            }),
        }
    }

    /// An option that does not go with the others.
    pub(super) fn option(
        option: &'static str,
        found: impl Display,
        expected: &'static str,
    ) -> Self {
        Self::Option {
            option,
            found: found.to_string(),
            expected,
        }
    }
}
