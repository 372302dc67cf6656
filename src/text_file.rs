//! Reading of small text files, with one set of messages for what can be wrong with any of them.

use std::path::{Path, PathBuf};

use thiserror::Error;

/// Why a text file cannot be read.
#[derive(Debug, Error)]
pub enum TextFileError {
    /// The file is missing or may not be read.
    #[error("{}: cannot be read ({source}); check the path; paths in a study are relative to the study's own folder", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// What the operating system says.
        source: std::io::Error,
    },
    /// Nothing in it.
    #[error("{}: found an empty file, expected {expected}", path.display())]
    Empty {
        /// The file.
        path: PathBuf,
        /// What should be in it.
        expected: &'static str,
    },
    /// Bytes that are no text.
    #[error("{}: found binary data (byte {offset}), expected {expected} in UTF-8 text", path.display())]
    Binary {
        /// The file.
        path: PathBuf,
        /// Offset of the first byte that is no text.
        offset: usize,
        /// What should be in it.
        expected: &'static str,
    },
}

/// The text of `path`, which should hold `expected`.
///
/// # Errors
/// [`TextFileError`] if it cannot be read, is empty or is not UTF-8 text.
pub(crate) fn read(path: &Path, expected: &'static str) -> Result<String, TextFileError> {
    let bytes = std::fs::read(path).map_err(|source| TextFileError::Unreadable {
        path: path.to_owned(),
        source,
    })?;
    if bytes.iter().all(u8::is_ascii_whitespace) {
        return Err(TextFileError::Empty {
            path: path.to_owned(),
            expected,
        });
    }
    let nul = bytes.iter().position(|&byte| byte == 0);
    let binary = |offset| TextFileError::Binary {
        path: path.to_owned(),
        offset,
        expected,
    };
    match (nul, String::from_utf8(bytes)) {
        (nul, Err(error)) => {
            let valid_up_to = error.utf8_error().valid_up_to();
            Err(binary(nul.map_or(valid_up_to, |nul| nul.min(valid_up_to))))
        }
        (Some(nul), Ok(_)) => Err(binary(nul)),
        (None, Ok(text)) => Ok(text),
    }
}
