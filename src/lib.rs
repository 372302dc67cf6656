//! Turns measurements of a bolted joint into an FMU that any FMI tool can run.
#![forbid(unsafe_code)]

pub mod export;
pub mod frf;
pub mod joint;

pub(crate) mod whole_file;
