//! Bytes for `fmi2DeSerializeFMUstate` and `fmi3DeserializeFMUState`, with a checksum that is right.
//!
//! The first byte picks the model and the version; the others replace the content of a true state from its end on, so
//! that short inputs change the values, and long ones the head.
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
    if let Some((&pick, content)) = bytes.split_first() {
        calls::go_on_from_forged_bytes(pick, content);
    }
});
