//! Text of a study or of modal data (TOML): refused with a reason, or read.
#![no_main]

use std::path::Path;

use bolted_joint_frf::structure::ModalModel;
use bolted_joint_identify::Study;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| {
    let _ = Study::from_toml(text, Path::new("study.toml"));
    let _ = ModalModel::from_toml(text, Path::new("modes.toml"));
});
