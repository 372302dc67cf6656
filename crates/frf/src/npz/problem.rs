//! What can be wrong in a NumPy archive of functions, each with what was found, what was expected and what to do.

use thiserror::Error;

use crate::{DofError, FrfError, StatementProblem};

/// What is wrong with an archive.
#[derive(Debug, Error)]
pub enum NpzProblem {
    /// No zip archive, or a broken one.
    #[error(
        "found a broken archive ({reason}), expected a file of numpy.savez; save or copy it again"
    )]
    Archive {
        /// What is wrong with it.
        reason: String,
    },
    /// A single array.
    #[error(
        "found one NumPy array (.npy), expected an archive (.npz) that has its frequencies and names too; \
         save it with numpy.savez(file, frequency=…, frf=…, response=…, reference=…)"
    )]
    SingleArray,
    /// An array that is needed is not there.
    #[error(
        "found the arrays {there}, expected {wanted}; \
         save them with numpy.savez(file, frequency=…, frf=…, response=…, reference=…)"
    )]
    Missing {
        /// What is needed.
        wanted: &'static str,
        /// Names of the arrays that are there.
        there: String,
    },
    /// Two arrays that could be meant.
    #[error(
        "found both {first} and {second}, expected one of them; save only the one that is meant"
    )]
    TwoOfAKind {
        /// One array.
        first: String,
        /// The other.
        second: String,
    },
    /// More functions than a measurement has.
    #[error(
        "found the names of {responses} responses and {references} references, expected at most {limit} functions between them; \
         save only those that are needed"
    )]
    TooMany {
        /// Responses.
        responses: usize,
        /// References.
        references: usize,
        /// The most functions that are read.
        limit: usize,
    },
    /// An array whose header cannot be read.
    #[error("array {array}: found {found}, expected {expected}; save it again with numpy.savez")]
    Header {
        /// The array.
        array: String,
        /// What stands in its header.
        found: String,
        /// What should.
        expected: &'static str,
    },
    /// An array whose type is not usable.
    #[error(
        "array {array}: found type \"{found}\", expected {expected}; convert it with astype before saving"
    )]
    Type {
        /// The array.
        array: String,
        /// NumPy's name of the type.
        found: String,
        /// What is usable.
        expected: &'static str,
    },
    /// An array that has more or less bytes than its header says.
    #[error(
        "array {array}: found {found} bytes, expected {expected} by its header; the file is cut short or damaged, save it again"
    )]
    Length {
        /// The array.
        array: String,
        /// Bytes of the member, or of what could be read of it.
        found: u64,
        /// Bytes by the header.
        expected: u64,
    },
    /// An array whose shape does not fit the others.
    #[error("array {array}: found shape {found}, expected {expected}")]
    Shape {
        /// The array.
        array: String,
        /// Its shape.
        found: String,
        /// What fits.
        expected: String,
    },
    /// A shape that can be read in two ways.
    #[error(
        "array {array}: found shape {found}, which is either ({first}) or ({second}); expected one reading. \
         Add the order of its axes when saving, such as axes=\"{first}\""
    )]
    Ambiguous {
        /// The array.
        array: String,
        /// Its shape.
        found: String,
        /// One way to read it.
        first: String,
        /// Another.
        second: String,
    },
    /// Axes that are not named as they must be.
    #[error(
        "array axes: found \"{found}\", expected the words response, reference and frequency, each once, in the order of the \
         matrix's axes, such as \"frequency,response,reference\""
    )]
    Axes {
        /// The text.
        found: String,
    },
    /// A name that is no degree of freedom.
    #[error("array {array}, entry {entry}: {source}")]
    Dof {
        /// The array.
        array: String,
        /// Entry, from 1.
        entry: usize,
        /// What is wrong with it.
        source: DofError,
    },
    /// The same name twice.
    #[error("array {array}: found \"{found}\" twice, expected every degree of freedom once")]
    Twice {
        /// The array.
        array: String,
        /// The name.
        found: String,
    },
    /// A value that is not usable.
    #[error("array {array}: found {found}, expected {expected}")]
    Value {
        /// The array.
        array: String,
        /// The value.
        found: String,
        /// What it may be.
        expected: &'static str,
    },
    /// What is stated does not say what the functions are.
    #[error("{0}")]
    Statement(StatementProblem),
    /// The functions are not usable as they are.
    #[error("{0}")]
    Function(#[source] Box<FrfError>),
}
