//! The C functions of FMI 3.0, grouped as in `fmi3Functions.h`.
//!
//! Every function takes its arguments apart with [`arguments`], lets [`call`] run the body against the instance, and
//! turns the outcome into a status. The importer's callbacks are called only when no reference to the instance is
//! alive, so that a callback may call back into the FMU.

// the names of the functions are those of the C header
#![allow(non_snake_case, reason = "the C header gives the names")]

mod arguments;
mod co_simulation;
mod common;
mod derivatives;
mod fmu_state;
mod handle;
mod lifecycle;
mod model_exchange;
mod not_provided;
mod variables;

use std::{
    ffi::{c_char, c_void},
    fmt,
    panic::{AssertUnwindSafe, catch_unwind},
};

use crate::{
    instance::Instance,
    logging::Status,
    refusal::{Active, Refusal},
};

/// `fmi3Instance`, `fmi3InstanceEnvironment`, `fmi3FMUState`.
type Opaque = *mut c_void;
/// `fmi3ValueReference`.
type ValueReference = u32;
/// `fmi3Boolean`: a C `bool`, taken as a byte so that no value of it is undefined behaviour.
type Boolean = u8;
/// `fmi3String`.
type Text = *const c_char;

/// What a function did, where that is worth a message.
enum Done {
    /// What was asked, nothing to say.
    Silently,
    /// What was asked; worth an entry in the log of events.
    Event(Event),
    /// What was asked, but with a warning.
    Warning(Active),
}

impl From<Option<Active>> for Done {
    fn from(warning: Option<Active>) -> Self {
        warning.map_or(Self::Silently, Self::Warning)
    }
}

/// An entry in the log of events.
enum Event {
    /// The simulation starts.
    Initializing { start_s: f64 },
    /// The simulation ends.
    Terminated { time_s: f64 },
    /// Back to the start values.
    Reset,
    /// An earlier state was restored.
    Restored { time_s: f64 },
}

impl fmt::Display for Event {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Initializing { start_s } => write!(f, "initialising at t = {start_s} s"),
            Self::Terminated { time_s } => write!(f, "terminated at t = {time_s} s"),
            Self::Reset => f.write_str("reset to the start values"),
            Self::Restored { time_s } => write!(f, "restored the state at t = {time_s} s"),
        }
    }
}

/// Runs `body` on the instance behind `handle`: no panic leaves, every refusal is logged, and a failed simulation ends.
///
/// # Safety
///
/// `handle` is null or was returned by an instantiating function and not freed since, and no other thread uses it.
#[inline]
unsafe fn call(
    function: &'static str,
    handle: Opaque,
    body: impl FnOnce(&mut Instance) -> Result<Done, Refusal>,
) -> Status {
    // SAFETY: the caller's promise
    let Some(handle) = (unsafe { handle::from_c(handle) }) else {
        return Status::Error;
    };
    match catch_unwind(AssertUnwindSafe(|| body(&mut handle.instance))) {
        Ok(Ok(Done::Silently)) => Status::Ok,
        outcome => conclude(function, handle, outcome.unwrap_or(Err(Refusal::Internal))),
    }
}

/// Logs what came out of a call, and ends a simulation that failed.
#[cold]
fn conclude(
    function: &'static str,
    handle: &mut handle::Handle,
    outcome: Result<Done, Refusal>,
) -> Status {
    if outcome.as_ref().is_err_and(Refusal::ends_the_simulation) {
        handle.instance.fail();
    }
    // a copy: the callback may use the instance
    let logger = handle.logger;
    match outcome {
        Ok(Done::Silently) => Status::Ok,
        Ok(Done::Event(event)) => {
            logger.event(function, &event);
            Status::Ok
        }
        Ok(Done::Warning(warning)) => {
            logger.warning(function, &warning);
            Status::Warning
        }
        Err(refusal) => {
            logger.error(function, &refusal);
            Status::Error
        }
    }
}
