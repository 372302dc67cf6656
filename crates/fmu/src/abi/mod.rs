//! What all C functions share: handles, checked arguments, and the way from a refusal to a status.
//!
//! Every C function takes its arguments apart with [`arguments`], lets [`call`] run the body against the instance, and
//! turns the outcome into a status. The importer's callbacks are called only when no reference to the instance is
//! alive, so that a callback may call back into the FMU.

pub(crate) mod arguments;
pub(crate) mod handle;
pub(crate) mod shortcut;

use std::{
    ffi::{c_char, c_void},
    fmt,
    panic::{AssertUnwindSafe, catch_unwind},
};

use crate::{
    instance::Instance,
    interface::InterfaceType,
    logging::Status,
    refusal::{Refusal, Warning},
    version::Abi,
};

/// Pointers to what the other side keeps to itself: instances, FMU states, the importer's environments.
pub(crate) type Opaque = *mut c_void;
/// `fmi2ValueReference`, `fmi3ValueReference`.
pub(crate) type ValueReference = u32;
/// `fmi2String`, `fmi3String`.
pub(crate) type Text = *const c_char;

/// A C function that works on an instance.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Function {
    /// Version that it belongs to.
    pub(crate) abi: Abi,
    /// Its name.
    pub(crate) name: &'static str,
    /// On what instances, and when.
    way: Way,
}

/// On what instances a function works, and when.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Way {
    /// The interface type that the function belongs to, if it does not belong to both.
    only: Option<InterfaceType>,
    /// Whether it is allowed within a communication step, too.
    inside: bool,
    /// Whether it evaluates the model, or sets what it is evaluated at. FMI 2.0, 2.1.3: in Model Exchange numbers that are
    /// out of bounds are then answered with `fmi2Discard`, after which the importer's solver tries a shorter step.
    evaluates: bool,
}

impl Way {
    /// On all instances, between communication steps.
    pub(crate) const PLAIN: Self = Self {
        only: None,
        inside: false,
        evaluates: false,
    };
    /// Within a communication step, too.
    pub(crate) const INSIDE: Self = Self {
        inside: true,
        ..Self::PLAIN
    };
    /// Reading and setting variables.
    pub(crate) const VALUES: Self = Self {
        evaluates: true,
        ..Self::INSIDE
    };
    /// Model Exchange alone.
    pub(crate) const EXCHANGE: Self = Self {
        only: Some(InterfaceType::ModelExchange),
        evaluates: true,
        ..Self::PLAIN
    };
    /// Co-Simulation alone.
    pub(crate) const STEPPING: Self = Self {
        only: Some(InterfaceType::CoSimulation),
        ..Self::PLAIN
    };
}

impl Function {
    /// The function of this name, which begins with `fmi2` or `fmi3`.
    pub(crate) const fn new(name: &'static str, way: Way) -> Self {
        let abi = match name.as_bytes() {
            [_, _, _, b'2', ..] => Abi::Fmi2,
            _ => Abi::Fmi3,
        };
        Self { abi, name, way }
    }

    /// Whether it answers numbers that are out of bounds with a wish for a shorter step.
    fn discards(self, instance: &Instance) -> bool {
        self.way.evaluates
            && self.abi == Abi::Fmi2
            && instance.interface_type() == InterfaceType::ModelExchange
    }
}

/// What a function did, where that is worth a message.
pub(crate) enum Done {
    /// What was asked, nothing to say.
    Silently,
    /// What was asked; worth an entry in the log of events.
    Event(Event),
    /// What was asked, but with a warning.
    Warning(Warning),
}

impl From<()> for Done {
    #[inline]
    fn from((): ()) -> Self {
        Self::Silently
    }
}

impl From<Event> for Done {
    fn from(event: Event) -> Self {
        Self::Event(event)
    }
}

impl From<Option<Warning>> for Done {
    #[inline]
    fn from(warning: Option<Warning>) -> Self {
        warning.map_or(Self::Silently, Self::Warning)
    }
}

/// An entry in the log of events.
pub(crate) enum Event {
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
pub(crate) unsafe fn call<D: Into<Done>>(
    function: Function,
    handle: Opaque,
    body: impl FnOnce(&mut Instance) -> Result<D, Refusal>,
) -> Status {
    let Way { only, inside, .. } = function.way;
    // SAFETY: the caller's promise
    let found = unsafe {
        if inside {
            handle::from_c_inside(function.abi, handle)
        } else {
            handle::from_c(function.abi, handle)
        }
    };
    let Some(found) = found else {
        // SAFETY: the caller's promise
        return unsafe { refuse_handle(function, handle) };
    };
    let outcome = guarded(|| {
        if let Some(only) = only {
            found.instance.require_type(only)?;
        }
        body(&mut found.instance)
    });
    match outcome.map(Into::into) {
        Ok(Done::Silently) => Status::Ok,
        outcome => conclude(function, found, outcome),
    }
}

/// Runs `body`; no panic leaves.
#[inline]
pub(crate) fn guarded<T>(body: impl FnOnce() -> Result<T, Refusal>) -> Result<T, Refusal> {
    catch_unwind(AssertUnwindSafe(body)).unwrap_or_else(|_| Err(Refusal::Internal))
}

/// Says of an instance why this function does not work on it: it is one of another FMI version, or within a
/// communication step.
///
/// # Safety
///
/// As for [`call`].
#[cold]
pub(crate) unsafe fn refuse_handle(function: Function, handle: Opaque) -> Status {
    let found = function.abi.other();
    // SAFETY: the caller's promise
    let refused = unsafe {
        match handle::from_c(found, handle) {
            Some(handle) => Some((handle, found)),
            None => handle::from_c_inside(Abi::Fmi3, handle).map(|handle| (handle, Abi::Fmi3)),
        }
    };
    if let Some((handle, found)) = refused {
        let refusal = if found == function.abi {
            Refusal::InsideStep
        } else {
            let expected = function.abi;
            Refusal::OtherAbi { found, expected }
        };
        let logger = handle.logger.clone();
        logger.tell(Status::Error, function.name, &refusal);
    }
    Status::Error
}

/// Logs what came out of a call, and ends a simulation that failed.
#[cold]
pub(crate) fn conclude(
    function: Function,
    handle: &mut handle::Handle,
    outcome: Result<Done, Refusal>,
) -> Status {
    if outcome.as_ref().is_err_and(Refusal::ends_the_simulation) {
        handle.instance.fail();
    }
    let solver_at_work = function.discards(&handle.instance);
    // a copy: the callback may use the instance
    let logger = handle.logger.clone();
    match outcome {
        Ok(Done::Silently) => Status::Ok,
        Ok(Done::Event(event)) => logger.tell(Status::Ok, function.name, &event),
        Ok(Done::Warning(warning)) => logger.tell(Status::Warning, function.name, &warning),
        Err(refusal) if refusal.is_discarded(solver_at_work) => {
            logger.tell(Status::Discard, function.name, &refusal)
        }
        Err(refusal) => logger.tell(Status::Error, function.name, &refusal),
    }
}
