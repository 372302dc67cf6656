//! The C functions of FMI 2.0, grouped as in `fmi2Functions.h`.
//!
//! How they work is told in [`crate::abi`]. Section numbers are those of FMI 2.0.4; the tables of allowed calls are in
//! its sections 3.2.3 and 4.2.4.

// the names of the functions are those of the C header
#![allow(non_snake_case, reason = "the C header gives the names")]

mod co_simulation;
mod common;
mod derivatives;
mod fmu_state;
mod lifecycle;
mod model_exchange;
mod status;
mod variables;

use std::ffi::c_int;

// the functions name these as their own
use crate::{
    abi::{Done, Event, Function, Opaque, Text, ValueReference, arguments},
    instance::Instance,
    interface::InterfaceType,
    logging::Status,
    refusal::Refusal,
    version::Abi,
};

/// `fmi2Boolean`: any other number than zero is true.
type Boolean = c_int;
/// `fmi2Integer`.
type Integer = c_int;

/// `fmi2False`.
const FALSE: Boolean = 0;
/// `fmi2True`.
const TRUE: Boolean = 1;

/// A function of FMI 2.0.
const fn function(name: &'static str) -> Function {
    Function {
        abi: Abi::Fmi2,
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

/// Runs `body`, which evaluates the model or sets what it is evaluated at, on the instance behind `handle`.
///
/// FMI 2.0, 2.1.3: in Model Exchange numbers that are out of bounds are answered with `fmi2Discard`, after which the
/// importer's solver tries a shorter step.
///
/// # Safety
///
/// As for [`crate::abi::call`].
#[inline]
unsafe fn call_evaluating(
    name: &'static str,
    handle: Opaque,
    body: impl FnOnce(&mut Instance) -> Result<Done, Refusal>,
) -> Status {
    let function = Function {
        discards: true,
        ..function(name)
    };
    // SAFETY: the caller's promise
    unsafe { crate::abi::call(function, handle, body) }
}

/// Runs `body` on an instance of one interface type, and refuses all others.
///
/// # Safety
///
/// As for [`crate::abi::call`].
unsafe fn call_for(
    interface_type: InterfaceType,
    name: &'static str,
    handle: Opaque,
    body: impl FnOnce(&mut Instance) -> Result<Done, Refusal>,
) -> Status {
    // SAFETY: the caller's promise
    unsafe {
        call_evaluating(name, handle, |instance| {
            instance.require_type(interface_type)?;
            body(instance)
        })
    }
}
