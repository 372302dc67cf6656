//! Why modal data cannot be used.

use std::path::PathBuf;

use thiserror::Error;

use crate::Dof;
use bolted_joint_files::text_file::TextFileError;

/// Why modal data cannot be used.
#[derive(Debug, Error)]
pub enum ModalError {
    /// The file cannot be read.
    #[error(transparent)]
    File(#[from] TextFileError),
    /// The file is not TOML or has keys, types or shapes that do not belong.
    #[error("{}: {message}", path.display())]
    Syntax {
        /// The file.
        path: PathBuf,
        /// What is wrong, with line and column.
        message: String,
    },
    /// A list that needs one entry for each point has another length.
    #[error("{}: {key}: found {found} entries, expected {expected}, one for each of `points`", path.display())]
    Length {
        /// The file.
        path: PathBuf,
        /// The list.
        key: String,
        /// Entries found.
        found: usize,
        /// Number of points.
        expected: usize,
    },
    /// A number outside what is physical.
    #[error("{}: {key}: found {found}, expected {expected}", path.display())]
    Value {
        /// The file.
        path: PathBuf,
        /// The key.
        key: String,
        /// Value found.
        found: f64,
        /// What is allowed.
        expected: &'static str,
    },
    /// No mode or no point, or a point twice.
    #[error("{}: {found}; expected {expected}", path.display())]
    Content {
        /// The file.
        path: PathBuf,
        /// What was found.
        found: String,
        /// What was expected.
        expected: &'static str,
    },
    /// A degree of freedom that the modes do not cover.
    #[error("{}: no mode shape at {dof}; the points are {}; correct the point in the study, or add its shape", path.display(), list(present))]
    MissingPoint {
        /// The file.
        path: PathBuf,
        /// The wanted DOF.
        dof: Dof,
        /// The DOFs that are there.
        present: Vec<Dof>,
    },
}

fn list(dofs: &[Dof]) -> String {
    let names: Vec<String> = dofs.iter().map(Dof::to_string).collect();
    names.join(", ")
}
