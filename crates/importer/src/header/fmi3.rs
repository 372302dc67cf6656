//! FMI 3.0: `fmi3PlatformTypes.h`, `fmi3FunctionTypes.h` and `fmi3Functions.h`.

use std::ffi::c_int;

use super::{Opaque, Reference, StatusCode, Text, declare};

/// `fmi3Boolean`: a C `bool`, declared as a byte, so that no value of it is undefined behaviour.
pub type Boolean = u8;

/// `fmi3LogMessageCallback`: environment, status, category, message.
pub type LogMessageCallback = unsafe extern "C" fn(Opaque, StatusCode, Text, Text);
/// `fmi3IntermediateUpdateCallback`: environment, time, whether variables may be set, whether they may be read, whether a
/// step is finished, whether it may end early; and whether it shall, and when.
pub type IntermediateUpdateCallback =
    unsafe extern "C" fn(Opaque, f64, Boolean, Boolean, Boolean, Boolean, *mut Boolean, *mut f64);
/// Callbacks of Scheduled Execution.
pub type OtherCallback = unsafe extern "C" fn();

declare! {
    fmi3GetVersion() -> Text;
    fmi3SetDebugLogging(Opaque, Boolean, usize, *const Text) -> StatusCode;
    fmi3InstantiateModelExchange(Text, Text, Text, Boolean, Boolean, Opaque, Option<LogMessageCallback>) -> Opaque;
    fmi3InstantiateCoSimulation(
        Text, Text, Text, Boolean, Boolean, Boolean, Boolean, *const Reference, usize, Opaque, Option<LogMessageCallback>,
        Option<IntermediateUpdateCallback>,
    ) -> Opaque;
    fmi3InstantiateScheduledExecution(
        Text, Text, Text, Boolean, Boolean, Opaque, Option<LogMessageCallback>, Option<OtherCallback>,
        Option<OtherCallback>, Option<OtherCallback>,
    ) -> Opaque;
    fmi3FreeInstance(Opaque);
    fmi3EnterInitializationMode(Opaque, Boolean, f64, f64, Boolean, f64) -> StatusCode;
    fmi3ExitInitializationMode(Opaque) -> StatusCode;
    fmi3EnterEventMode(Opaque) -> StatusCode;
    fmi3Terminate(Opaque) -> StatusCode;
    fmi3Reset(Opaque) -> StatusCode;

    fmi3GetFloat32(Opaque, *const Reference, usize, *mut f32, usize) -> StatusCode;
    fmi3GetInt8(Opaque, *const Reference, usize, *mut i8, usize) -> StatusCode;
    fmi3GetUInt8(Opaque, *const Reference, usize, *mut u8, usize) -> StatusCode;
    fmi3GetInt16(Opaque, *const Reference, usize, *mut i16, usize) -> StatusCode;
    fmi3GetUInt16(Opaque, *const Reference, usize, *mut u16, usize) -> StatusCode;
    fmi3GetInt32(Opaque, *const Reference, usize, *mut i32, usize) -> StatusCode;
    fmi3GetUInt32(Opaque, *const Reference, usize, *mut u32, usize) -> StatusCode;
    fmi3GetInt64(Opaque, *const Reference, usize, *mut i64, usize) -> StatusCode;
    fmi3GetUInt64(Opaque, *const Reference, usize, *mut u64, usize) -> StatusCode;
    fmi3GetBoolean(Opaque, *const Reference, usize, *mut u8, usize) -> StatusCode;
    fmi3GetString(Opaque, *const Reference, usize, *mut Text, usize) -> StatusCode;
    fmi3GetFloat64(Opaque, *const Reference, usize, *mut f64, usize) -> StatusCode;
    fmi3GetBinary(Opaque, *const Reference, usize, *mut usize, *mut *const u8, usize) -> StatusCode;
    fmi3GetClock(Opaque, *const Reference, usize, *mut Boolean) -> StatusCode;
    fmi3SetFloat32(Opaque, *const Reference, usize, *const f32, usize) -> StatusCode;
    fmi3SetInt8(Opaque, *const Reference, usize, *const i8, usize) -> StatusCode;
    fmi3SetUInt8(Opaque, *const Reference, usize, *const u8, usize) -> StatusCode;
    fmi3SetInt16(Opaque, *const Reference, usize, *const i16, usize) -> StatusCode;
    fmi3SetUInt16(Opaque, *const Reference, usize, *const u16, usize) -> StatusCode;
    fmi3SetInt32(Opaque, *const Reference, usize, *const i32, usize) -> StatusCode;
    fmi3SetUInt32(Opaque, *const Reference, usize, *const Reference, usize) -> StatusCode;
    fmi3SetInt64(Opaque, *const Reference, usize, *const i64, usize) -> StatusCode;
    fmi3SetUInt64(Opaque, *const Reference, usize, *const u64, usize) -> StatusCode;
    fmi3SetBoolean(Opaque, *const Reference, usize, *const u8, usize) -> StatusCode;
    fmi3SetString(Opaque, *const Reference, usize, *const Text, usize) -> StatusCode;
    fmi3SetFloat64(Opaque, *const Reference, usize, *const f64, usize) -> StatusCode;
    fmi3SetBinary(Opaque, *const Reference, usize, *const usize, *const *const u8, usize) -> StatusCode;
    fmi3SetClock(Opaque, *const Reference, usize, *const Boolean) -> StatusCode;

    fmi3GetNumberOfVariableDependencies(Opaque, u32, *mut usize) -> StatusCode;
    fmi3GetVariableDependencies(
        Opaque, u32, *mut usize, *mut u32, *mut usize, *mut c_int, usize,
    ) -> StatusCode;
    fmi3GetFMUState(Opaque, *mut Opaque) -> StatusCode;
    fmi3SetFMUState(Opaque, Opaque) -> StatusCode;
    fmi3FreeFMUState(Opaque, *mut Opaque) -> StatusCode;
    fmi3SerializedFMUStateSize(Opaque, Opaque, *mut usize) -> StatusCode;
    fmi3SerializeFMUState(Opaque, Opaque, *mut u8, usize) -> StatusCode;
    fmi3DeserializeFMUState(Opaque, *const u8, usize, *mut Opaque) -> StatusCode;
    fmi3GetDirectionalDerivative(
        Opaque, *const Reference, usize, *const Reference, usize, *const f64, usize, *mut f64, usize,
    ) -> StatusCode;
    fmi3GetAdjointDerivative(
        Opaque, *const Reference, usize, *const Reference, usize, *const f64, usize, *mut f64, usize,
    ) -> StatusCode;
    fmi3EnterConfigurationMode(Opaque) -> StatusCode;
    fmi3ExitConfigurationMode(Opaque) -> StatusCode;
    fmi3GetIntervalDecimal(Opaque, *const Reference, usize, *mut f64, *mut c_int) -> StatusCode;
    fmi3GetIntervalFraction(Opaque, *const Reference, usize, *mut u64, *mut u64, *mut c_int) -> StatusCode;
    fmi3GetShiftDecimal(Opaque, *const Reference, usize, *mut f64) -> StatusCode;
    fmi3GetShiftFraction(Opaque, *const Reference, usize, *mut u64, *mut u64) -> StatusCode;
    fmi3SetIntervalDecimal(Opaque, *const Reference, usize, *const f64) -> StatusCode;
    fmi3SetIntervalFraction(Opaque, *const Reference, usize, *const u64, *const u64) -> StatusCode;
    fmi3SetShiftDecimal(Opaque, *const Reference, usize, *const f64) -> StatusCode;
    fmi3SetShiftFraction(Opaque, *const Reference, usize, *const u64, *const u64) -> StatusCode;
    fmi3EvaluateDiscreteStates(Opaque) -> StatusCode;
    fmi3UpdateDiscreteStates(
        Opaque, *mut Boolean, *mut Boolean, *mut Boolean, *mut Boolean, *mut Boolean, *mut f64,
    ) -> StatusCode;
    fmi3EnterContinuousTimeMode(Opaque) -> StatusCode;
    fmi3CompletedIntegratorStep(Opaque, Boolean, *mut Boolean, *mut Boolean) -> StatusCode;
    fmi3SetTime(Opaque, f64) -> StatusCode;
    fmi3SetContinuousStates(Opaque, *const f64, usize) -> StatusCode;
    fmi3GetContinuousStateDerivatives(Opaque, *mut f64, usize) -> StatusCode;
    fmi3GetEventIndicators(Opaque, *mut f64, usize) -> StatusCode;
    fmi3GetContinuousStates(Opaque, *mut f64, usize) -> StatusCode;
    fmi3GetNominalsOfContinuousStates(Opaque, *mut f64, usize) -> StatusCode;
    fmi3GetNumberOfEventIndicators(Opaque, *mut usize) -> StatusCode;
    fmi3GetNumberOfContinuousStates(Opaque, *mut usize) -> StatusCode;
    fmi3EnterStepMode(Opaque) -> StatusCode;
    fmi3GetOutputDerivatives(Opaque, *const Reference, usize, *const i32, *mut f64, usize) -> StatusCode;
    fmi3DoStep(
        Opaque, f64, f64, Boolean, *mut Boolean, *mut Boolean, *mut Boolean, *mut f64,
    ) -> StatusCode;
    fmi3ActivateModelPartition(Opaque, u32, f64) -> StatusCode;
}
