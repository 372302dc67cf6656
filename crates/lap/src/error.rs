//! Why a lap model cannot be identified.

use std::path::PathBuf;

use bolted_joint_files::TextFileError;
use bolted_joint_identify::IdentifyError;
use thiserror::Error;

use super::response::{FitError, ResponseDataError};

/// Why a lap model cannot be identified.
#[derive(Debug, Error)]
pub enum LapError {
    /// The study or a file that it names cannot be used.
    #[error(transparent)]
    Study(#[from] IdentifyError),
    /// A table of responses cannot be used.
    #[error(transparent)]
    Response(#[from] ResponseDataError),
    /// A lap model cannot be fitted to responses.
    #[error("{}: {source}", path.display())]
    Fit {
        /// The study.
        path: PathBuf,
        /// Why not.
        source: FitError,
    },
}

impl From<TextFileError> for LapError {
    fn from(error: TextFileError) -> Self {
        Self::Study(error.into())
    }
}
