//! Versions, logging, instantiation and its end.

use std::{
    ffi::{CStr, c_char, c_int, c_void},
    panic::catch_unwind,
};

use crate::{
    abi::instantiation::{check_name, free, hand_over, new_instance, switch_logging},
    fmi2::{Boolean, Opaque, Text, function},
    interface::InterfaceType,
    logging::{Fmi2Callback, Logger, Status},
    refusal::Refusal,
    version::Abi,
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

/// Switches log categories on or off; all of them if none is named.
///
/// # Safety
///
/// `instance` as for every function; `categories` points to `category_count` strings.
#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2SetDebugLogging(
    instance: Opaque,
    logging_on: Boolean,
    category_count: usize,
    categories: *const Text,
) -> Status {
    let function = function("fmi2SetDebugLogging");
    // SAFETY: the importer's promise
    unsafe {
        switch_logging(
            function,
            instance,
            logging_on != 0,
            category_count,
            categories,
        )
    }
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
    _visible: Boolean,
    logging_on: Boolean,
) -> Opaque {
    // SAFETY: the importer's promise
    let logger = unsafe { logger(functions, instance_name, logging_on != 0) };
    let instance = catch_unwind(|| {
        // SAFETY: the importer's promise
        unsafe { check_name(instance_name) }?;
        let interface_type = match fmu_type {
            0 => InterfaceType::ModelExchange,
            1 => InterfaceType::CoSimulation,
            found => return Err(Refusal::FmuType { found }),
        };
        // SAFETY: the importer's promise
        unsafe { new_instance(Abi::Fmi2, interface_type, guid, resource_location) }
    });
    hand_over(Abi::Fmi2, "fmi2Instantiate", instance, logger)
}

/// Logger with the importer's callback. The structure is only there during the call (FMI 2.0, 2.1.5): what is needed of
/// it is copied.
///
/// # Safety
///
/// `functions` is null or points to callbacks; `instance_name` is null or a terminated string.
unsafe fn logger(functions: *const CallbackFunctions, instance_name: Text, on: bool) -> Logger {
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

/// Frees the instance; a null pointer is ignored.
///
/// # Safety
///
/// `instance` as for every function; it must not be used again.
#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2FreeInstance(instance: Opaque) {
    // SAFETY: the importer's promise
    unsafe { free(function("fmi2FreeInstance"), instance) }
}
