//! The C functions of FMI 2.0, as the header `fmi2Functions.h` declares them.
#![allow(non_snake_case, reason = "the C header gives the names")]

use std::ffi::{c_char, c_int, c_void};

type Instance = *mut c_void;
type State = *mut c_void;
type Text = *const c_char;
type Boolean = c_int;

/// `fmi2CallbackLogger`.
pub(crate) type Logger = unsafe extern "C" fn(*mut c_void, Text, c_int, Text, Text, ...);

/// `fmi2CallbackFunctions`.
#[derive(Clone, Copy)]
#[repr(C)]
pub(crate) struct Callbacks {
    pub(crate) logger: Option<Logger>,
    pub(crate) allocate_memory: Option<unsafe extern "C" fn(usize, usize) -> *mut c_void>,
    pub(crate) free_memory: Option<unsafe extern "C" fn(*mut c_void)>,
    pub(crate) step_finished: Option<unsafe extern "C" fn(*mut c_void, c_int)>,
    pub(crate) environment: *mut c_void,
}

/// `fmi2EventInfo`.
#[derive(Clone, Copy, Default)]
#[repr(C)]
pub(crate) struct EventInfo {
    pub(crate) new_discrete_states_needed: Boolean,
    pub(crate) terminate_simulation: Boolean,
    pub(crate) nominals_of_continuous_states_changed: Boolean,
    pub(crate) values_of_continuous_states_changed: Boolean,
    pub(crate) next_event_time_defined: Boolean,
    pub(crate) next_event_time: f64,
}

macro_rules! functions {
    ($(fn $name:ident($($type:ty),* $(,)?) $(-> $result:ty)?;)*) => {
        unsafe extern "C" {
            $(pub(crate) fn $name($(_: $type),*) $(-> $result)?;)*
        }
    };
}

functions! {
    fn fmi2GetTypesPlatform() -> Text;
    fn fmi2GetVersion() -> Text;
    fn fmi2SetDebugLogging(Instance, Boolean, usize, *const Text) -> c_int;
    fn fmi2Instantiate(Text, c_int, Text, Text, *const Callbacks, Boolean, Boolean) -> Instance;
    fn fmi2FreeInstance(Instance);
    fn fmi2SetupExperiment(Instance, Boolean, f64, f64, Boolean, f64) -> c_int;
    fn fmi2EnterInitializationMode(Instance) -> c_int;
    fn fmi2ExitInitializationMode(Instance) -> c_int;
    fn fmi2Terminate(Instance) -> c_int;
    fn fmi2Reset(Instance) -> c_int;

    fn fmi2GetReal(Instance, *const u32, usize, *mut f64) -> c_int;
    fn fmi2GetInteger(Instance, *const u32, usize, *mut c_int) -> c_int;
    fn fmi2GetBoolean(Instance, *const u32, usize, *mut Boolean) -> c_int;
    fn fmi2GetString(Instance, *const u32, usize, *mut Text) -> c_int;
    fn fmi2SetReal(Instance, *const u32, usize, *const f64) -> c_int;
    fn fmi2SetInteger(Instance, *const u32, usize, *const c_int) -> c_int;
    fn fmi2SetBoolean(Instance, *const u32, usize, *const Boolean) -> c_int;
    fn fmi2SetString(Instance, *const u32, usize, *const Text) -> c_int;

    fn fmi2GetFMUstate(Instance, *mut State) -> c_int;
    fn fmi2SetFMUstate(Instance, State) -> c_int;
    fn fmi2FreeFMUstate(Instance, *mut State) -> c_int;
    fn fmi2SerializedFMUstateSize(Instance, State, *mut usize) -> c_int;
    fn fmi2SerializeFMUstate(Instance, State, *mut u8, usize) -> c_int;
    fn fmi2DeSerializeFMUstate(Instance, *const u8, usize, *mut State) -> c_int;
    fn fmi2GetDirectionalDerivative(
        Instance, *const u32, usize, *const u32, usize, *const f64, *mut f64,
    ) -> c_int;

    fn fmi2EnterEventMode(Instance) -> c_int;
    fn fmi2NewDiscreteStates(Instance, *mut EventInfo) -> c_int;
    fn fmi2EnterContinuousTimeMode(Instance) -> c_int;
    fn fmi2CompletedIntegratorStep(Instance, Boolean, *mut Boolean, *mut Boolean) -> c_int;
    fn fmi2SetTime(Instance, f64) -> c_int;
    fn fmi2SetContinuousStates(Instance, *const f64, usize) -> c_int;
    fn fmi2GetDerivatives(Instance, *mut f64, usize) -> c_int;
    fn fmi2GetEventIndicators(Instance, *mut f64, usize) -> c_int;
    fn fmi2GetContinuousStates(Instance, *mut f64, usize) -> c_int;
    fn fmi2GetNominalsOfContinuousStates(Instance, *mut f64, usize) -> c_int;

    fn fmi2SetRealInputDerivatives(Instance, *const u32, usize, *const c_int, *const f64) -> c_int;
    fn fmi2GetRealOutputDerivatives(Instance, *const u32, usize, *const c_int, *mut f64) -> c_int;
    fn fmi2DoStep(Instance, f64, f64, Boolean) -> c_int;
    fn fmi2CancelStep(Instance) -> c_int;
    fn fmi2GetStatus(Instance, c_int, *mut c_int) -> c_int;
    fn fmi2GetRealStatus(Instance, c_int, *mut f64) -> c_int;
    fn fmi2GetIntegerStatus(Instance, c_int, *mut c_int) -> c_int;
    fn fmi2GetBooleanStatus(Instance, c_int, *mut Boolean) -> c_int;
    fn fmi2GetStringStatus(Instance, c_int, *mut Text) -> c_int;
}
