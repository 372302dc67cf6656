//! Equations of a bolted joint and their time integration.
//!
//! This crate is what runs inside every exported FMU: no dependencies, no I/O, no allocation in a step.
#![no_std]
#![forbid(unsafe_code)]

#[cfg(test)]
extern crate std;

mod joint;
mod lap;
mod vector;

pub use joint::{JointLaw, Motion};
pub use lap::{Body, Lap, LapLoads, LapState};
