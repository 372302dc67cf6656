//! What can be wrong with a study of a response, and with the response itself.

use thiserror::Error;

use bolted_joint_harmonic::HarmonicError;
use bolted_joint_joint::JointFileError;
use bolted_joint_study::StudyError;

/// Why a response cannot be computed.
#[derive(Debug, Error)]
pub enum RespondError {
    /// The study or a file that it names cannot be used.
    #[error(transparent)]
    Study(#[from] StudyError),
    /// A joint file cannot be used.
    #[error(transparent)]
    JointFile(#[from] JointFileError),
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
    /// A level of noise that is no fraction.
    #[error("noise level: found {0}, expected a fraction from 0 to below 1, such as 0.01 for 1 %")]
    NoiseLevel(f64),
    /// Too few samples for a line of a discrete Fourier transform.
    #[error(
        "noise samples: found {0}, expected at least 3, because a line needs more than two samples a period"
    )]
    NoiseSamples(u32),
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
