//! Bytes as `resources/start.txt`: refused with a reason, or an FMU that can be stepped.
#![no_main]

// the functions come from the library's symbols
extern crate bolted_joint as _;

#[path = "../../crates/fmu/tests/random_calls/calls/mod.rs"]
#[allow(dead_code, unused_imports, reason = "the test uses more of it")]
mod calls;
mod folder;
#[path = "../../crates/fmu/tests/raw/mod.rs"]
mod raw;

use std::{fs, path::PathBuf, sync::OnceLock};

use libfuzzer_sys::fuzz_target;

static RESOURCES: OnceLock<PathBuf> = OnceLock::new();

fn prepare() {
    RESOURCES.get_or_init(|| {
        let folder = folder::own();
        fs::create_dir_all(&folder).expect("the folder can be made");
        folder
    });
}

fuzz_target!(init: prepare(), |bytes: &[u8]| {
    if let Some(folder) = RESOURCES.get() {
        fs::write(folder.join("start.txt"), bytes).expect("the file can be written");
        calls::live_from(folder);
    }
});
