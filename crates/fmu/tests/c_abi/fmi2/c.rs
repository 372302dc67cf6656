//! The C functions and types, as `fmi2Functions.h` and `fmi2FunctionTypes.h` declare them.
#![allow(non_snake_case, reason = "the C header gives the names")]

use std::ffi::{c_char, c_int, c_void};

pub(crate) const OK: c_int = 0;
pub(crate) const WARNING: c_int = 1;
pub(crate) const DISCARD: c_int = 2;
pub(crate) const ERROR: c_int = 3;

pub(crate) const MODEL_EXCHANGE: c_int = 0;
pub(crate) const CO_SIMULATION: c_int = 1;

pub(crate) const DO_STEP_STATUS: c_int = 0;
pub(crate) const PENDING_STATUS: c_int = 1;
pub(crate) const LAST_SUCCESSFUL_TIME: c_int = 2;
pub(crate) const TERMINATED: c_int = 3;

pub(crate) type Logger =
    unsafe extern "C" fn(*mut c_void, *const c_char, c_int, *const c_char, *const c_char, ...);

/// `fmi2CallbackFunctions`.
#[repr(C)]
pub(crate) struct CallbackFunctions {
    pub(crate) logger: Option<Logger>,
    pub(crate) allocate_memory: Option<unsafe extern "C" fn(usize, usize) -> *mut c_void>,
    pub(crate) free_memory: Option<unsafe extern "C" fn(*mut c_void)>,
    pub(crate) step_finished: Option<unsafe extern "C" fn(*mut c_void, c_int)>,
    pub(crate) environment: *mut c_void,
}

/// `fmi2EventInfo`.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub(crate) struct EventInfo {
    pub(crate) new_discrete_states_needed: c_int,
    pub(crate) terminate_simulation: c_int,
    pub(crate) nominals_changed: c_int,
    pub(crate) values_changed: c_int,
    pub(crate) next_event_time_defined: c_int,
    pub(crate) next_event_time: f64,
}

unsafe extern "C" {
    pub(crate) fn fmi2GetTypesPlatform() -> *const c_char;
    pub(crate) fn fmi2GetVersion() -> *const c_char;
    pub(crate) fn fmi2SetDebugLogging(
        i: *mut c_void,
        on: c_int,
        n: usize,
        categories: *const *const c_char,
    ) -> c_int;
    pub(crate) fn fmi2Instantiate(
        name: *const c_char,
        kind: c_int,
        guid: *const c_char,
        resources: *const c_char,
        functions: *const CallbackFunctions,
        visible: c_int,
        logging: c_int,
    ) -> *mut c_void;
    pub(crate) fn fmi2FreeInstance(i: *mut c_void);
    pub(crate) fn fmi2SetupExperiment(
        i: *mut c_void,
        tolerance_defined: c_int,
        tolerance: f64,
        start: f64,
        stop_defined: c_int,
        stop: f64,
    ) -> c_int;
    pub(crate) fn fmi2EnterInitializationMode(i: *mut c_void) -> c_int;
    pub(crate) fn fmi2ExitInitializationMode(i: *mut c_void) -> c_int;
    pub(crate) fn fmi2Terminate(i: *mut c_void) -> c_int;
    pub(crate) fn fmi2Reset(i: *mut c_void) -> c_int;
    pub(crate) fn fmi2GetReal(i: *mut c_void, vr: *const u32, n: usize, v: *mut f64) -> c_int;
    pub(crate) fn fmi2GetInteger(i: *mut c_void, vr: *const u32, n: usize, v: *mut c_int) -> c_int;
    pub(crate) fn fmi2GetBoolean(i: *mut c_void, vr: *const u32, n: usize, v: *mut c_int) -> c_int;
    pub(crate) fn fmi2GetString(
        i: *mut c_void,
        vr: *const u32,
        n: usize,
        v: *mut *const c_char,
    ) -> c_int;
    pub(crate) fn fmi2SetReal(i: *mut c_void, vr: *const u32, n: usize, v: *const f64) -> c_int;
    pub(crate) fn fmi2SetInteger(
        i: *mut c_void,
        vr: *const u32,
        n: usize,
        v: *const c_int,
    ) -> c_int;
    pub(crate) fn fmi2SetBoolean(
        i: *mut c_void,
        vr: *const u32,
        n: usize,
        v: *const c_int,
    ) -> c_int;
    pub(crate) fn fmi2SetString(
        i: *mut c_void,
        vr: *const u32,
        n: usize,
        v: *const *const c_char,
    ) -> c_int;
    pub(crate) fn fmi2GetFMUstate(i: *mut c_void, state: *mut *mut c_void) -> c_int;
    pub(crate) fn fmi2SetFMUstate(i: *mut c_void, state: *mut c_void) -> c_int;
    pub(crate) fn fmi2FreeFMUstate(i: *mut c_void, state: *mut *mut c_void) -> c_int;
    pub(crate) fn fmi2SerializedFMUstateSize(
        i: *mut c_void,
        state: *mut c_void,
        size: *mut usize,
    ) -> c_int;
    pub(crate) fn fmi2SerializeFMUstate(
        i: *mut c_void,
        state: *mut c_void,
        bytes: *mut u8,
        size: usize,
    ) -> c_int;
    pub(crate) fn fmi2DeSerializeFMUstate(
        i: *mut c_void,
        bytes: *const u8,
        size: usize,
        state: *mut *mut c_void,
    ) -> c_int;
    pub(crate) fn fmi2GetDirectionalDerivative(
        i: *mut c_void,
        unknowns: *const u32,
        nu: usize,
        knowns: *const u32,
        nk: usize,
        seed: *const f64,
        sensitivity: *mut f64,
    ) -> c_int;
    pub(crate) fn fmi2EnterEventMode(i: *mut c_void) -> c_int;
    pub(crate) fn fmi2NewDiscreteStates(i: *mut c_void, info: *mut EventInfo) -> c_int;
    pub(crate) fn fmi2EnterContinuousTimeMode(i: *mut c_void) -> c_int;
    pub(crate) fn fmi2CompletedIntegratorStep(
        i: *mut c_void,
        no_set: c_int,
        event: *mut c_int,
        end: *mut c_int,
    ) -> c_int;
    pub(crate) fn fmi2SetTime(i: *mut c_void, t: f64) -> c_int;
    pub(crate) fn fmi2SetContinuousStates(i: *mut c_void, x: *const f64, n: usize) -> c_int;
    pub(crate) fn fmi2GetDerivatives(i: *mut c_void, x: *mut f64, n: usize) -> c_int;
    pub(crate) fn fmi2GetEventIndicators(i: *mut c_void, z: *mut f64, n: usize) -> c_int;
    pub(crate) fn fmi2GetContinuousStates(i: *mut c_void, x: *mut f64, n: usize) -> c_int;
    pub(crate) fn fmi2GetNominalsOfContinuousStates(i: *mut c_void, x: *mut f64, n: usize)
    -> c_int;
    pub(crate) fn fmi2SetRealInputDerivatives(
        i: *mut c_void,
        vr: *const u32,
        n: usize,
        orders: *const c_int,
        v: *const f64,
    ) -> c_int;
    pub(crate) fn fmi2GetRealOutputDerivatives(
        i: *mut c_void,
        vr: *const u32,
        n: usize,
        orders: *const c_int,
        v: *mut f64,
    ) -> c_int;
    pub(crate) fn fmi2DoStep(i: *mut c_void, t: f64, h: f64, no_set_prior: c_int) -> c_int;
    pub(crate) fn fmi2CancelStep(i: *mut c_void) -> c_int;
    pub(crate) fn fmi2GetStatus(i: *mut c_void, kind: c_int, v: *mut c_int) -> c_int;
    pub(crate) fn fmi2GetRealStatus(i: *mut c_void, kind: c_int, v: *mut f64) -> c_int;
    pub(crate) fn fmi2GetIntegerStatus(i: *mut c_void, kind: c_int, v: *mut c_int) -> c_int;
    pub(crate) fn fmi2GetBooleanStatus(i: *mut c_void, kind: c_int, v: *mut c_int) -> c_int;
    pub(crate) fn fmi2GetStringStatus(i: *mut c_void, kind: c_int, v: *mut *const c_char) -> c_int;
}
