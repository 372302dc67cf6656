//! What was taken from modes because it was not measured.

use std::path::PathBuf;

use bolted_joint_frf::Dof;

/// Receptances of a substructure that its modes supply beside measured ones. They are taken as exact.
#[derive(Clone, Debug, PartialEq)]
pub struct FromModes {
    /// The substructure's key in a study.
    pub substructure: &'static str,
    /// The file with the modes.
    pub path: PathBuf,
    /// Response and reference of each; its transpose is the same.
    pub functions: Vec<(Dof, Dof)>,
    /// √(Σ|H_modal − H|²/Σ|H|²) over the functions that were measured and have modes: how far the modes are to be trusted.
    pub deviation: Option<f64>,
}
