//! The compiled part of the Python module `bolted_joint`.
//!
//! A command runs within the Python process, in threads of its own: other Python threads go on, and Ctrl-C is heard.
//! What it prints and warns of comes back as text, so that Python and the command line have the same results and words.
#![forbid(unsafe_code)]

mod command;
mod functions;
mod study_text;
mod whole_file;

use pyo3::prelude::*;

/// The compiled part of `bolted_joint`.
#[pymodule(name = "_native")]
mod native {
    #[pymodule_export]
    use super::command::{call, main};
    #[pymodule_export]
    use super::functions::read_functions;
    #[pymodule_export]
    use super::study_text::{command_of, path_keys, to_json, to_toml};
    #[pymodule_export]
    use super::whole_file::write_file;
}
