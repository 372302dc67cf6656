//! Why a structure cannot be built, read or computed.

use std::path::PathBuf;

use thiserror::Error;

use crate::{Dof, FrfError, TableProblem};
use bolted_joint_files::text_file::TextFileError;

/// Why a structure cannot be built, read or computed.
#[derive(Debug, Error)]
pub enum StructureError {
    /// A number of a beam that none has.
    #[error("beam.{key}: found {found}, expected {expected}")]
    Beam {
        /// Key of the study.
        key: &'static str,
        /// What was found.
        found: String,
        /// What was expected.
        expected: &'static str,
    },
    /// A point that is not on the beam.
    #[error("point at {position_m} m: expected a position on the beam, from 0 to {length_m} m")]
    OffTheBeam {
        /// Position, m.
        position_m: f64,
        /// Length of the beam, m.
        length_m: f64,
    },
    /// The finite-element matrices have no modes.
    #[error("the beam has no modes ({0}); check its dimensions")]
    NoModes(Box<StructureError>),
    /// The three matrices are not square and of one size.
    #[error(
        "mass is {mass:?}, damping {damping:?} and stiffness {stiffness:?} (rows, columns); \
         expected three square matrices of one size"
    )]
    Shapes {
        /// Shape of the mass matrix.
        mass: (usize, usize),
        /// Shape of the damping matrix.
        damping: (usize, usize),
        /// Shape of the stiffness matrix.
        stiffness: (usize, usize),
    },
    /// The mass matrix is not positive definite.
    #[error(
        "the mass matrix is not positive definite; expected a mass or an inertia on every degree of freedom"
    )]
    Mass,
    /// The receptance has no value: an undamped resonance, or 0 Hz where a body is free.
    #[error("{what} at {frequency_hz} Hz, {reason}; {advice}")]
    Resonance {
        /// What there is not.
        what: &'static str,
        /// Frequency, Hz.
        frequency_hz: f64,
        /// Why.
        reason: &'static str,
        /// What helps.
        advice: &'static str,
    },
    /// The file with modes cannot be read.
    #[error(transparent)]
    File(#[from] TextFileError),
    /// It is not TOML or has keys or types that do not belong.
    #[error("{}: {message}", path.display())]
    Syntax {
        /// The file.
        path: PathBuf,
        /// What is wrong, with line and column.
        message: String,
    },
    /// A file of arrays whose matrices cannot be used.
    #[error("{}: {problem}", path.display())]
    Arrays {
        /// The file.
        path: PathBuf,
        /// What is wrong with them.
        problem: Box<TableProblem>,
    },
    /// Modes of a universal file that cannot be read.
    #[error(transparent)]
    Universal(#[from] Box<FrfError>),
    /// Modes that are not complete, or not physical.
    #[error("{}: {found}, expected {expected}", path.display())]
    Modes {
        /// The file.
        path: PathBuf,
        /// The key, and what was found there.
        found: String,
        /// What was expected.
        expected: String,
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
