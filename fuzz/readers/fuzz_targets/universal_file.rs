//! A universal file, ASCII or binary: refused with a reason, or a set of functions.
#![no_main]

use bolted_joint_frf::{ReadOptions, read_uff58_from};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let _ = read_uff58_from(bytes, "bytes.uff", &ReadOptions::default())
        .and_then(|reading| reading.into_set());
});
