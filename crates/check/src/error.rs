//! Why a file cannot be looked into as an FMU, or run.

use std::path::PathBuf;

use thiserror::Error;

use bolted_joint_joint::JointFileError;

/// Why a file cannot be looked into as an FMU, or run.
#[derive(Debug, Error)]
pub enum CheckError {
    /// The file cannot be read.
    #[error("{}: cannot be read ({source}); give the path of a joint file or an FMU", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// What the operating system says.
        source: std::io::Error,
    },
    /// The file is no zip archive, or a damaged one.
    #[error("{}: found no readable zip archive ({source}), expected an FMU; copy or export it again", path.display())]
    Archive {
        /// The file.
        path: PathBuf,
        /// What the archive reader says.
        source: zip::result::ZipError,
    },
    /// A file that belongs into the FMU is missing or no text.
    #[error("{}: `{entry}` is missing or no text; expected an FMU that `bolted-joint export` wrote; export it again", path.display())]
    Entry {
        /// The FMU.
        path: PathBuf,
        /// Path within it.
        entry: &'static str,
    },
    /// A system of FMUs does not say what is in it.
    #[error("{}: `{entry}` is missing or cannot be read, expected a system of FMUs (SSP 1.0); export it again", path.display())]
    Structure {
        /// The system.
        path: PathBuf,
        /// Path within it.
        entry: &'static str,
    },
    /// The FMU is of another tool.
    #[error(
        "{}: found an FMU of another tool (it says \"{tool}\"), expected one that `bolted-joint export` wrote; `bolted-joint show` \
         tells what it is, and FMPy's `fmpy validate` looks for faults in any FMU",
        path.display()
    )]
    Foreign {
        /// The FMU.
        path: PathBuf,
        /// The tool that it names.
        tool: String,
    },
    /// The joint file within the FMU is not valid.
    #[error("{}: {source}", path.display())]
    JointFile {
        /// The FMU.
        path: PathBuf,
        /// What is wrong with it.
        source: Box<JointFileError>,
    },
    /// The child process or its files cannot be made.
    #[error(
        "the FMU cannot be unpacked and run in a temporary folder: {0}; set TMPDIR to a folder with room, or leave the run out with --no-run"
    )]
    System(#[from] std::io::Error),
}
