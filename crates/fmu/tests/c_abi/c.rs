//! The C functions and statuses, as the headers declare them.

use std::ffi::c_int;

pub(crate) use bolted_joint_importer::header::{DISCARD, ERROR, OK, WARNING, fmi2::*, fmi3::*};

/// The call did what it was asked to, and has nothing to say.
#[track_caller]
pub(crate) fn ok(status: c_int) {
    assert_eq!(status, OK);
}

/// The message begins like this, and has this in it.
#[track_caller]
pub(crate) fn tells(message: &str, beginning: &str, part: &str) {
    let told = message.starts_with(beginning) && message.contains(part);
    assert!(told, "{message}, not {beginning}… {part}");
}
