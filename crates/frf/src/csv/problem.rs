//! What can be wrong in a table of functions, each with what was found, what was expected and what to do.

use thiserror::Error;

use crate::{Dof, DofError, FrfError, StatementProblem};

/// What is wrong at one line of a table.
#[derive(Debug, Error)]
pub enum CsvProblem {
    /// Nothing but comments.
    #[error(
        "found no header row, expected column names such as \"frequency [Hz]\" and \"11:+Y/2:+Y real [m/N]\"; \
         write them above the numbers"
    )]
    NoHeader,
    /// A text in two bytes a character.
    #[error("found UTF-16 text, expected UTF-8; save the table as \"CSV UTF-8\"")]
    Utf16,
    /// A line too long for a table.
    #[error("found a line of more than {limit} bytes, expected a table; is this another format?")]
    LineTooLong {
        /// The longest line that is read, bytes.
        limit: usize,
    },
    /// A comment `# key = value` that is not usable.
    #[error("found {key} = \"{found}\", expected {expected}")]
    Key {
        /// The key.
        key: &'static str,
        /// Its value.
        found: String,
        /// What it may be.
        expected: &'static str,
    },
    /// The first column is not frequency in Hz.
    #[error(
        "column 1: found \"{found}\", expected \"frequency [Hz]\" as the first column's name; \
         write a header row, and frequencies in Hz"
    )]
    NotFrequency {
        /// The name.
        found: String,
    },
    /// A column's name that says nothing.
    #[error(
        "column {column}: found the name \"{found}\", expected RESPONSE/REFERENCE, one of real, imaginary, magnitude, phase and \
         coherence, and perhaps a quantity and a [unit], such as \"11:+Y/2:+Y accelerance real [m/s^2/N]\""
    )]
    ColumnName {
        /// Column, from 1.
        column: usize,
        /// The name.
        found: String,
    },
    /// A column's name with a degree of freedom that is none.
    #[error("column {column}: {source}")]
    Dof {
        /// Column, from 1.
        column: usize,
        /// What is wrong with it.
        source: DofError,
    },
    /// A phase without its unit.
    #[error(
        "column {column}: found a phase in \"{found}\", expected [deg] or [rad] after its name"
    )]
    PhaseUnit {
        /// Column, from 1.
        column: usize,
        /// The unit.
        found: String,
    },
    /// The same part of a function twice.
    #[error(
        "column {column}: found a second {part} of {response} / {reference}, expected one; remove the one that is not wanted"
    )]
    Twice {
        /// Column, from 1.
        column: usize,
        /// Which part.
        part: &'static str,
        /// Response.
        response: Dof,
        /// Reference.
        reference: Dof,
    },
    /// A function without its second part.
    #[error(
        "function {response} / {reference}: found {found}, expected columns for real and imaginary part, \
         or for magnitude and phase"
    )]
    Parts {
        /// Response.
        response: Dof,
        /// Reference.
        reference: Dof,
        /// The parts that there are.
        found: String,
    },
    /// Units or quantities of a function's two columns that differ.
    #[error(
        "function {response} / {reference}: found \"{first}\" in one column and \"{second}\" in another, expected the same in both"
    )]
    Differing {
        /// Response.
        response: Dof,
        /// Reference.
        reference: Dof,
        /// In the first column.
        first: String,
        /// In the second column.
        second: String,
    },
    /// What is stated does not say what the function is.
    #[error("{0}")]
    Statement(StatementProblem),
    /// A row with more or fewer fields than the header.
    #[error(
        "found {found} fields, expected {expected} as in the header row; \
         with decimal commas, separate the columns by semicolons"
    )]
    Fields {
        /// Fields found.
        found: usize,
        /// Fields of the header.
        expected: usize,
    },
    /// A field that is no number.
    #[error(
        "column {column}: found \"{found}\", expected a number such as 1.25e-3{}",
        if *comma_used { "; commas and points for decimals in one file are not read, nor are separators of thousands" } else { "" }
    )]
    NotANumber {
        /// Column, from 1.
        column: usize,
        /// The field.
        found: String,
        /// Whether a comma may be the reason.
        comma_used: bool,
    },
    /// A magnitude below zero.
    #[error(
        "column {column}: found magnitude {found}, expected a number that is not negative; decibels are not read"
    )]
    NegativeMagnitude {
        /// Column, from 1.
        column: usize,
        /// The magnitude.
        found: f64,
    },
    /// A function is not usable as it is.
    #[error("{0}")]
    Function(#[source] Box<FrfError>),
}
