//! Drives the library through the C functions that an importer sees, declared here as in the FMI 3.0 headers.

#![allow(
    clippy::unwrap_used,
    clippy::panic,
    reason = "a test that cannot go on has failed"
)]

// the functions come from the library's symbols
extern crate bolted_joint as _;

mod c;
mod derivatives;
mod early_return;
mod equations;
mod escape;
mod events;
mod fmi2;
mod fmu_state;
mod higher_terms;
mod importer;
mod input_derivatives;
mod instantiation;
mod intermediate_update;
mod logging;
mod model_exchange;
mod not_provided;
mod output_derivatives;
mod own_folder;
mod parameters;
mod random_calls;
mod short_way;
mod softening;
mod start_file;
mod state_machine;
mod step_ends;
mod stepping;
mod variables;
