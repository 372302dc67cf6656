//! The C functions of FMI 3.0, grouped as in `fmi3Functions.h`.
//!
//! How they work is told in [`crate::abi`].

// the names of the functions are those of the C header
#![allow(non_snake_case, reason = "the C header gives the names")]

mod co_simulation;
mod common;
mod derivatives;
mod events;
mod fmu_state;
mod lifecycle;
mod model_exchange;
mod not_provided;
mod variables;

// the functions name these as their own
use crate::{
    abi::handle::{Boolean, IntermediateUpdate, IntermediateUpdateCallback},
    abi::{Done, Event, Function, Opaque, Text, ValueReference, arguments},
    instance::Instance,
    logging::Status,
    refusal::Refusal,
    version::Abi,
};

/// A function of FMI 3.0.
const fn function(name: &'static str) -> Function {
    Function {
        abi: Abi::Fmi3,
        name,
        discards: false,
    }
}

/// Runs `body` on the instance behind `handle`.
///
/// # Safety
///
/// As for [`crate::abi::call`].
#[inline]
unsafe fn call(
    name: &'static str,
    handle: Opaque,
    body: impl FnOnce(&mut Instance) -> Result<Done, Refusal>,
) -> Status {
    // SAFETY: the caller's promise
    unsafe { crate::abi::call(function(name), handle, body) }
}

/// Runs `body` on the instance behind `handle`, also within a communication step.
///
/// # Safety
///
/// As for [`crate::abi::call`].
#[inline]
unsafe fn call_inside(
    name: &'static str,
    handle: Opaque,
    body: impl FnOnce(&mut Instance) -> Result<Done, Refusal>,
) -> Status {
    // SAFETY: the caller's promise
    unsafe { crate::abi::call_inside(function(name), handle, body) }
}
