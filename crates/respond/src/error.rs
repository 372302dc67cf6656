//! What can be wrong with a study of a response, and with the response itself.

use std::path::PathBuf;

use thiserror::Error;

use bolted_joint_files::text_file::TextFileError;
use bolted_joint_harmonic::HarmonicError;
use bolted_joint_joint::{JointFileError, LawError, PreloadError};

/// Why a response cannot be computed.
#[derive(Debug, Error)]
pub enum RespondError {
    /// A text file cannot be read.
    #[error(transparent)]
    File(#[from] TextFileError),
    /// The study is not TOML, or has keys or types that do not belong.
    #[error("{}: {message}", path.display())]
    Syntax {
        /// The study.
        path: PathBuf,
        /// What is wrong, with line and column.
        message: String,
    },
    /// A value in the study cannot be used.
    #[error("{}: `{key}`: found {found}, expected {expected}", path.display())]
    Study {
        /// The study.
        path: PathBuf,
        /// Key in the study.
        key: String,
        /// What was found.
        found: String,
        /// What was expected.
        expected: String,
    },
    /// A joint file cannot be used.
    #[error(transparent)]
    JointFile(#[from] JointFileError),
    /// A joint file gives no lap model.
    #[error("{}: {source}", path.display())]
    Law {
        /// The joint file.
        path: PathBuf,
        /// What is missing.
        source: LawError,
    },
    /// The joint cannot be taken at the preload asked for.
    #[error("{}: {source}", path.display())]
    Preload {
        /// The joint file.
        path: PathBuf,
        /// Why not.
        source: PreloadError,
    },
    /// No periodic response is found.
    #[error("{lap}{level}: {source}")]
    Harmonic {
        /// Name of the lap.
        lap: String,
        /// At which level, if there are several.
        level: String,
        /// What the balance says.
        source: HarmonicError,
    },
    /// A lap does not settle by itself.
    #[error(
        "{}: `time.settle`: not found, expected the number of periods to wait: the lap `{lap}` has a mode that does not decay", path.display()
    )]
    Undamped {
        /// The study.
        path: PathBuf,
        /// Name of the lap.
        lap: String,
    },
    /// A time history would take too long.
    #[error(
        "{}: `{key}`: found {steps:.1e} Runge–Kutta steps, expected at most {most:.0e}; shorten it or lengthen the steps", path.display()
    )]
    TooManySteps {
        /// The study.
        path: PathBuf,
        /// Key in the study.
        key: &'static str,
        /// Steps that it asks for.
        steps: f64,
        /// Most that are taken.
        most: f64,
    },
    /// A time history leaves everything.
    #[error(
        "{lap}{level}: the motion is not finite any more at {time_s} s: a softening joint has let go, or the steps are too long; reduce \
         the load or set more `time.steps_per_period`"
    )]
    Escaped {
        /// Name of the lap.
        lap: String,
        /// At which level, if there are several.
        level: String,
        /// When.
        time_s: f64,
    },
}
