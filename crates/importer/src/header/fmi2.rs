//! FMI 2.0: `fmi2TypesPlatform.h`, `fmi2FunctionTypes.h` and `fmi2Functions.h`.

use std::{
    ffi::{c_int, c_void},
    mem,
};

use super::{Opaque, Reference, StatusCode, Text, declare};

/// `fmi2Boolean`: any other number than zero is true.
pub type Boolean = c_int;

/// `fmi2ModelExchange` of `fmi2Type`.
pub const MODEL_EXCHANGE: c_int = 0;
/// `fmi2CoSimulation` of `fmi2Type`.
pub const CO_SIMULATION: c_int = 1;

/// `fmi2DoStepStatus` of `fmi2StatusKind`.
pub const DO_STEP_STATUS: c_int = 0;
/// `fmi2PendingStatus` of `fmi2StatusKind`.
pub const PENDING_STATUS: c_int = 1;
/// `fmi2LastSuccessfulTime` of `fmi2StatusKind`.
pub const LAST_SUCCESSFUL_TIME: c_int = 2;
/// `fmi2Terminated` of `fmi2StatusKind`.
pub const TERMINATED: c_int = 3;

/// `fmi2CallbackLogger`: environment, instance name, status, category, and a message that is a format of `printf`.
pub type CallbackLogger = unsafe extern "C" fn(Opaque, Text, StatusCode, Text, Text, ...);

/// A callback for messages that takes the first of the further arguments as a pointer, and no more.
pub type FixedLogger = unsafe extern "C" fn(Opaque, Text, StatusCode, Text, Text, Text);

/// The callback in the type that the standard gives it: Rust has no stable way to define a function with further arguments.
///
/// A function with fixed arguments can stand in for a variadic one where both take their arguments from the same places, as
/// on all platforms with binaries in an FMU but Apple's ARM: there the last argument is none.
#[must_use]
pub fn variadic(logger: FixedLogger) -> CallbackLogger {
    // SAFETY: the arguments before the dots are handed over as if there were no dots
    unsafe { mem::transmute::<FixedLogger, CallbackLogger>(logger) }
}

/// `fmi2CallbackFunctions`.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct CallbackFunctions {
    /// Takes messages.
    pub logger: Option<CallbackLogger>,
    /// Allocates zeroed memory.
    pub allocate_memory: Option<unsafe extern "C" fn(usize, usize) -> *mut c_void>,
    /// Frees what was allocated so.
    pub free_memory: Option<unsafe extern "C" fn(*mut c_void)>,
    /// Takes the end of an asynchronous step.
    pub step_finished: Option<unsafe extern "C" fn(Opaque, StatusCode)>,
    /// Handed back to the logger and to the end of a step.
    pub environment: Opaque,
}

/// `fmi2EventInfo`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct EventInfo {
    /// Whether discrete states have to be updated once more.
    pub new_discrete_states_needed: Boolean,
    /// Whether the simulation shall end.
    pub terminate_simulation: Boolean,
    /// Whether typical magnitudes have changed.
    pub nominals_of_continuous_states_changed: Boolean,
    /// Whether states have jumped.
    pub values_of_continuous_states_changed: Boolean,
    /// Whether the time of the next event is known.
    pub next_event_time_defined: Boolean,
    /// That time.
    pub next_event_time: f64,
}

declare! {
    fmi2GetTypesPlatform() -> Text;
    fmi2GetVersion() -> Text;
    fmi2SetDebugLogging(Opaque, Boolean, usize, *const Text) -> StatusCode;
    fmi2Instantiate(Text, c_int, Text, Text, *const CallbackFunctions, Boolean, Boolean) -> Opaque;
    fmi2FreeInstance(Opaque);
    fmi2SetupExperiment(Opaque, Boolean, f64, f64, Boolean, f64) -> StatusCode;
    fmi2EnterInitializationMode(Opaque) -> StatusCode;
    fmi2ExitInitializationMode(Opaque) -> StatusCode;
    fmi2Terminate(Opaque) -> StatusCode;
    fmi2Reset(Opaque) -> StatusCode;

    fmi2GetReal(Opaque, *const Reference, usize, *mut f64) -> StatusCode;
    fmi2GetInteger(Opaque, *const Reference, usize, *mut c_int) -> StatusCode;
    fmi2GetBoolean(Opaque, *const Reference, usize, *mut Boolean) -> StatusCode;
    fmi2GetString(Opaque, *const Reference, usize, *mut Text) -> StatusCode;
    fmi2SetReal(Opaque, *const Reference, usize, *const f64) -> StatusCode;
    fmi2SetInteger(Opaque, *const Reference, usize, *const c_int) -> StatusCode;
    fmi2SetBoolean(Opaque, *const Reference, usize, *const Boolean) -> StatusCode;
    fmi2SetString(Opaque, *const Reference, usize, *const Text) -> StatusCode;

    fmi2GetFMUstate(Opaque, *mut Opaque) -> StatusCode;
    fmi2SetFMUstate(Opaque, Opaque) -> StatusCode;
    fmi2FreeFMUstate(Opaque, *mut Opaque) -> StatusCode;
    fmi2SerializedFMUstateSize(Opaque, Opaque, *mut usize) -> StatusCode;
    fmi2SerializeFMUstate(Opaque, Opaque, *mut u8, usize) -> StatusCode;
    fmi2DeSerializeFMUstate(Opaque, *const u8, usize, *mut Opaque) -> StatusCode;
    fmi2GetDirectionalDerivative(
        Opaque, *const Reference, usize, *const Reference, usize, *const f64, *mut f64,
    ) -> StatusCode;

    fmi2EnterEventMode(Opaque) -> StatusCode;
    fmi2NewDiscreteStates(Opaque, *mut EventInfo) -> StatusCode;
    fmi2EnterContinuousTimeMode(Opaque) -> StatusCode;
    fmi2CompletedIntegratorStep(Opaque, Boolean, *mut Boolean, *mut Boolean) -> StatusCode;
    fmi2SetTime(Opaque, f64) -> StatusCode;
    fmi2SetContinuousStates(Opaque, *const f64, usize) -> StatusCode;
    fmi2GetDerivatives(Opaque, *mut f64, usize) -> StatusCode;
    fmi2GetEventIndicators(Opaque, *mut f64, usize) -> StatusCode;
    fmi2GetContinuousStates(Opaque, *mut f64, usize) -> StatusCode;
    fmi2GetNominalsOfContinuousStates(Opaque, *mut f64, usize) -> StatusCode;

    fmi2SetRealInputDerivatives(Opaque, *const Reference, usize, *const c_int, *const f64) -> StatusCode;
    fmi2GetRealOutputDerivatives(Opaque, *const Reference, usize, *const c_int, *mut f64) -> StatusCode;
    fmi2DoStep(Opaque, f64, f64, Boolean) -> StatusCode;
    fmi2CancelStep(Opaque) -> StatusCode;
    fmi2GetStatus(Opaque, c_int, *mut c_int) -> StatusCode;
    fmi2GetRealStatus(Opaque, c_int, *mut f64) -> StatusCode;
    fmi2GetIntegerStatus(Opaque, c_int, *mut c_int) -> StatusCode;
    fmi2GetBooleanStatus(Opaque, c_int, *mut Boolean) -> StatusCode;
    fmi2GetStringStatus(Opaque, c_int, *mut Text) -> StatusCode;
}
