//! Why a joint file cannot be read or written.

use std::io;
use std::path::PathBuf;

use thiserror::Error;

use super::{Format, JointProblem};

/// Why a joint file cannot be read or written.
///
/// `origin` is the file's name, or what the caller calls the text. Lines and columns count from 1.
#[derive(Debug, Error)]
pub enum JointFileError {
    /// The file cannot be read.
    #[error("{}: cannot be read: {source}; give the path of a joint file (NAME.joint.json)", path.display())]
    Unreadable {
        /// Path of the file.
        path: PathBuf,
        /// What the operating system said.
        source: io::Error,
    },
    /// The file cannot be written.
    #[error("{}: cannot be written: {source}; give a path in a folder that exists and may be written to", path.display())]
    Unwritable {
        /// Path of the file.
        path: PathBuf,
        /// What the operating system said.
        source: io::Error,
    },
    /// There is nothing in the file.
    #[error(
        "{origin}: found an empty file, expected a joint file (format \"{}\")",
        Format::NAME
    )]
    Empty {
        /// Origin.
        origin: String,
    },
    /// There is more in the file than a joint file holds.
    #[error(
        "{origin}: found more than {limit} bytes, expected a joint file (format \"{}\"); check the path",
        Format::NAME
    )]
    TooLong {
        /// Origin.
        origin: String,
        /// The longest file that is read, bytes.
        limit: u64,
    },
    /// The file is not text.
    #[error(
        "{origin}: found {found}, expected a joint file: JSON text in UTF-8 (format \"{}\")",
        Format::NAME
    )]
    Binary {
        /// Origin.
        origin: String,
        /// What it looks like.
        found: &'static str,
    },
    /// The text ends in the middle of a value.
    #[error(
        "{origin}:{line}:{column}: the file ends too early, in {}; it seems to be cut off",
        place(path)
    )]
    Truncated {
        /// Origin.
        origin: String,
        /// Last line.
        line: usize,
        /// Column of the end.
        column: usize,
        /// Key in which the text ends.
        path: String,
    },
    /// The text is not JSON.
    #[error(
        "{origin}:{line}:{column}: is not JSON: {message}, in {}; expected a joint file (format \"{}\"): mend the text \
         there, or give the NAME.joint.json that `identify` wrote",
        place(path),
        Format::NAME
    )]
    NotJson {
        /// Origin.
        origin: String,
        /// Line of the mistake.
        line: usize,
        /// Column of the mistake.
        column: usize,
        /// Key that was being read.
        path: String,
        /// What the parser said.
        message: String,
    },
    /// A number that is not finite.
    #[error(
        "{origin}:{line}:{column}: {}: found {found}, expected a finite number",
        place(path)
    )]
    NotFinite {
        /// Origin.
        origin: String,
        /// Line of the number.
        line: usize,
        /// Column of the number.
        column: usize,
        /// Key of the number.
        path: String,
        /// What stands there.
        found: String,
    },
    /// The file follows another version of the format.
    #[error(
        "{origin}: format: found {found}, expected \"{}\"; write the file in this version of the format",
        Format::NAME
    )]
    Version {
        /// Origin.
        origin: String,
        /// What stands there.
        found: String,
    },
    /// A key that the format does not have.
    #[error(
        "{origin}:{line}:{column}: {path}: unknown key{}; expected one of {}",
        nearest.as_ref().map(|key| format!(", did you mean \"{key}\"?")).unwrap_or_default(),
        known.join(", ")
    )]
    UnknownKey {
        /// Origin.
        origin: String,
        /// Line of the key.
        line: usize,
        /// Column of the key.
        column: usize,
        /// Path of the key.
        path: String,
        /// The known key that it is most like.
        nearest: Option<String>,
        /// All keys known there.
        known: Vec<String>,
    },
    /// A key that must be there and is not.
    #[error("{origin}:{line}:{column}: {path}: not found, expected this key; add it")]
    MissingKey {
        /// Origin.
        origin: String,
        /// Line where the object ends.
        line: usize,
        /// Column where the object ends.
        column: usize,
        /// Path of the key.
        path: String,
    },
    /// A value of the wrong type.
    #[error("{origin}:{line}:{column}: {}: {message}", place(path))]
    WrongType {
        /// Origin.
        origin: String,
        /// Line of the value.
        line: usize,
        /// Column of the value.
        column: usize,
        /// Path of the key.
        path: String,
        /// What was found and what was expected.
        message: String,
    },
    /// A list where an object with keys belongs.
    #[error(
        "{origin}: {}: found a list, expected an object with keys",
        place(path)
    )]
    NotAnObject {
        /// Origin.
        origin: String,
        /// Path of the list.
        path: String,
    },
    /// The file is well formed, but its contents do not fit together.
    #[error("{origin}: {}", JointProblem::list(problems))]
    Invalid {
        /// Origin.
        origin: String,
        /// Everything that is wrong, at least one.
        problems: Vec<JointProblem>,
    },
}

/// The parser's path of a key, in words where it is the whole file.
fn place(path: &str) -> &str {
    match path {
        "." => "the file as a whole",
        path => path,
    }
}
