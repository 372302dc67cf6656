//! Turns measurements of a bolted joint into an FMU that any FMI tool can run.
#![forbid(unsafe_code)]

pub mod frf;
pub mod report;
pub mod structure;
mod text_file;

pub use text_file::TextFileError;
