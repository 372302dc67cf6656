//! Text of a joint file (JSON): refused with a reason, or read.
#![no_main]

use bolted_joint_joint::JointFile;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| {
    let _ = JointFile::from_json(text, "bytes.joint.json");
});
