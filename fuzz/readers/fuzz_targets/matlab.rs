//! A MATLAB file: refused with a reason, or a set of functions.
#![no_main]

use std::io::Cursor;

use bolted_joint_frf::{ReadOptions, read_mat_from};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let _ = read_mat_from(Cursor::new(bytes), "bytes.mat", &ReadOptions::default())
        .and_then(|reading| reading.into_set());
});
