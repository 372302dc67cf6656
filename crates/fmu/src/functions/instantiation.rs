//! Versions, instantiation and its end, and what an instance logs.

use std::ffi::{CStr, c_char, c_int, c_void};

use super::Fmi2Boolean;
use crate::{
    abi::{
        Function, Opaque, Text, ValueReference, Way,
        arguments::{array, optional_text, text},
        conclude, guarded,
        handle::{self, Fmi3Boolean, IntermediateUpdate, IntermediateUpdateCallback},
        refuse_handle,
    },
    instance::Instance,
    interface::InterfaceType,
    logging::{Category, Fmi2Callback, Fmi3Callback, Logger, Status},
    refusal::Refusal,
    resources::read_start_file,
};

/// `fmi2CallbackFunctions`.
///
/// Memory is managed without the importer, as `canNotUseMemoryManagementFunctions` in the model description tells; and
/// every step is done when `fmi2DoStep` returns, so that there is never an asynchronous one to report as finished.
#[derive(Clone, Copy)]
#[repr(C)]
struct CallbackFunctions {
    logger: Option<Fmi2Callback>,
    allocate_memory: Option<unsafe extern "C" fn(usize, usize) -> *mut c_void>,
    free_memory: Option<unsafe extern "C" fn(*mut c_void)>,
    step_finished: Option<unsafe extern "C" fn(*mut c_void, c_int)>,
    environment: *mut c_void,
}

/// Types of the header that this library was made with.
#[unsafe(no_mangle)]
extern "C" fn fmi2GetTypesPlatform() -> *const c_char {
    c"default".as_ptr()
}

/// Version of the header that this library was made with.
#[unsafe(no_mangle)]
extern "C" fn fmi2GetVersion() -> *const c_char {
    c"2.0".as_ptr()
}

/// Version of the header that this library was made with.
#[unsafe(no_mangle)]
extern "C" fn fmi3GetVersion() -> *const c_char {
    c"3.0".as_ptr()
}

/// New instance, or null after a message that says why not.
///
/// # Safety
///
/// The strings are terminated or null; `functions` is null or points to callbacks, which may be null.
#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2Instantiate(
    instance_name: Text,
    fmu_type: c_int,
    guid: Text,
    resource_location: Text,
    functions: *const CallbackFunctions,
    _visible: Fmi2Boolean,
    logging_on: Fmi2Boolean,
) -> Opaque {
    const FUNCTION: Function = Function::new("fmi2Instantiate", Way::PLAIN);
    // SAFETY: the importer's promise
    unsafe {
        let logger = fmi2_logger(functions, instance_name, logging_on != 0);
        instantiate(FUNCTION, logger, instance_name, || {
            let interface_type = match fmu_type {
                0 => InterfaceType::ModelExchange,
                1 => InterfaceType::CoSimulation,
                found => return Err(Refusal::FmuType { found }),
            };
            new_instance(FUNCTION, interface_type, guid, resource_location)
        })
    }
}

/// New instance for Co-Simulation, or null after a message that says why not.
///
/// # Safety
///
/// The strings are terminated or null, the array has the length that is told, the callbacks are callable.
#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3InstantiateCoSimulation(
    instance_name: Text,
    instantiation_token: Text,
    resource_path: Text,
    _visible: Fmi3Boolean,
    logging_on: Fmi3Boolean,
    event_mode_used: Fmi3Boolean,
    early_return_allowed: Fmi3Boolean,
    required_intermediate_variables: *const ValueReference,
    required_intermediate_variable_count: usize,
    environment: *mut c_void,
    log_message: Option<Fmi3Callback>,
    intermediate_update: Option<IntermediateUpdateCallback>,
) -> Opaque {
    const FUNCTION: Function = Function::new("fmi3InstantiateCoSimulation", Way::PLAIN);
    let logger = Logger::fmi3(log_message, environment, logging_on != 0);
    // SAFETY: the importer's promise
    let instance = unsafe {
        instantiate(FUNCTION, logger, instance_name, || {
            let required = array(
                required_intermediate_variables,
                required_intermediate_variable_count,
                "requiredIntermediateVariables",
            )?;
            if !required.is_empty() && intermediate_update.is_none() {
                return Err(Refusal::NoIntermediateUpdate);
            }
            let kind = InterfaceType::CoSimulation;
            let mut instance = new_instance(FUNCTION, kind, instantiation_token, resource_path)?;
            instance.require_intermediate(required)?;
            if event_mode_used != 0 {
                instance.use_event_mode();
            }
            Ok(instance)
        })
    };
    // SAFETY: a new instance, or null
    if let Some(handle) = unsafe { handle::from_c(FUNCTION.abi, instance) } {
        handle.intermediate_update = intermediate_update.map(|callback| IntermediateUpdate {
            callback,
            environment,
            early_return_allowed: early_return_allowed != 0,
        });
    }
    instance
}

/// New instance for Model Exchange, or null after a message that says why not.
///
/// # Safety
///
/// The strings are terminated or null, the callback is callable.
#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3InstantiateModelExchange(
    instance_name: Text,
    instantiation_token: Text,
    resource_path: Text,
    _visible: Fmi3Boolean,
    logging_on: Fmi3Boolean,
    environment: *mut c_void,
    log_message: Option<Fmi3Callback>,
) -> Opaque {
    const FUNCTION: Function = Function::new("fmi3InstantiateModelExchange", Way::PLAIN);
    let logger = Logger::fmi3(log_message, environment, logging_on != 0);
    // SAFETY: the importer's promise
    unsafe {
        instantiate(FUNCTION, logger, instance_name, || {
            let kind = InterfaceType::ModelExchange;
            new_instance(FUNCTION, kind, instantiation_token, resource_path)
        })
    }
}

/// Null: there is no Scheduled Execution.
///
/// # Safety
///
/// The callback is callable.
#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3InstantiateScheduledExecution(
    _instance_name: Text,
    _instantiation_token: Text,
    _resource_path: Text,
    _visible: Fmi3Boolean,
    logging_on: Fmi3Boolean,
    environment: *mut c_void,
    log_message: Option<Fmi3Callback>,
    _clock_update: Option<unsafe extern "C" fn()>,
    _lock_preemption: Option<unsafe extern "C" fn()>,
    _unlock_preemption: Option<unsafe extern "C" fn()>,
) -> Opaque {
    let logger = Logger::fmi3(log_message, environment, logging_on != 0);
    let reason =
        "modelDescription.xml has no <ScheduledExecution>; use Co-Simulation or Model Exchange";
    let refusal = Refusal::NotProvided { reason };
    logger.tell(Status::Error, "fmi3InstantiateScheduledExecution", &refusal);
    std::ptr::null_mut()
}

/// Logger with the importer's callback. The structure is only there during the call (FMI 2.0, 2.1.5): what is needed of
/// it is copied.
///
/// # Safety
///
/// `functions` is null or points to callbacks; `instance_name` is null or a terminated string.
unsafe fn fmi2_logger(
    functions: *const CallbackFunctions,
    instance_name: Text,
    on: bool,
) -> Logger {
    let (callback, environment) = if functions.is_null() {
        (None, std::ptr::null_mut())
    } else {
        // SAFETY: the caller's promise; wherever the importer has put the structure
        let functions = unsafe { functions.read_unaligned() };
        (functions.logger, functions.environment)
    };
    let instance_name = if instance_name.is_null() {
        c""
    } else {
        // SAFETY: the caller's promise
        unsafe { CStr::from_ptr(instance_name) }
    };
    Logger::fmi2(callback, environment, instance_name, on)
}

/// Hands the instance to the importer that `make` makes, or says why there is none. Instances need a name.
///
/// # Safety
///
/// `name` is a terminated string or null.
unsafe fn instantiate(
    function: Function,
    logger: Logger,
    name: Text,
    make: impl FnOnce() -> Result<Instance, Refusal>,
) -> Opaque {
    let instance = guarded(|| {
        let argument = "instanceName";
        // SAFETY: the caller's promise
        if unsafe { text(name, argument) }?.trim().is_empty() {
            return Err(Refusal::Empty { argument });
        }
        make()
    });
    match instance {
        Ok(instance) => handle::to_c(function.abi, instance, logger),
        Err(refusal) => {
            logger.tell(Status::Error, function.name, &refusal);
            std::ptr::null_mut()
        }
    }
}

/// New instance of the FMU whose resources are at `resources`, if `token` is its token.
///
/// # Safety
///
/// The strings are terminated or null.
unsafe fn new_instance(
    Function { abi, .. }: Function,
    interface_type: InterfaceType,
    token: Text,
    resources: Text,
) -> Result<Instance, Refusal> {
    let words = abi.words();
    // SAFETY: the caller's promise
    let (token, resources) = unsafe {
        (
            text(token, words.token)?,
            optional_text(resources, words.resources)?,
        )
    };
    let file = read_start_file(resources, words.resources)?;
    Instance::new(file, token, abi, interface_type)
}

/// Defines the functions of both versions that work on an instance with its log.
macro_rules! of_both_versions {
    ($($free:ident, $switch:ident($boolean:ty);)*) => {$(
        /// Frees the instance; a null pointer is ignored.
        ///
        /// # Safety
        ///
        /// `instance` as for every function; it must not be used again.
        #[unsafe(no_mangle)]
        unsafe extern "C" fn $free(instance: Opaque) {
            const FUNCTION: Function = Function::new(stringify!($free), Way::PLAIN);
            // SAFETY: the importer's promise
            unsafe { free(FUNCTION, instance) }
        }

        /// Switches log categories on or off; all of them if none is named.
        ///
        /// # Safety
        ///
        /// `instance` as for every function; `categories` points to `count` strings.
        #[unsafe(no_mangle)]
        unsafe extern "C" fn $switch(
            instance: Opaque,
            logging_on: $boolean,
            count: usize,
            categories: *const Text,
        ) -> Status {
            const FUNCTION: Function = Function::new(stringify!($switch), Way::INSIDE);
            // SAFETY: the importer's promise
            unsafe { switch_logging(FUNCTION, instance, logging_on != 0, (categories, count)) }
        }
    )*};
}

of_both_versions! {
    fmi2FreeInstance, fmi2SetDebugLogging(Fmi2Boolean);
    fmi3FreeInstance, fmi3SetDebugLogging(Fmi3Boolean);
}

/// # Safety
///
/// `instance` as for [`crate::abi::call`]; it must not be used again.
unsafe fn free(function: Function, instance: Opaque) {
    // SAFETY: the caller's promise
    let freed = guarded(|| unsafe {
        if !handle::free(function.abi, instance) {
            refuse_handle(function, instance);
        }
        Ok(())
    });
    // nothing can be told after the instance is gone
    drop(freed);
}

/// # Safety
///
/// `instance` as for [`crate::abi::call`]; `categories` points to `count` strings.
unsafe fn switch_logging(
    function: Function,
    instance: Opaque,
    on: bool,
    (categories, count): (*const Text, usize),
) -> Status {
    // SAFETY: the caller's promise
    let Some(handle) = (unsafe { handle::from_c_inside(function.abi, instance) }) else {
        // SAFETY: the caller's promise
        return unsafe { refuse_handle(function, instance) };
    };
    // SAFETY: the caller's promise
    match guarded(|| unsafe { named_categories(categories, count) }) {
        Ok(categories) => {
            handle.logger.switch(&categories, on);
            Status::Ok
        }
        Err(refusal) => conclude(function, handle, Err(refusal)),
    }
}

/// # Safety
///
/// `categories` points to `count` strings.
unsafe fn named_categories(
    categories: *const Text,
    count: usize,
) -> Result<Vec<Category>, Refusal> {
    if count == 0 {
        return Ok(Category::ALL.to_vec());
    }
    // SAFETY: the caller's promise
    unsafe { array(categories, count, "categories") }?
        .iter()
        .map(|&name| {
            // SAFETY: the caller's promise
            let name = unsafe { text(name, "categories") }?;
            Category::named(name).ok_or_else(|| Refusal::UnknownCategory {
                found: name.to_owned(),
            })
        })
        .collect()
}
