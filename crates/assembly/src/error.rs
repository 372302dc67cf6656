//! Why an assembly cannot be read or computed.

use bolted_joint_frf::structure::StructureError;
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
    /// Friction with a table of its own, which cannot follow a preload that moves.
    #[error(
        "{path}: `joint.over_preload.friction`: found friction with a table of its own over the preload, which holds while the \
         preload stays where it is; take joint {name} at one preload, with `preload` in its table of the assembly file"
    )]
    FrictionOverPreload {
        /// The joint file.
        path: String,
        /// Name of the joint.
        name: String,
    },
    /// An undamped resonance.
    #[error(
        "the assembly has no finite receptance at {frequency_hz} Hz, an undamped resonance; leave that line out, or give the structures damping"
    )]
    Resonance {
        /// Frequency, Hz.
        frequency_hz: f64,
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
