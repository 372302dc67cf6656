//! A study's text, and where it lies: what every reader starts from.

use std::fmt::Display;
use std::path::{Path, PathBuf};

use serde::Deserialize;
use serde::de::DeserializeOwned;

use bolted_joint_files::text_file;

use super::{Method, StudyError};

/// The text of a study, and where it lies.
#[derive(Clone, Debug)]
pub struct StudyText {
    path: PathBuf,
    text: String,
}

impl StudyText {
    /// Reads a study's file.
    ///
    /// # Errors
    /// [`StudyError::File`] if it cannot be read, is empty, too long or no text.
    pub fn read(path: &Path) -> Result<Self, StudyError> {
        let text = text_file::read(path, "a study (TOML)")?;
        Ok(Self::new(text, path))
    }

    /// A study's text that is at hand; `path` tells where it lies.
    pub fn new(text: impl Into<String>, path: &Path) -> Self {
        Self {
            path: path.to_owned(),
            text: text.into(),
        }
    }

    /// The study's own file.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Its text.
    #[must_use]
    pub fn text(&self) -> &str {
        &self.text
    }

    /// The study's folder, which its paths are relative to.
    #[must_use]
    pub fn folder(&self) -> &Path {
        self.path.parent().unwrap_or(Path::new(""))
    }

    /// A path that stands in the study.
    #[must_use]
    pub fn resolved(&self, path: &Path) -> PathBuf {
        self.folder().join(path)
    }

    /// The study's tables.
    ///
    /// # Errors
    /// [`StudyError::Syntax`] with line and column for what is not TOML, keys that do not belong, keys that are missing and
    /// values of another type.
    pub fn tables<T: DeserializeOwned>(&self) -> Result<T, StudyError> {
        toml::from_str(&self.text).map_err(|error| StudyError::Syntax {
            path: self.path.clone(),
            message: error.to_string().trim_end().to_owned(),
        })
    }

    /// The method that the study asks for, whatever else is in it.
    ///
    /// # Errors
    /// [`StudyError::Syntax`] if the text is not TOML, has no method, or one that there is not.
    pub fn method(&self) -> Result<Method, StudyError> {
        #[derive(Deserialize)]
        struct MethodAlone {
            method: Method,
        }
        self.tables().map(|MethodAlone { method }| method)
    }

    /// The error for a value that cannot be used.
    pub fn refusal(
        &self,
        key: impl Display,
        found: impl Display,
        expected: impl Display,
    ) -> StudyError {
        StudyError::value(&self.path, key, found, expected)
    }
}
