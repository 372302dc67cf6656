//! The C functions of FMI 3.0, as the header `fmi3Functions.h` declares them.
//!
//! A C `bool` is declared as a byte, so that values other than 0 and 1 can be handed over.
#![allow(non_snake_case, reason = "the C header gives the names")]

use std::ffi::{c_char, c_int, c_void};

type Instance = *mut c_void;
type State = *mut c_void;
type Text = *const c_char;
type Boolean = u8;

/// `fmi3LogMessageCallback`.
pub(crate) type LogMessage = unsafe extern "C" fn(*mut c_void, c_int, Text, Text);
/// `fmi3IntermediateUpdateCallback`.
pub(crate) type IntermediateUpdate =
    unsafe extern "C" fn(*mut c_void, f64, bool, bool, bool, bool, *mut bool, *mut f64);
/// Callbacks of Scheduled Execution.
type Other = unsafe extern "C" fn();
/// `fmi3GetDirectionalDerivative`, `fmi3GetAdjointDerivative`.
pub(crate) type PartialDerivative = unsafe extern "C" fn(
    Instance,
    *const u32,
    usize,
    *const u32,
    usize,
    *const f64,
    usize,
    *mut f64,
    usize,
) -> c_int;

macro_rules! functions {
    ($(fn $name:ident($($type:ty),* $(,)?) $(-> $result:ty)?;)*) => {
        unsafe extern "C" {
            $(pub(crate) fn $name($(_: $type),*) $(-> $result)?;)*
        }
    };
}

functions! {
    fn fmi3GetVersion() -> Text;
    fn fmi3SetDebugLogging(Instance, Boolean, usize, *const Text) -> c_int;
    fn fmi3InstantiateModelExchange(Text, Text, Text, Boolean, Boolean, *mut c_void, Option<LogMessage>) -> Instance;
    fn fmi3InstantiateCoSimulation(
        Text, Text, Text, Boolean, Boolean, Boolean, Boolean, *const u32, usize, *mut c_void, Option<LogMessage>,
        Option<IntermediateUpdate>,
    ) -> Instance;
    fn fmi3InstantiateScheduledExecution(
        Text, Text, Text, Boolean, Boolean, *mut c_void, Option<LogMessage>, Option<Other>, Option<Other>,
        Option<Other>,
    ) -> Instance;
    fn fmi3FreeInstance(Instance);
    fn fmi3EnterInitializationMode(Instance, Boolean, f64, f64, Boolean, f64) -> c_int;
    fn fmi3ExitInitializationMode(Instance) -> c_int;
    fn fmi3EnterEventMode(Instance) -> c_int;
    fn fmi3Terminate(Instance) -> c_int;
    fn fmi3Reset(Instance) -> c_int;

    fn fmi3GetFloat32(Instance, *const u32, usize, *mut f32, usize) -> c_int;
    fn fmi3GetInt8(Instance, *const u32, usize, *mut i8, usize) -> c_int;
    fn fmi3GetUInt8(Instance, *const u32, usize, *mut u8, usize) -> c_int;
    fn fmi3GetInt16(Instance, *const u32, usize, *mut i16, usize) -> c_int;
    fn fmi3GetUInt16(Instance, *const u32, usize, *mut u16, usize) -> c_int;
    fn fmi3GetInt32(Instance, *const u32, usize, *mut i32, usize) -> c_int;
    fn fmi3GetUInt32(Instance, *const u32, usize, *mut u32, usize) -> c_int;
    fn fmi3GetInt64(Instance, *const u32, usize, *mut i64, usize) -> c_int;
    fn fmi3GetUInt64(Instance, *const u32, usize, *mut u64, usize) -> c_int;
    fn fmi3GetBoolean(Instance, *const u32, usize, *mut u8, usize) -> c_int;
    fn fmi3GetString(Instance, *const u32, usize, *mut *const c_char, usize) -> c_int;
    fn fmi3GetFloat64(Instance, *const u32, usize, *mut f64, usize) -> c_int;
    fn fmi3GetBinary(Instance, *const u32, usize, *mut usize, *mut *const u8, usize) -> c_int;
    fn fmi3GetClock(Instance, *const u32, usize, *mut Boolean) -> c_int;
    fn fmi3SetFloat32(Instance, *const u32, usize, *const f32, usize) -> c_int;
    fn fmi3SetInt8(Instance, *const u32, usize, *const i8, usize) -> c_int;
    fn fmi3SetUInt8(Instance, *const u32, usize, *const u8, usize) -> c_int;
    fn fmi3SetInt16(Instance, *const u32, usize, *const i16, usize) -> c_int;
    fn fmi3SetUInt16(Instance, *const u32, usize, *const u16, usize) -> c_int;
    fn fmi3SetInt32(Instance, *const u32, usize, *const i32, usize) -> c_int;
    fn fmi3SetUInt32(Instance, *const u32, usize, *const u32, usize) -> c_int;
    fn fmi3SetInt64(Instance, *const u32, usize, *const i64, usize) -> c_int;
    fn fmi3SetUInt64(Instance, *const u32, usize, *const u64, usize) -> c_int;
    fn fmi3SetBoolean(Instance, *const u32, usize, *const u8, usize) -> c_int;
    fn fmi3SetString(Instance, *const u32, usize, *const *const c_char, usize) -> c_int;
    fn fmi3SetFloat64(Instance, *const u32, usize, *const f64, usize) -> c_int;
    fn fmi3SetBinary(Instance, *const u32, usize, *const usize, *const *const u8, usize) -> c_int;
    fn fmi3SetClock(Instance, *const u32, usize, *const Boolean) -> c_int;

    fn fmi3GetNumberOfVariableDependencies(Instance, u32, *mut usize) -> c_int;
    fn fmi3GetVariableDependencies(
        Instance, u32, *mut usize, *mut u32, *mut usize, *mut c_int, usize,
    ) -> c_int;
    fn fmi3GetFMUState(Instance, *mut State) -> c_int;
    fn fmi3SetFMUState(Instance, State) -> c_int;
    fn fmi3FreeFMUState(Instance, *mut State) -> c_int;
    fn fmi3SerializedFMUStateSize(Instance, State, *mut usize) -> c_int;
    fn fmi3SerializeFMUState(Instance, State, *mut u8, usize) -> c_int;
    fn fmi3DeserializeFMUState(Instance, *const u8, usize, *mut State) -> c_int;
    fn fmi3GetDirectionalDerivative(
        Instance, *const u32, usize, *const u32, usize, *const f64, usize, *mut f64, usize,
    ) -> c_int;
    fn fmi3GetAdjointDerivative(
        Instance, *const u32, usize, *const u32, usize, *const f64, usize, *mut f64, usize,
    ) -> c_int;
    fn fmi3EnterConfigurationMode(Instance) -> c_int;
    fn fmi3ExitConfigurationMode(Instance) -> c_int;
    fn fmi3GetIntervalDecimal(Instance, *const u32, usize, *mut f64, *mut c_int) -> c_int;
    fn fmi3GetIntervalFraction(Instance, *const u32, usize, *mut u64, *mut u64, *mut c_int) -> c_int;
    fn fmi3GetShiftDecimal(Instance, *const u32, usize, *mut f64) -> c_int;
    fn fmi3GetShiftFraction(Instance, *const u32, usize, *mut u64, *mut u64) -> c_int;
    fn fmi3SetIntervalDecimal(Instance, *const u32, usize, *const f64) -> c_int;
    fn fmi3SetIntervalFraction(Instance, *const u32, usize, *const u64, *const u64) -> c_int;
    fn fmi3SetShiftDecimal(Instance, *const u32, usize, *const f64) -> c_int;
    fn fmi3SetShiftFraction(Instance, *const u32, usize, *const u64, *const u64) -> c_int;
    fn fmi3EvaluateDiscreteStates(Instance) -> c_int;
    fn fmi3UpdateDiscreteStates(
        Instance, *mut Boolean, *mut Boolean, *mut Boolean, *mut Boolean, *mut Boolean, *mut f64,
    ) -> c_int;
    fn fmi3EnterContinuousTimeMode(Instance) -> c_int;
    fn fmi3CompletedIntegratorStep(Instance, Boolean, *mut Boolean, *mut Boolean) -> c_int;
    fn fmi3SetTime(Instance, f64) -> c_int;
    fn fmi3SetContinuousStates(Instance, *const f64, usize) -> c_int;
    fn fmi3GetContinuousStateDerivatives(Instance, *mut f64, usize) -> c_int;
    fn fmi3GetEventIndicators(Instance, *mut f64, usize) -> c_int;
    fn fmi3GetContinuousStates(Instance, *mut f64, usize) -> c_int;
    fn fmi3GetNominalsOfContinuousStates(Instance, *mut f64, usize) -> c_int;
    fn fmi3GetNumberOfEventIndicators(Instance, *mut usize) -> c_int;
    fn fmi3GetNumberOfContinuousStates(Instance, *mut usize) -> c_int;
    fn fmi3EnterStepMode(Instance) -> c_int;
    fn fmi3GetOutputDerivatives(Instance, *const u32, usize, *const i32, *mut f64, usize) -> c_int;
    fn fmi3DoStep(
        Instance, f64, f64, Boolean, *mut Boolean, *mut Boolean, *mut Boolean, *mut f64,
    ) -> c_int;
    fn fmi3ActivateModelPartition(Instance, u32, f64) -> c_int;
}
