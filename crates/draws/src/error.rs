//! What can be wrong with the files of draws, alone and together.

use std::fmt;
use std::ops::Range;
use std::path::PathBuf;

use thiserror::Error;

use bolted_joint_files::TextFileError;

use super::file::FORMAT;

/// Numbers of draws, as the command line takes them: `0..1000` is a thousand.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Numbers(pub Range<u64>);

impl fmt::Display for Numbers {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}..{}", self.0.start, self.0.end)
    }
}

/// Why draws cannot be written, read or put together.
#[derive(Debug, Error)]
pub enum DrawsError {
    /// The file cannot be read as text.
    #[error(transparent)]
    File(#[from] TextFileError),
    /// It is no file of draws.
    #[error("{}: {message}; expected a file of draws, as `identify` and `predict` write it with --draws", path.display())]
    Syntax {
        /// The file.
        path: PathBuf,
        /// What the parser says, with line and column.
        message: String,
    },
    /// A version of the format that is not known.
    #[error("{}: found format {found:?}, expected {FORMAT:?}; make the draws with this version of the program", path.display())]
    Format {
        /// The file.
        path: PathBuf,
        /// Its format.
        found: String,
    },
    /// Numbers and draws that do not fit.
    #[error("{}: found {found}, expected {expected}; the file is damaged: make its draws anew", path.display())]
    Damaged {
        /// The file.
        path: PathBuf,
        /// What was found.
        found: String,
        /// What was expected.
        expected: String,
    },
    /// Draws that were made from something else.
    #[error("{}: found draws with {what} {found}, expected {expected} as {reference}; make all draws from one study, by one version", path.display())]
    Other {
        /// The file.
        path: PathBuf,
        /// What differs.
        what: String,
        /// How it is there.
        found: String,
        /// How it should be.
        expected: String,
        /// What has it so.
        reference: String,
    },
    /// Draws that are in two files.
    #[error("{}: found the draws {numbers}, which {} has as well; give each draw once", path.display(), other.display())]
    Overlap {
        /// The file.
        path: PathBuf,
        /// The other file.
        other: PathBuf,
        /// The draws that both have.
        numbers: Numbers,
    },
    /// No file at all.
    #[error("found no file of draws, expected at least one")]
    Nothing,
    /// Draws that are in no file.
    #[error(
        "found no file with the draws {}, expected all of {all}; make them with --draws",
        list(missing)
    )]
    Missing {
        /// The draws.
        missing: Vec<Numbers>,
        /// All that there should be.
        all: Numbers,
    },
    /// A number that cannot be written.
    #[error("draw {number} gave {value}, expected finite numbers")]
    NotFinite {
        /// The draw.
        number: u64,
        /// What it gave.
        value: f64,
    },
    /// More than a file of draws may hold.
    #[error(
        "{numbers} are {bytes} bytes, expected at most {limit}; make the draws in smaller parts"
    )]
    TooLong {
        /// The draws.
        numbers: Numbers,
        /// What they would take.
        bytes: u64,
        /// The longest file that is read.
        limit: u64,
    },
    /// The draws of a joint that cannot be written as a file.
    #[error("the joint cannot be written as JSON: {0}")]
    Json(#[from] serde_json::Error),
}

fn list(numbers: &[Numbers]) -> String {
    let numbers: Vec<String> = numbers.iter().map(Numbers::to_string).collect();
    numbers.join(", ")
}
