//! What can be wrong with a study, whichever method it is for.

use std::error::Error as StdError;
use std::fmt::Display;
use std::path::{Path, PathBuf};

use thiserror::Error;

use bolted_joint_files::misspelt::{between, did_you_mean};
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
        let (found, expected) = (found.to_string(), expected.to_string());
        let meant = meant(&found, &expected);
        Self::Value {
            path: path.to_owned(),
            key: key.to_string(),
            found,
            expected: expected + &meant,
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

/// The word in quotes that one in quotes was meant to be; nothing where the message says so already.
fn meant(found: &str, expected: &str) -> String {
    let word = found
        .strip_prefix('"')
        .and_then(|rest| rest.strip_suffix('"'));
    // what follows is an example
    let known = expected.split("such as").next().unwrap_or_default();
    match word.filter(|_| !expected.contains("did you mean")) {
        Some(word) => did_you_mean(word, &between(known, '"')),
        None => String::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_word_gets_the_one_that_was_meant() {
        #[rustfmt::skip]
        let cases = [
            ("\"bolt-crcle\"", "\"bolts\" or \"bolt-circle\"", "; did you mean `bolt-circle`?"),
            ("\"weld\"", "\"bolts\" or \"bolt-circle\"", ""),
            ("\"1:+Y\"", "a point such as \"11:+Y\"", ""),
            ("\"a.uf\", which is not there", "a file such as \"a.uff\"", ""),
            ("\"bolts \"", "\"bolts\"; did you mean it?", ""),
            ("5", "\"bolts\"", ""),
        ];
        for (found, expected, meant) in cases {
            let error = StudyError::value(Path::new("s.toml"), "model", found, expected);
            let message = format!("s.toml: `model`: found {found}, expected {expected}{meant}");
            assert_eq!(error.to_string(), message);
        }
    }
}
