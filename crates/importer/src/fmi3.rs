//! The functions of FMI 3.0 that an importer of Co-Simulation needs, as `fmi3FunctionTypes.h` declares them.

use crate::abi::{Opaque, Reference, StatusCode, Text, function_table};

/// `fmi3LogMessageCallback`.
pub(crate) type LogMessage = unsafe extern "C" fn(Opaque, StatusCode, Text, Text);

type InstantiateCoSimulation = unsafe extern "C" fn(
    Text,
    Text,
    Text,
    bool,
    bool,
    bool,
    bool,
    *const Reference,
    usize,
    Opaque,
    Option<LogMessage>,
    Option<unsafe extern "C" fn()>,
) -> Opaque;
type EnterInitializationMode =
    unsafe extern "C" fn(Opaque, bool, f64, f64, bool, f64) -> StatusCode;
type Simple = unsafe extern "C" fn(Opaque) -> StatusCode;
type SetFloat64 =
    unsafe extern "C" fn(Opaque, *const Reference, usize, *const f64, usize) -> StatusCode;
type GetFloat64 =
    unsafe extern "C" fn(Opaque, *const Reference, usize, *mut f64, usize) -> StatusCode;
// fmi3Boolean is a C bool; results are taken as bytes, so that no value of them is undefined behaviour
type DoStep =
    unsafe extern "C" fn(Opaque, f64, f64, bool, *mut u8, *mut u8, *mut u8, *mut f64) -> StatusCode;
type GetDirectionalDerivative = unsafe extern "C" fn(
    Opaque,
    *const Reference,
    usize,
    *const Reference,
    usize,
    *const f64,
    usize,
    *mut f64,
    usize,
) -> StatusCode;
type GetState = unsafe extern "C" fn(Opaque, *mut Opaque) -> StatusCode;
type SetState = unsafe extern "C" fn(Opaque, Opaque) -> StatusCode;
type StateSize = unsafe extern "C" fn(Opaque, Opaque, *mut usize) -> StatusCode;
type SerializeState = unsafe extern "C" fn(Opaque, Opaque, *mut u8, usize) -> StatusCode;
type DeserializeState = unsafe extern "C" fn(Opaque, *const u8, usize, *mut Opaque) -> StatusCode;

function_table! {
    /// The functions.
    Functions {
        get_version = "fmi3GetVersion": unsafe extern "C" fn() -> Text,
        instantiate = "fmi3InstantiateCoSimulation": InstantiateCoSimulation,
        free_instance = "fmi3FreeInstance": unsafe extern "C" fn(Opaque),
        enter_initialization = "fmi3EnterInitializationMode": EnterInitializationMode,
        exit_initialization = "fmi3ExitInitializationMode": Simple,
        terminate = "fmi3Terminate": Simple,
        reset = "fmi3Reset": Simple,
        set = "fmi3SetFloat64": SetFloat64,
        get = "fmi3GetFloat64": GetFloat64,
        do_step = "fmi3DoStep": DoStep,
        directional_derivative = "fmi3GetDirectionalDerivative": GetDirectionalDerivative,
        get_state = "fmi3GetFMUState": GetState,
        set_state = "fmi3SetFMUState": SetState,
        free_state = "fmi3FreeFMUState": GetState,
        state_size = "fmi3SerializedFMUStateSize": StateSize,
        serialize_state = "fmi3SerializeFMUState": SerializeState,
        deserialize_state = "fmi3DeserializeFMUState": DeserializeState,
    }
}
