//! The C functions and statuses, as the headers declare them.

pub(crate) use bolted_joint_importer::header::{DISCARD, ERROR, OK, WARNING, fmi2::*, fmi3::*};
