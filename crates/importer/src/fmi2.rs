//! The functions of FMI 2.0 that an importer of Co-Simulation needs, as `fmi2FunctionTypes.h` declares them.

use std::ffi::{c_int, c_void};

use crate::abi::{Opaque, Reference, StatusCode, Text, function_table};

/// `fmi2CoSimulation` of `fmi2Type`.
pub(crate) const CO_SIMULATION: c_int = 1;

/// `fmi2CallbackLogger`. In C it takes further arguments after the last, which `...` stands for; the first of them is
/// taken as a pointer here, see [`crate::message`].
pub(crate) type LogMessage = unsafe extern "C" fn(Opaque, Text, StatusCode, Text, Text, Text);

/// `fmi2CallbackFunctions`.
#[repr(C)]
pub(crate) struct Callbacks {
    pub(crate) logger: Option<LogMessage>,
    pub(crate) allocate_memory: Option<unsafe extern "C" fn(usize, usize) -> *mut c_void>,
    pub(crate) free_memory: Option<unsafe extern "C" fn(*mut c_void)>,
    pub(crate) step_finished: Option<unsafe extern "C" fn(Opaque, StatusCode)>,
    pub(crate) environment: Opaque,
}

// the C library that std links
unsafe extern "C" {
    pub(crate) fn calloc(count: usize, size: usize) -> *mut c_void;
    pub(crate) fn free(pointer: *mut c_void);
}

type Instantiate =
    unsafe extern "C" fn(Text, c_int, Text, Text, *const Callbacks, c_int, c_int) -> Opaque;
type SetupExperiment = unsafe extern "C" fn(Opaque, c_int, f64, f64, c_int, f64) -> StatusCode;
type Simple = unsafe extern "C" fn(Opaque) -> StatusCode;
type SetReal = unsafe extern "C" fn(Opaque, *const Reference, usize, *const f64) -> StatusCode;
type GetReal = unsafe extern "C" fn(Opaque, *const Reference, usize, *mut f64) -> StatusCode;
type DoStep = unsafe extern "C" fn(Opaque, f64, f64, c_int) -> StatusCode;
type GetDirectionalDerivative = unsafe extern "C" fn(
    Opaque,
    *const Reference,
    usize,
    *const Reference,
    usize,
    *const f64,
    *mut f64,
) -> StatusCode;
type GetState = unsafe extern "C" fn(Opaque, *mut Opaque) -> StatusCode;
type SetState = unsafe extern "C" fn(Opaque, Opaque) -> StatusCode;
type StateSize = unsafe extern "C" fn(Opaque, Opaque, *mut usize) -> StatusCode;
type SerializeState = unsafe extern "C" fn(Opaque, Opaque, *mut u8, usize) -> StatusCode;
type DeserializeState = unsafe extern "C" fn(Opaque, *const u8, usize, *mut Opaque) -> StatusCode;

function_table! {
    /// The functions.
    Functions {
        get_version = "fmi2GetVersion": unsafe extern "C" fn() -> Text,
        instantiate = "fmi2Instantiate": Instantiate,
        free_instance = "fmi2FreeInstance": unsafe extern "C" fn(Opaque),
        setup_experiment = "fmi2SetupExperiment": SetupExperiment,
        enter_initialization = "fmi2EnterInitializationMode": Simple,
        exit_initialization = "fmi2ExitInitializationMode": Simple,
        terminate = "fmi2Terminate": Simple,
        reset = "fmi2Reset": Simple,
        set = "fmi2SetReal": SetReal,
        get = "fmi2GetReal": GetReal,
        do_step = "fmi2DoStep": DoStep,
        directional_derivative = "fmi2GetDirectionalDerivative": GetDirectionalDerivative,
        get_state = "fmi2GetFMUstate": GetState,
        set_state = "fmi2SetFMUstate": SetState,
        free_state = "fmi2FreeFMUstate": GetState,
        state_size = "fmi2SerializedFMUstateSize": StateSize,
        serialize_state = "fmi2SerializeFMUstate": SerializeState,
        deserialize_state = "fmi2DeSerializeFMUstate": DeserializeState,
    }
}
