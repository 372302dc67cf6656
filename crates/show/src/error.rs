//! Why a file cannot be shown.

use std::path::PathBuf;

use bolted_joint_assembly::AssemblyError;
use bolted_joint_check::CheckError;
use bolted_joint_draws::DrawsError;
use bolted_joint_files::TextFileError;
use bolted_joint_frf::FrfError;
use bolted_joint_frf::structure::StructureError;
use bolted_joint_joint::JointFileError;
use bolted_joint_study::StudyError;
use thiserror::Error;

/// Why a file cannot be shown.
#[derive(Debug, Error)]
pub enum ShowError {
    /// Another kind of file.
    #[error(
        "{}: found {found}, expected measured functions (universal file, CSV, NPZ, MAT), a table of responses (CSV), modes, \
         matrices, a study, an assembly, a joint file, draws, an FMU or an SSP; check the path",
        path.display()
    )]
    Kind {
        /// The file.
        path: PathBuf,
        /// What it is.
        found: String,
    },
    /// No file on a disk.
    #[error("{}: found a pipe or a device, expected a file; a pipe cannot be read twice: save it as a file first", path.display())]
    Pipe {
        /// Its path.
        path: PathBuf,
    },
    /// Measured functions that cannot be read.
    #[error(transparent)]
    Functions(#[from] FrfError),
    /// Modes or matrices that cannot be read.
    #[error(transparent)]
    Structure(#[from] StructureError),
    /// A study that cannot be read.
    #[error(transparent)]
    Study(#[from] StudyError),
    /// An assembly that cannot be read.
    #[error(transparent)]
    Assembly(#[from] AssemblyError),
    /// A joint file that cannot be read.
    #[error(transparent)]
    JointFile(#[from] JointFileError),
    /// A table that cannot be read.
    #[error(transparent)]
    Table(#[from] TextFileError),
    /// Draws that cannot be read.
    #[error(transparent)]
    Draws(#[from] DrawsError),
    /// An FMU that cannot be looked into.
    #[error(transparent)]
    Fmu(#[from] CheckError),
}
