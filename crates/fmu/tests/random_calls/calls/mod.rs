//! Random sequences of calls of the C ABI, and the rules that every answer must keep.
//!
//! One world holds a few instances and saved states. Each turn draws an instance, a function, and arguments, three
//! times out of four all right, else with something wrong in some of them. What any host may rely on is checked after
//! each call: see [`world`]. The same code runs under the test harness, from seeds, and under the fuzzer, from bytes.

mod arrays;
mod choices;
mod draws;
mod fmi2;
mod fmi3;
mod forged;
mod host;
mod lives;
mod turn;
mod world;

pub(crate) use choices::Choices;
pub(crate) use host::{MODELS, write_resources};
pub(crate) use lives::{go_on_from_forged_bytes, live_from};
pub(crate) use world::{Tally, World};

/// Names of all functions that are called.
pub(crate) fn function_names() -> impl Iterator<Item = &'static str> {
    let all = fmi2::FUNCTIONS.iter().chain(&fmi3::FUNCTIONS);
    all.map(|function| function.name)
}
