//! Everything that can end a command with exit code 1.

use std::io;
use std::path::PathBuf;

use thiserror::Error;

use bolted_joint::check::{InspectError, RunError};
use bolted_joint::cosimulation::CouplingError;
use bolted_joint::export::{DateError, ExportError};
use bolted_joint::frf::FrfError;
use bolted_joint::identify::IdentifyError;
use bolted_joint::identify::lap::LapError;
use bolted_joint::joint::{JointFileError, PreloadError};
use bolted_joint::predict::study::PredictError;
use bolted_joint::reproduce::ReproduceError;
use bolted_joint::respond::{PollutionError, RespondError};

/// Why a command did not do what it was asked for.
#[derive(Debug, Error)]
pub(super) enum CliError {
    #[error(transparent)]
    Identify(Box<IdentifyError>),
    #[error(transparent)]
    Lap(Box<LapError>),
    #[error(transparent)]
    Date(#[from] DateError),
    #[error(transparent)]
    Predict(Box<PredictError>),
    #[error(transparent)]
    Reproduce(#[from] ReproduceError),
    #[error(transparent)]
    Pollution(#[from] PollutionError),
    #[error(transparent)]
    Respond(Box<RespondError>),
    #[error(transparent)]
    Frf(#[from] FrfError),
    #[error(transparent)]
    JointFile(#[from] JointFileError),
    #[error(transparent)]
    Export(#[from] ExportError),
    #[error("{}: {source}", path.display())]
    Unexportable { path: PathBuf, source: ExportError },
    #[error("{}: {source}", path.display())]
    Preload { path: PathBuf, source: PreloadError },
    #[error(transparent)]
    Inspect(#[from] InspectError),
    #[error(transparent)]
    Run(#[from] RunError),
    #[error("communication step: {0}")]
    Coupling(CouplingError),
    #[error("{}: cannot be written: {source}; give a path in a folder that exists and may be written to", path.display())]
    Unwritable { path: PathBuf, source: io::Error },
    #[error("{}: found it to be the same file as {}, expected another; give the output a name of its own", path.display(), other.display())]
    SameFile { path: PathBuf, other: PathBuf },
    #[error("{option}: found {found}, expected {expected}")]
    Option {
        option: &'static str,
        found: String,
        expected: &'static str,
    },
    #[error("{}:\n  {findings}", path.display())]
    Check { path: PathBuf, findings: String },
    #[error("the result cannot be printed: {0}")]
    Output(#[from] io::Error),
    #[error("the result cannot be written as JSON: {0}")]
    Json(#[from] serde_json::Error),
}

impl From<IdentifyError> for CliError {
    fn from(error: IdentifyError) -> Self {
        Self::Identify(Box::new(error))
    }
}

impl From<LapError> for CliError {
    fn from(error: LapError) -> Self {
        Self::Lap(Box::new(error))
    }
}

impl From<PredictError> for CliError {
    fn from(error: PredictError) -> Self {
        Self::Predict(Box::new(error))
    }
}

impl From<RespondError> for CliError {
    fn from(error: RespondError) -> Self {
        Self::Respond(Box::new(error))
    }
}

impl CliError {
    /// Whether the reader of stdout has gone away, as `head` does: no error of the user's.
    pub(super) fn is_closed_output(&self) -> bool {
        matches!(self, Self::Output(error) if error.kind() == io::ErrorKind::BrokenPipe)
    }
}
