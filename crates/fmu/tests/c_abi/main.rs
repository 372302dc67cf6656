//! Drives the library through the C functions that an importer sees, by both versions of FMI.

#![allow(
    clippy::unwrap_used,
    clippy::panic,
    reason = "a test that cannot go on has failed"
)]

// the functions come from the library's symbols
extern crate bolted_joint as _;

mod arguments;
mod assembly;
mod c;
mod calling_order;
mod derivatives;
mod early_return;
mod equations;
mod escape;
mod events;
mod higher_terms;
mod importer;
mod input_derivatives;
mod instantiation;
mod intermediate_update;
mod joints_that_remember;
mod logging;
mod model_exchange;
mod not_provided;
mod output_derivatives;
mod own_folder;
mod parameters;
mod random_calls;
#[path = "../raw/mod.rs"]
mod raw;
mod refusals;
mod resources;
mod rows;
mod saved_states;
mod short_way;
mod softening;
mod start_file;
mod step_ends;
mod stepping;
mod variables;
mod versions;
