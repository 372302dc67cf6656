//! Reading of small text files, with one set of messages for what can be wrong with any of them.

use std::fs::File;
use std::io::{self, Read as _};
use std::path::{Path, PathBuf};

use thiserror::Error;

use crate::encoding::Encoding;
use crate::inputs;

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
    /// More than any such file holds.
    #[error("{}: found more than {limit} bytes, expected {expected}; check the path", path.display())]
    TooLong {
        /// The file.
        path: PathBuf,
        /// The longest file that is read, bytes.
        limit: u64,
        /// What should be in it.
        expected: &'static str,
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
    /// Text, but not in UTF-8.
    #[error(
        "{}, line {line}: found text in {encoding}, expected {expected} in UTF-8; save it as UTF-8, an encoding that editors offer \
         beside the file's name",
        path.display()
    )]
    Encoding {
        /// The file.
        path: PathBuf,
        /// The first line that tells, from 1.
        line: usize,
        /// How the text seems to be written.
        encoding: Encoding,
        /// What should be in it.
        expected: &'static str,
    },
    /// Something in a line.
    #[error("{}, line {line}: found {found}, expected {expected}", path.display())]
    Line {
        /// The file.
        path: PathBuf,
        /// The line, from 1.
        line: usize,
        /// What was found.
        found: String,
        /// What was expected.
        expected: String,
    },
}

impl TextFileError {
    /// Something in a line of a file, from 1, that is not as it should be.
    pub fn in_line(
        path: &Path,
        line: usize,
        found: impl Into<String>,
        expected: impl Into<String>,
    ) -> Self {
        Self::Line {
            path: path.to_owned(),
            line,
            found: found.into(),
            expected: expected.into(),
        }
    }
}

/// Files that people write or read are shorter than this; what is longer is something else, and need not fill the memory.
pub const LONGEST_FILE: u64 = 1 << 24;

/// What is in a file; `None` if that is more than [`LONGEST_FILE`] bytes.
pub fn bytes(path: &Path) -> io::Result<Option<Vec<u8>>> {
    let mut bytes = Vec::new();
    inputs::open(path)?
        .take(LONGEST_FILE + 1)
        .read_to_end(&mut bytes)?;
    Ok(Some(bytes).filter(|bytes| bytes.len() as u64 <= LONGEST_FILE))
}

/// What a file begins with, at most 4 KiB of it, as text. That is a look at what an output would replace, and makes it no input.
///
/// # Errors
///
/// What the operating system says.
pub fn beginning(path: &Path) -> io::Result<String> {
    let mut bytes = Vec::new();
    File::open(path)?.take(4096).read_to_end(&mut bytes)?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

/// The text of `path`, which should hold `expected`.
///
/// # Errors
/// [`TextFileError`] if it cannot be read, is empty, is longer than 16 MiB or is not UTF-8 text.
pub fn read(path: &Path, expected: &'static str) -> Result<String, TextFileError> {
    let bytes = bytes(path).map_err(|source| TextFileError::Unreadable {
        path: path.to_owned(),
        source,
    })?;
    let bytes = bytes.ok_or_else(|| TextFileError::TooLong {
        path: path.to_owned(),
        limit: LONGEST_FILE,
        expected,
    })?;
    if bytes.iter().all(u8::is_ascii_whitespace) {
        return Err(TextFileError::Empty {
            path: path.to_owned(),
            expected,
        });
    }
    if let Some((encoding, line)) = Encoding::other_than_utf8(&bytes) {
        return Err(TextFileError::Encoding {
            path: path.to_owned(),
            line,
            encoding,
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
