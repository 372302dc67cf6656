//! Is an FMU of this program what it should be: do its parts agree, does its library run, and is the energy balanced?
//!
//! [`inspect`] reads the archive and runs nothing. [`run`] unpacks it and steps the library for this platform, in a child
//! process, because a library that fails must not take the report with it. [`unpack_system`] does the former for a system of FMUs.
#![forbid(unsafe_code)]

mod archive;
mod assembly;
mod attributes;
mod described;
mod error;
mod foreign;
mod inspect;
mod parts;
mod reference;
mod run;
mod system;
mod variables;

pub use assembly::{AssemblyInspection, inspect_assembly};
pub use error::CheckError;
pub use foreign::{ForeignFmu, foreign};
pub use inspect::{Inspection, inspect};
pub use run::{BalanceReport, RunReport, RunVerdict, Runner, execute_script, run, run_assembly};
pub use system::{SystemInspection, UnpackedFmu, UnpackedSystem, inspect_system, unpack_system};
