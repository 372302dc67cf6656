//! Turns measurements of a bolted joint into an FMU that any FMI tool can run.
//!
//! The way of the data: [`frf`] and [`structure`] give receptances, [`identify`] finds the joint that couples them,
//! [`predict`] finds one from physics alone, [`joint`] is the file that holds it, [`export`] packs it into an FMU,
//! [`check`] tries that FMU, [`report`] draws what was found. [`respond`] computes what a test would measure,
//! [`reproduce`] repeats the published case studies.
//!
//! From measured functions to an FMU:
//!
//! ```
//! use std::path::Path;
//!
//! use bolted_joint::check::inspect;
//! use bolted_joint::export::{ExportOptions, FmiVersion, Interface, StepWish, Timestamp, fmu_bytes};
//! use bolted_joint::identify::{Study, identify};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! // Two beams, one by its modes and one by its dimensions, and the functions of both with the bolt between them.
//! let study = Study::read(Path::new("examples/tol-m10x16/study.toml"))?;
//! let found = identify(&study)?;
//! // The functions were made with 5.73e5 N/m (Tol, Table 5.3) and 1 % noise.
//! let k_yy = found.estimate.joint().stiffness[(0, 0)];
//! assert!((k_yy / 5.73e5 - 1.0).abs() < 0.02, "{k_yy}");
//!
//! let file = &found.joint_files()[0].1;
//! let options = ExportOptions {
//!     interface: Interface::Element,
//!     version: FmiVersion::V3,
//!     model_identifier: None,
//!     step: StepWish::Accurate,
//!     platforms: None,
//!     preload_n_m: None,
//!     extrapolate: false,
//!     allow_active: false,
//!     allow_unusable: false,
//!     date: Timestamp::from_environment()?,
//! };
//! let exported = fmu_bytes(file, &file.to_json()?, &options)?;
//! # let folder = tempfile::tempdir()?;
//! # let path = folder.path().join("joint.fmu");
//! exported.write(&path)?;
//! assert_eq!(inspect(&path)?.findings, Vec::<String>::new());
//! # Ok(())
//! # }
//! ```
//!
//! Each of these is a crate of its own; this one gives them one name.
#![forbid(unsafe_code)]

// the command line calls the crates by the names that everybody has for them
extern crate self as bolted_joint;

pub mod command_line;

pub use bolted_joint_assembly as assembly;
pub use bolted_joint_check as check;
pub use bolted_joint_compare as compare;
pub use bolted_joint_convert as convert;
pub use bolted_joint_cosimulation as cosimulation;
pub use bolted_joint_draws as draws;
pub use bolted_joint_export as export;
pub use bolted_joint_files as files;
pub use bolted_joint_files::TextFileError;
pub use bolted_joint_frf as frf;
pub use bolted_joint_frf::structure;
pub use bolted_joint_harmonic as harmonic;
pub use bolted_joint_joint as joint;
pub use bolted_joint_predict as predict;
pub use bolted_joint_report as report;
pub use bolted_joint_reproduce as reproduce;
pub use bolted_joint_respond as respond;
pub use bolted_joint_show as show;
pub use bolted_joint_study as study;

/// Identification of joints from functions of substructures and assembly, and of lap models from frequencies and responses.
pub mod identify {
    pub use bolted_joint_identify::*;
    pub use bolted_joint_lap as lap;
    pub use bolted_joint_spatial as space;
}
