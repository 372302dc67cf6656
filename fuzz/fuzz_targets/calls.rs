//! Sequences of calls of both versions' C functions, right and wrong, as the fuzzer's bytes decide.
//!
//! The calls and what must hold after each of them are those of the test `random_calls` of crates/fmu.
#![no_main]

// the functions come from the library's symbols
extern crate bolted_joint as _;

#[path = "../../crates/fmu/tests/random_calls/calls/mod.rs"]
#[allow(dead_code, unused_imports, reason = "the test uses more of it")]
mod calls;
mod folder;
#[path = "../../crates/fmu/tests/raw/mod.rs"]
mod raw;

use libfuzzer_sys::fuzz_target;

fuzz_target!(init: folder::prepare(), |bytes: &[u8]| {
    calls::World::new(false).exhaust(calls::Choices::from_bytes(bytes));
});
