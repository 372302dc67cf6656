//! The shared library inside every FMU: FMI C ABIs over `bolted-joint-dynamics`.
//!
//! The library is the same for every joint, for FMI 2.0 and for FMI 3.0. What it simulates, and with which start values,
//! it reads from `resources/start.txt` of the FMU that it is instantiated for. `instance` holds all behaviour in safe
//! Rust; `functions` are the C functions of both versions, which turn C pointers and arrays into slices, and refusals into
//! statuses and log messages, by means of `abi`.

mod abi;
mod assembly_file;
mod fmu_state;
mod functions;
mod input_course;
mod instance;
mod interface;
mod library;
mod logging;
mod mode;
mod models;
mod pace;
mod preload_table;
mod processor;
mod refusal;
mod resources;
mod start_file;
mod underway;
mod values;
mod version;

pub use processor::use_all_of_it;
