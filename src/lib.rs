//! Turns measurements of a bolted joint into an FMU that any FMI tool can run.
#![forbid(unsafe_code)]

pub mod export;
pub mod frf;
pub mod identify;
pub mod joint;
pub mod structure;
mod text_file;
pub(crate) mod whole_file;

pub use text_file::TextFileError;
