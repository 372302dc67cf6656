//! Joints that remember their motion: what they remember is committed where a step ends, and never by a trial, so that a step
//! that is taken back leaves no trace.

mod element;
mod lap;

pub(super) use element::RememberingElement;
pub(super) use lap::RememberingLap;
