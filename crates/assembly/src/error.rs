//! Why an assembly cannot be read or computed.

use bolted_joint_frf::structure::StructureError;
use bolted_joint_harmonic::HarmonicError;
use bolted_joint_joint::{JointFileError, LawError};
use bolted_joint_study::StudyError;
use thiserror::Error;

/// Why an assembly cannot be read or computed.
#[derive(Debug, Error)]
pub enum AssemblyError {
    /// The assembly file is not as it should be.
    #[error(transparent)]
    Study(#[from] StudyError),
    /// A structure cannot be read or computed.
    #[error("{file}: `structures.{name}`: {source}")]
    Structure {
        /// The assembly file.
        file: String,
        /// Name of the structure.
        name: String,
        /// Why.
        source: Box<StructureError>,
    },
    /// A joint file cannot be read.
    #[error(transparent)]
    JointFile(#[from] JointFileError),
    /// A joint gives no law.
    #[error("{path}: {source}")]
    Law {
        /// The joint file.
        path: String,
        /// Why.
        source: Box<LawError>,
    },
    /// An undamped resonance.
    #[error(
        "the assembly has no finite receptance at {frequency_hz} Hz, an undamped resonance; leave that line out, or give the structures damping"
    )]
    Resonance {
        /// Frequency, Hz.
        frequency_hz: f64,
    },
    /// No periodic motion was found.
    #[error(
        "harmonic balance finds no motion of the assembly near {frequency_hz} Hz; begin at a frequency farther from resonances, with \
         less load or at a smaller amplitude, or take another number of harmonics"
    )]
    NotBalanced {
        /// Frequency, Hz.
        frequency_hz: f64,
    },
    /// Steps along a curve become ever shorter.
    #[error(
        "harmonic balance follows the assembly's motion no farther than {frequency_hz} Hz, after {points} points: its steps become ever \
         shorter; take another number of harmonics, less load, or a range that ends there"
    )]
    CurveStuck {
        /// Frequency of the last motion, Hz.
        frequency_hz: f64,
        /// Motions found.
        points: usize,
    },
    /// A curve that goes on and on.
    #[error(
        "the curve of the assembly's motions has not come to its end after {points} points, the last at {frequency_hz} Hz; take fewer \
         harmonics, less load or a smaller range"
    )]
    CurveTooLong {
        /// Frequency of the last motion, Hz.
        frequency_hz: f64,
        /// Motions found.
        points: usize,
    },
    /// Harmonics that cannot be balanced.
    #[error(transparent)]
    Harmonics(#[from] HarmonicError),
    /// There is no such mode.
    #[error(
        "`response.mode`: found {mode}, expected 1 to {found}, the number of modes that oscillate"
    )]
    NoMode {
        /// The one that was asked for, from 1.
        mode: usize,
        /// How many there are.
        found: usize,
    },
    /// All joints are linear.
    #[error(
        "`response.kind`: found harmonic balance of an assembly whose joints are all linear, expected a joint with a law beside \
         stiffness and damping; take `linear` or `modes`"
    )]
    NothingNonlinear,
    /// A law whose load depends on how fast it slips.
    #[error(
        "joint {name}: found the law {law}, expected one whose load does not depend on how fast it slips; take `history`"
    )]
    Rate {
        /// Name of the joint.
        name: String,
        /// Name of the law.
        law: String,
    },
    /// Joints too stiff for the step.
    #[error(
        "the joints are so stiff at {time_s} s that 4096 parts of a step of {step_s} s are too long for them; choose a shorter `response.step`"
    )]
    TooLong {
        /// Time, s.
        time_s: f64,
        /// Step, s.
        step_s: f64,
    },
    /// A motion that grows beyond what is finite.
    #[error(
        "the motion of the assembly is no longer finite at {time_s} s: a joint or a structure feeds energy; `check` tells which joint is not passive"
    )]
    Grows {
        /// Time, s.
        time_s: f64,
    },
}
