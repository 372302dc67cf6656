//! What can be wrong with a study, whichever method it is for.

use std::error::Error as StdError;
use std::fmt::Display;
use std::path::{Path, PathBuf};

use thiserror::Error;

use bolted_joint_files::text_file::TextFileError;

/// Why a study cannot be used.
#[derive(Debug, Error)]
pub enum StudyError {
    /// The study, or a text file that it names, cannot be read.
    #[error(transparent)]
    File(#[from] TextFileError),
    /// It is not TOML, or has keys or types that do not belong.
    #[error("{}: {message}", path.display())]
    Syntax {
        /// The study.
        path: PathBuf,
        /// What is wrong, with line and column.
        message: String,
    },
    /// A value cannot be used.
    #[error("{}: `{key}`: found {found}, expected {expected}", path.display())]
    Value {
        /// The study.
        path: PathBuf,
        /// The key.
        key: String,
        /// What was found.
        found: String,
        /// What was expected, and how to get there.
        expected: String,
    },
    /// The values are well formed, but what they describe cannot be.
    #[error("{}: {}{source}", path.display(), key.as_ref().map(|key| format!("`{key}`: ")).unwrap_or_default())]
    Model {
        /// The study.
        path: PathBuf,
        /// The key, unless the reason names it.
        key: Option<String>,
        /// Why not.
        source: Box<dyn StdError + Send + Sync>,
    },
    /// A file that the study names cannot be used, for a reason that names it.
    #[error(transparent)]
    Named(Box<dyn StdError + Send + Sync>),
}

impl StudyError {
    /// A file that the study names cannot be used.
    pub fn of_file(reason: impl StdError + Send + Sync + 'static) -> Self {
        Self::Named(Box::new(reason))
    }

    /// A value of `key` that cannot be used.
    pub fn value(
        path: &Path,
        key: impl Display,
        found: impl Display,
        expected: impl Display,
    ) -> Self {
        Self::Value {
            path: path.to_owned(),
            key: key.to_string(),
            found: found.to_string(),
            expected: expected.to_string(),
        }
    }

    /// What a study describes cannot be; without a `key` where the reason names it.
    pub fn model(
        path: &Path,
        key: Option<&str>,
        source: impl StdError + Send + Sync + 'static,
    ) -> Self {
        Self::Model {
            path: path.to_owned(),
            key: key.map(str::to_owned),
            source: Box::new(source),
        }
    }
}
