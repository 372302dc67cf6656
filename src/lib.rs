//! Turns measurements of a bolted joint into an FMU that any FMI tool can run.
//!
//! The way of the data: [`frf`] and [`structure`] give receptances, [`identify`] finds the joint that couples them,
//! [`predict`] finds one from physics alone, [`joint`] is the file that holds it, [`export`] packs it into an FMU, [`check`] tries that FMU, [`report`] draws
//! what was found. [`respond`] computes what a test would measure, [`reproduce`] repeats the published case studies.
//!
//! Each of these is a crate of its own; this one gives them one name.
#![forbid(unsafe_code)]

pub use bolted_joint_check as check;
pub use bolted_joint_cosimulation as cosimulation;
pub use bolted_joint_export as export;
pub use bolted_joint_files::TextFileError;
pub use bolted_joint_frf as frf;
pub use bolted_joint_frf::structure;
pub use bolted_joint_harmonic as harmonic;
pub use bolted_joint_joint as joint;
pub use bolted_joint_predict as predict;
pub use bolted_joint_report as report;
pub use bolted_joint_reproduce as reproduce;
pub use bolted_joint_respond as respond;
pub use bolted_joint_study as study;

/// Identification of joints from functions of substructures and assembly, and of lap models from frequencies and responses.
pub mod identify {
    pub use bolted_joint_identify::*;
    pub use bolted_joint_lap as lap;
}
