//! The C functions, as `fmi3Functions.h` declares them.
#![allow(non_snake_case, reason = "the C header gives the names")]

use std::ffi::{c_char, c_int, c_void};

pub(crate) const OK: c_int = 0;
pub(crate) const WARNING: c_int = 1;
pub(crate) const ERROR: c_int = 3;

pub(crate) type LogMessage = unsafe extern "C" fn(*mut c_void, c_int, *const c_char, *const c_char);
pub(crate) type Function = unsafe extern "C" fn();
pub(crate) type IntermediateUpdate =
    unsafe extern "C" fn(*mut c_void, f64, bool, bool, bool, bool, *mut bool, *mut f64);

unsafe extern "C" {
    pub(crate) fn fmi3GetVersion() -> *const c_char;
    pub(crate) fn fmi3SetDebugLogging(
        i: *mut c_void,
        on: bool,
        n: usize,
        categories: *const *const c_char,
    ) -> c_int;
    pub(crate) fn fmi3InstantiateCoSimulation(
        name: *const c_char,
        token: *const c_char,
        resources: *const c_char,
        visible: bool,
        logging: bool,
        event_mode: bool,
        early_return: bool,
        intermediate: *const u32,
        intermediate_count: usize,
        environment: *mut c_void,
        log: Option<LogMessage>,
        update: Option<IntermediateUpdate>,
    ) -> *mut c_void;
    pub(crate) fn fmi3InstantiateModelExchange(
        name: *const c_char,
        token: *const c_char,
        resources: *const c_char,
        visible: bool,
        logging: bool,
        environment: *mut c_void,
        log: Option<LogMessage>,
    ) -> *mut c_void;
    pub(crate) fn fmi3InstantiateScheduledExecution(
        name: *const c_char,
        token: *const c_char,
        resources: *const c_char,
        visible: bool,
        logging: bool,
        environment: *mut c_void,
        log: Option<LogMessage>,
        clock_update: Option<Function>,
        lock: Option<Function>,
        unlock: Option<Function>,
    ) -> *mut c_void;
    pub(crate) fn fmi3FreeInstance(i: *mut c_void);
    pub(crate) fn fmi3EnterInitializationMode(
        i: *mut c_void,
        tolerance_defined: bool,
        tolerance: f64,
        start: f64,
        stop_defined: bool,
        stop: f64,
    ) -> c_int;
    pub(crate) fn fmi3ExitInitializationMode(i: *mut c_void) -> c_int;
    pub(crate) fn fmi3Terminate(i: *mut c_void) -> c_int;
    pub(crate) fn fmi3Reset(i: *mut c_void) -> c_int;
    pub(crate) fn fmi3GetFloat64(
        i: *mut c_void,
        vr: *const u32,
        n: usize,
        v: *mut f64,
        nv: usize,
    ) -> c_int;
    pub(crate) fn fmi3SetFloat64(
        i: *mut c_void,
        vr: *const u32,
        n: usize,
        v: *const f64,
        nv: usize,
    ) -> c_int;
    pub(crate) fn fmi3GetInt32(
        i: *mut c_void,
        vr: *const u32,
        n: usize,
        v: *mut i32,
        nv: usize,
    ) -> c_int;
    pub(crate) fn fmi3SetBoolean(
        i: *mut c_void,
        vr: *const u32,
        n: usize,
        v: *const bool,
        nv: usize,
    ) -> c_int;
    pub(crate) fn fmi3GetString(
        i: *mut c_void,
        vr: *const u32,
        n: usize,
        v: *mut *const c_char,
        nv: usize,
    ) -> c_int;
    pub(crate) fn fmi3GetBinary(
        i: *mut c_void,
        vr: *const u32,
        n: usize,
        sizes: *mut usize,
        v: *mut *const u8,
        nv: usize,
    ) -> c_int;
    pub(crate) fn fmi3GetClock(i: *mut c_void, vr: *const u32, n: usize, v: *mut bool) -> c_int;
    pub(crate) fn fmi3GetFMUState(i: *mut c_void, state: *mut *mut c_void) -> c_int;
    pub(crate) fn fmi3SetFMUState(i: *mut c_void, state: *mut c_void) -> c_int;
    pub(crate) fn fmi3FreeFMUState(i: *mut c_void, state: *mut *mut c_void) -> c_int;
    pub(crate) fn fmi3SerializedFMUStateSize(
        i: *mut c_void,
        state: *mut c_void,
        size: *mut usize,
    ) -> c_int;
    pub(crate) fn fmi3SerializeFMUState(
        i: *mut c_void,
        state: *mut c_void,
        bytes: *mut u8,
        size: usize,
    ) -> c_int;
    pub(crate) fn fmi3DeserializeFMUState(
        i: *mut c_void,
        bytes: *const u8,
        size: usize,
        state: *mut *mut c_void,
    ) -> c_int;
    pub(crate) fn fmi3DoStep(
        i: *mut c_void,
        t: f64,
        h: f64,
        no_set_prior: bool,
        event: *mut bool,
        terminate: *mut bool,
        early: *mut bool,
        last: *mut f64,
    ) -> c_int;
    pub(crate) fn fmi3GetDirectionalDerivative(
        i: *mut c_void,
        unknowns: *const u32,
        nu: usize,
        knowns: *const u32,
        nk: usize,
        seed: *const f64,
        ns: usize,
        sensitivity: *mut f64,
        nsens: usize,
    ) -> c_int;
    pub(crate) fn fmi3GetAdjointDerivative(
        i: *mut c_void,
        unknowns: *const u32,
        nu: usize,
        knowns: *const u32,
        nk: usize,
        seed: *const f64,
        ns: usize,
        sensitivity: *mut f64,
        nsens: usize,
    ) -> c_int;

    // Event Mode, Model Exchange, and functions that this FMU refuses
    pub(crate) fn fmi3EnterEventMode(i: *mut c_void) -> c_int;
    pub(crate) fn fmi3EnterStepMode(i: *mut c_void) -> c_int;
    pub(crate) fn fmi3EnterConfigurationMode(i: *mut c_void) -> c_int;
    pub(crate) fn fmi3ExitConfigurationMode(i: *mut c_void) -> c_int;
    pub(crate) fn fmi3EvaluateDiscreteStates(i: *mut c_void) -> c_int;
    pub(crate) fn fmi3UpdateDiscreteStates(
        i: *mut c_void,
        need_update: *mut bool,
        terminate: *mut bool,
        nominals: *mut bool,
        states: *mut bool,
        next_defined: *mut bool,
        next: *mut f64,
    ) -> c_int;
    pub(crate) fn fmi3EnterContinuousTimeMode(i: *mut c_void) -> c_int;
    pub(crate) fn fmi3CompletedIntegratorStep(
        i: *mut c_void,
        no_set: bool,
        event: *mut bool,
        end: *mut bool,
    ) -> c_int;
    pub(crate) fn fmi3SetTime(i: *mut c_void, t: f64) -> c_int;
    pub(crate) fn fmi3SetContinuousStates(i: *mut c_void, x: *const f64, n: usize) -> c_int;
    pub(crate) fn fmi3GetContinuousStateDerivatives(i: *mut c_void, x: *mut f64, n: usize)
    -> c_int;
    pub(crate) fn fmi3GetEventIndicators(i: *mut c_void, z: *mut f64, n: usize) -> c_int;
    pub(crate) fn fmi3GetContinuousStates(i: *mut c_void, x: *mut f64, n: usize) -> c_int;
    pub(crate) fn fmi3GetNominalsOfContinuousStates(i: *mut c_void, x: *mut f64, n: usize)
    -> c_int;
    pub(crate) fn fmi3GetNumberOfEventIndicators(i: *mut c_void, n: *mut usize) -> c_int;
    pub(crate) fn fmi3GetNumberOfContinuousStates(i: *mut c_void, n: *mut usize) -> c_int;
    pub(crate) fn fmi3GetOutputDerivatives(
        i: *mut c_void,
        vr: *const u32,
        n: usize,
        orders: *const i32,
        v: *mut f64,
        nv: usize,
    ) -> c_int;
    pub(crate) fn fmi3GetNumberOfVariableDependencies(
        i: *mut c_void,
        vr: u32,
        n: *mut usize,
    ) -> c_int;
    pub(crate) fn fmi3GetVariableDependencies(
        i: *mut c_void,
        dependent: u32,
        indices: *mut usize,
        independents: *mut u32,
        independent_indices: *mut usize,
        kinds: *mut c_int,
        n: usize,
    ) -> c_int;
    pub(crate) fn fmi3ActivateModelPartition(i: *mut c_void, clock: u32, t: f64) -> c_int;
    pub(crate) fn fmi3GetIntervalDecimal(
        i: *mut c_void,
        vr: *const u32,
        n: usize,
        v: *mut f64,
        q: *mut c_int,
    ) -> c_int;
    pub(crate) fn fmi3GetIntervalFraction(
        i: *mut c_void,
        vr: *const u32,
        n: usize,
        c: *mut u64,
        r: *mut u64,
        q: *mut c_int,
    ) -> c_int;
    pub(crate) fn fmi3GetShiftDecimal(
        i: *mut c_void,
        vr: *const u32,
        n: usize,
        v: *mut f64,
    ) -> c_int;
    pub(crate) fn fmi3GetShiftFraction(
        i: *mut c_void,
        vr: *const u32,
        n: usize,
        c: *mut u64,
        r: *mut u64,
    ) -> c_int;
    pub(crate) fn fmi3SetIntervalDecimal(
        i: *mut c_void,
        vr: *const u32,
        n: usize,
        v: *const f64,
    ) -> c_int;
    pub(crate) fn fmi3SetIntervalFraction(
        i: *mut c_void,
        vr: *const u32,
        n: usize,
        c: *const u64,
        r: *const u64,
    ) -> c_int;
    pub(crate) fn fmi3SetShiftDecimal(
        i: *mut c_void,
        vr: *const u32,
        n: usize,
        v: *const f64,
    ) -> c_int;
    pub(crate) fn fmi3SetShiftFraction(
        i: *mut c_void,
        vr: *const u32,
        n: usize,
        c: *const u64,
        r: *const u64,
    ) -> c_int;
}
