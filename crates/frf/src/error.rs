//! What can be wrong with frequency response functions and the files that hold them.

use std::io;
use std::path::PathBuf;

use bolted_joint_files::whole_file::advice;
use num_complex::Complex64;
use thiserror::Error;

use super::{Dof, TableProblem, UffProblem};

/// How many pairs an error message lists before it only counts.
const LISTED_PAIRS: usize = 12;

/// Why functions, sets of functions or their files cannot be used.
///
/// Lines of a function count from 1. A pair is (response, reference).
#[derive(Debug, Error)]
pub enum FrfError {
    /// A function has more or fewer values than frequencies.
    #[error(
        "function {response} / {reference}: found {values} values for {frequencies} frequencies, \
         expected one value for each"
    )]
    LengthsDiffer {
        /// Response.
        response: Dof,
        /// Reference.
        reference: Dof,
        /// Number of frequencies.
        frequencies: usize,
        /// Number of values.
        values: usize,
    },
    /// A function without lines, or without lines other than 0 Hz where that line cannot be converted.
    #[error(
        "function {response} / {reference}: found no usable line, expected at least one \
         (a line at 0 Hz of a mobility or accelerance is not usable)"
    )]
    NoLines {
        /// Response.
        response: Dof,
        /// Reference.
        reference: Dof,
    },
    /// A frequency that is negative or not finite.
    #[error(
        "function {response} / {reference}, line {line}: found frequency {found_hz} Hz, \
         expected a finite number that is not negative"
    )]
    FrequencyNotAllowed {
        /// Response.
        response: Dof,
        /// Reference.
        reference: Dof,
        /// Line of the function.
        line: usize,
        /// The frequency, Hz.
        found_hz: f64,
    },
    /// A frequency that is not above the one before it.
    #[error(
        "function {response} / {reference}, line {line}: found frequency {found_hz} Hz after {previous_hz} Hz, \
         expected strictly increasing frequencies; sort the lines and remove repeated ones"
    )]
    FrequencyNotIncreasing {
        /// Response.
        response: Dof,
        /// Reference.
        reference: Dof,
        /// Line of the function.
        line: usize,
        /// The frequency before, Hz.
        previous_hz: f64,
        /// The frequency, Hz.
        found_hz: f64,
    },
    /// A value that is infinite or not a number.
    #[error(
        "function {response} / {reference}, line {line} ({frequency_hz} Hz): found value {found}, \
         expected a finite number; remove the line from the measurement"
    )]
    ValueNotFinite {
        /// Response.
        response: Dof,
        /// Reference.
        reference: Dof,
        /// Line of the function.
        line: usize,
        /// Frequency of the line, Hz.
        frequency_hz: f64,
        /// The value.
        found: Complex64,
    },
    /// A set without functions.
    #[error("found no frequency response function, expected at least one")]
    NoFunctions,
    /// A file with functions, but none that was asked for.
    #[error(
        "found no function between {}; there are (response / reference) {}; correct the labels in the study, or name another file",
        asked_for(wanted),
        list(present)
    )]
    NoneSelected {
        /// What was asked for, where that is known.
        wanted: Vec<Dof>,
        /// Every pair that is there, sorted.
        present: Vec<(Dof, Dof)>,
    },
    /// Two functions of one set are given at different frequencies.
    #[error(
        "functions {} and {} have different frequencies: line {line} is at {first_hz} Hz in the first and {second_hz} Hz \
         in the second; expected one axis for all, so export them with the same analyser settings",
        pair(first),
        pair(second)
    )]
    DifferingFrequencyAxes {
        /// The first function of the set.
        first: (Dof, Dof),
        /// The function that differs.
        second: (Dof, Dof),
        /// The first line that differs.
        line: usize,
        /// Frequency of that line in the first function, Hz.
        first_hz: f64,
        /// Frequency of that line in the second function, Hz.
        second_hz: f64,
    },
    /// Two functions of one set have the same frequencies, but one goes on where the other ends.
    #[error(
        "functions {} and {} have different frequencies: the first has {first_lines} lines and the second {second_lines}; \
         expected one axis for all, so export them with the same analyser settings",
        pair(first),
        pair(second)
    )]
    DifferingLineCounts {
        /// The first function of the set.
        first: (Dof, Dof),
        /// The function that differs.
        second: (Dof, Dof),
        /// Lines of the first function.
        first_lines: usize,
        /// Lines of the second function.
        second_lines: usize,
    },
    /// The same pair twice in one set.
    #[error(
        "found two functions from {reference} to {response}, expected one; \
         remove the one that is not wanted, or average them first"
    )]
    DuplicatePair {
        /// Response.
        response: Dof,
        /// Reference.
        reference: Dof,
    },
    /// A coherence outside 0 to 1.
    #[error(
        "coherence {response} / {reference}, line {line} ({frequency_hz} Hz): found {found}, expected a number from 0 to 1; \
         export γ² itself, neither in per cent nor in decibel, or remove the coherence"
    )]
    CoherenceNotAllowed {
        /// Response.
        response: Dof,
        /// Reference.
        reference: Dof,
        /// Line of the coherence.
        line: usize,
        /// Frequency of the line, Hz.
        frequency_hz: f64,
        /// The value.
        found: f64,
    },
    /// A coherence whose lines are not those of its function.
    #[error(
        "coherence {response} / {reference}: found no value for line {line} at {frequency_hz} Hz, expected one for every line of \
         its function; export both with the same analyser settings, or remove the coherence"
    )]
    CoherenceAxis {
        /// Response.
        response: Dof,
        /// Reference.
        reference: Dof,
        /// Line of the function.
        line: usize,
        /// Frequency of that line, Hz.
        frequency_hz: f64,
    },
    /// Two coherences of one function.
    #[error(
        "found two coherences from {reference} to {response}, expected one; remove the one that is not wanted"
    )]
    DuplicateCoherence {
        /// Response.
        response: Dof,
        /// Reference.
        reference: Dof,
    },
    /// A number of averages that cannot be.
    #[error("found {found} averages, expected a number of at least 1")]
    Averages {
        /// The number.
        found: f64,
    },
    /// A pair that was not measured, nor its transpose.
    #[error(
        "no function with response {response} and reference {reference}, nor the reverse; \
         there are (response / reference) {}; add the missing one, or use other points",
        list(present)
    )]
    MissingPair {
        /// The wanted response.
        response: Dof,
        /// The wanted reference.
        reference: Dof,
        /// Every pair that is there, sorted.
        present: Vec<(Dof, Dof)>,
    },
    /// No line lies in a frequency band.
    #[error(
        "found no line {}, expected a band with lines; the functions go from {first_hz} to {last_hz} Hz",
        band(*from_hz, *to_hz)
    )]
    EmptyBand {
        /// Lower end of the band, Hz.
        from_hz: f64,
        /// Upper end of the band, Hz.
        to_hz: f64,
        /// First frequency of the functions, Hz.
        first_hz: f64,
        /// Last frequency of the functions, Hz.
        last_hz: f64,
    },
    /// A file cannot be read.
    #[error("{}: cannot be read ({source}); check the path, in a study it is relative to the study's own folder", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// The system's error.
        source: io::Error,
    },
    /// A file cannot be written.
    #[error("{}: cannot be written: {source}; {}", path.display(), advice(source))]
    Write {
        /// The file.
        path: PathBuf,
        /// The system's error.
        source: io::Error,
    },
    /// Functions that fill no matrix are to be written as one.
    #[error(
        "found {functions} functions between {responses} responses and {references} references, expected all {} of an archive of \
         arrays; write a table (.csv) or a universal file (.uff) instead",
        responses * references
    )]
    NotRectangular {
        /// How many there are.
        functions: usize,
        /// Responses of these.
        responses: usize,
        /// References of these.
        references: usize,
    },
    /// An archive cannot be made.
    #[error(
        "the archive cannot be made: {0}; write a table (.csv) or a universal file (.uff) instead"
    )]
    Archive(#[source] io::Error),
    /// A universal file is not usable.
    #[error("{}, line {line}: {problem}", path.display())]
    Uff {
        /// The file.
        path: PathBuf,
        /// The line, from 1.
        line: usize,
        /// What is wrong there.
        #[source]
        problem: UffProblem,
    },
    /// A table of functions is not usable.
    #[error("{}, line {line}: {problem}", path.display())]
    Csv {
        /// The file.
        path: PathBuf,
        /// The line, from 1.
        line: usize,
        /// What is wrong there.
        #[source]
        problem: Box<TableProblem>,
    },
    /// A file of arrays is not usable.
    #[error("{}: {problem}", path.display())]
    Arrays {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        #[source]
        problem: Box<TableProblem>,
    },
    /// Two files of one measurement have the same function.
    #[error(
        "{}: has the function {response} / {reference}, which {} has as well; remove it from one of them, or name one file only",
        second.display(), first.display()
    )]
    InBothFiles {
        /// Response.
        response: Dof,
        /// Reference.
        reference: Dof,
        /// The file that was read before.
        first: PathBuf,
        /// The file that has it again.
        second: PathBuf,
    },
    /// Two files of one measurement state different averages.
    #[error(
        "{}: states {second} averages, and the file before it {first}; state the right number as averages in the study", path.display()
    )]
    AveragesDiffer {
        /// The second file.
        path: PathBuf,
        /// Averages of the first one.
        first: f64,
        /// Averages of the second one.
        second: f64,
    },
    /// A file that is to give coherences has none.
    #[error(
        "{}: found no coherence, expected the coherences of the functions, as columns, arrays or data sets 58 of type 6", path.display()
    )]
    NoCoherence {
        /// The file.
        path: PathBuf,
    },
    /// A file of coherences was taken for one of functions.
    #[error(
        "found coherences alone, expected functions; name the file as coherence = \"…\" beside frf"
    )]
    OnlyCoherences,
    /// A universal file without frequency response functions.
    #[error(
        "found no frequency response function but {found}, expected at least one: data sets 58 of function type 4; export the measurement \
         as these"
    )]
    OnlyOtherDatasets {
        /// What it has, in words.
        found: String,
    },
    /// The functions of a file do not make a set.
    #[error("{}: {source}", path.display())]
    InFile {
        /// The file.
        path: PathBuf,
        /// What is wrong with them.
        source: Box<FrfError>,
    },
}

impl FrfError {
    /// The same error, which says what was asked for.
    #[must_use]
    pub fn asked_for(self, dofs: &[Dof]) -> Self {
        match self {
            Self::InFile { path, source } => Self::InFile {
                path,
                source: Box::new(source.asked_for(dofs)),
            },
            Self::NoneSelected { present, .. } => Self::NoneSelected {
                wanted: dofs.to_vec(),
                present,
            },
            other => other,
        }
    }
}

/// What was asked for, in words.
fn asked_for(wanted: &[Dof]) -> String {
    let named: Vec<String> = wanted
        .iter()
        .take(LISTED_PAIRS)
        .map(Dof::to_string)
        .collect();
    match (wanted.len(), wanted.len().saturating_sub(LISTED_PAIRS)) {
        (0, _) => "the degrees of freedom that are asked for".to_owned(),
        (_, 0) => format!("those that are asked for, {}", named.join(" ")),
        (_, more) => format!(
            "those that are asked for, {} and {more} more",
            named.join(" ")
        ),
    }
}

/// A band in words; an end that leaves nothing out is not named.
fn band(from_hz: f64, to_hz: f64) -> String {
    match (from_hz > f64::MIN_POSITIVE, to_hz < f64::MAX) {
        (true, true) => format!("from {from_hz} to {to_hz} Hz"),
        (false, true) => format!("above 0 and up to {to_hz} Hz"),
        (true, false) => format!("from {from_hz} Hz on"),
        (false, false) => "above 0 Hz".to_owned(),
    }
}

fn pair(&(response, reference): &(Dof, Dof)) -> String {
    format!("{response} / {reference}")
}

fn list(pairs: &[(Dof, Dof)]) -> String {
    let shown: Vec<String> = pairs.iter().take(LISTED_PAIRS).map(pair).collect();
    match pairs.len().saturating_sub(LISTED_PAIRS) {
        0 => shown.join(", "),
        more => format!("{} and {more} more", shown.join(", ")),
    }
}
