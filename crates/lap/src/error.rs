//! Why a lap model cannot be identified.

use std::path::PathBuf;

use bolted_joint_files::TextFileError;
use bolted_joint_study::StudyError;
use thiserror::Error;

/// Why a lap model cannot be identified.
#[derive(Debug, Error)]
pub enum LapError {
    /// The study or a file that it names cannot be used.
    #[error(transparent)]
    Study(#[from] StudyError),
    /// The response feeds energy into the exciter at most lines.
    #[error(
        "{}: found a phase that leads at {leading} of {lines} lines, so that the structure would feed the exciter, expected a displacement that \
         lags behind the force; the phase is probably that of another quantity than the column with the amplitude, or reversed: state \
         `sine.phase_of` as \"displacement\", \"velocity\" or \"acceleration\", or `sine.phase_sign = -1`",
        path.display()
    )]
    Leading {
        /// The file.
        path: PathBuf,
        /// Lines with a leading response.
        leading: usize,
        /// All lines.
        lines: usize,
    },
    /// Phases in radian that are degrees.
    #[error(
        "{}: found phases beyond ±2π in `phase_rad` in {beyond} of {lines} rows, up to {largest}, expected rad; they are probably degrees: \
         name the column `phase_deg`, or bring phases that run on over many turns within ±2π",
        path.display()
    )]
    Degrees {
        /// The file.
        path: PathBuf,
        /// Rows with a phase of more than a turn.
        beyond: usize,
        /// All rows.
        lines: usize,
        /// The largest phase, rad.
        largest: f64,
    },
    /// Phases in degrees that are radian.
    #[error(
        "{}: found phases from {least} to {largest} in `phase_deg` through a resonance, where they turn by most of 180, expected degrees; they \
         are probably rad: name the column `phase_rad`",
        path.display()
    )]
    Radians {
        /// The file.
        path: PathBuf,
        /// The least phase, degrees.
        least: f64,
        /// The largest phase, degrees.
        largest: f64,
    },
    /// Fewer data than unknowns.
    #[error(
        "found {lines} line(s), each with two numbers beyond its amplitude, expected more than {unknowns} unknowns need; measure more lines or levels"
    )]
    TooFewLines {
        /// Lines.
        lines: usize,
        /// Unknowns.
        unknowns: usize,
    },
    /// No start led anywhere.
    #[error(
        "no estimate was found from any start: the responses do not look like those of a lap model; check which side was driven and measured, and the frequency range"
    )]
    NoEstimate,
}

impl From<TextFileError> for LapError {
    fn from(error: TextFileError) -> Self {
        Self::Study(error.into())
    }
}
