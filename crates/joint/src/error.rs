//! Why a joint file cannot be read or written.

use std::fmt;
use std::io;
use std::path::PathBuf;

use bolted_joint_files::whole_file::advice;
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
    #[error("{}: cannot be written: {source}; {}", path.display(), advice(source))]
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
    /// The text is a list, or begins as one.
    #[error(
        "{origin}: found a list, expected an object, {{ … }}, as a joint file is (format \"{}\"); {}",
        Format::NAME,
        instead_of_list(*joint_files)
    )]
    List {
        /// Origin.
        origin: String,
        /// How many of its entries are joint files themselves.
        joint_files: usize,
    },
    /// The text begins with the header of a table in TOML.
    #[error(
        "{origin}: found the table header {header} of TOML, expected a joint file: JSON, an object {{ … }} (format \"{}\"); \
         give the NAME.joint.json that `identify` wrote",
        Format::NAME
    )]
    TableHeader {
        /// Origin.
        origin: String,
        /// The header.
        header: String,
    },
    /// The text ends in the middle of a value.
    #[error("{at}: the file ends too early, in {}; it seems to be cut off", at.key())]
    Truncated {
        /// Where it ends.
        at: TextPlace,
    },
    /// The text is not JSON.
    #[error(
        "{at}: is not JSON: {message}, in {}; expected a joint file (format \"{}\"): mend the text there, or give the \
         NAME.joint.json that `identify` wrote",
        at.key(),
        Format::NAME
    )]
    NotJson {
        /// Where the mistake is.
        at: TextPlace,
        /// What the parser said.
        message: String,
    },
    /// A number that is not finite.
    #[error("{at}: {}: found {found}, expected a finite number", at.key())]
    NotFinite {
        /// Where the number is.
        at: TextPlace,
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
        "{at}: {}: unknown key{}; expected one of {}",
        at.path,
        nearest.as_ref().map(|key| format!(", did you mean \"{key}\"?")).unwrap_or_default(),
        known.join(", ")
    )]
    UnknownKey {
        /// Where the key is.
        at: TextPlace,
        /// The known key that it is most like.
        nearest: Option<String>,
        /// All keys known there.
        known: Vec<String>,
    },
    /// A key that must be there and is not.
    #[error("{at}: {}: not found, expected this key; add it", at.path)]
    MissingKey {
        /// The key, and where the object ends.
        at: TextPlace,
    },
    /// A key that stands in an object again.
    #[error("{at}: {}: found twice, expected this key once; take one of them out", at.path)]
    Twice {
        /// The second of the two.
        at: TextPlace,
    },
    /// A value of the wrong type.
    #[error("{at}: {}: {message}", at.key())]
    WrongType {
        /// Where the value is.
        at: TextPlace,
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

/// How to get to a joint file from a list with so many of them.
fn instead_of_list(joint_files: usize) -> &'static str {
    match joint_files {
        0 => "give the NAME.joint.json that `identify` wrote",
        1 => "take the joint file that is in it out of the brackets [ ]",
        _ => "write each of the joint files that are in it into a file of its own",
    }
}

/// A place in the text of a joint file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct TextPlace {
    /// The file's name, or what the caller calls the text.
    pub origin: String,
    /// Line, from 1.
    pub line: usize,
    /// Column, from 1.
    pub column: usize,
    /// Path of the key.
    pub path: String,
}

impl TextPlace {
    fn key(&self) -> &str {
        place(&self.path)
    }
}

impl fmt::Display for TextPlace {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}:{}", self.origin, self.line, self.column)
    }
}

/// The parser's path of a key, in words where it is the whole file.
fn place(path: &str) -> &str {
    match path {
        "." => "the file as a whole",
        // where the parser does not know either
        "?" => "its last value",
        path => path,
    }
}
