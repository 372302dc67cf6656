//! Version, logging, instantiation and its end.

use std::{
    ffi::{c_char, c_void},
    panic::catch_unwind,
};

use crate::{
    fmi3::{
        Boolean, Opaque, Text, ValueReference,
        arguments::{array, optional_text, text},
        conclude, handle,
    },
    instance::Instance,
    interface::InterfaceType,
    logging::{Callback, Category, Logger, Status},
    refusal::Refusal,
    resources::read_start_file,
};

/// Version of the FMI header that this library implements.
#[unsafe(no_mangle)]
extern "C" fn fmi3GetVersion() -> *const c_char {
    c"3.0".as_ptr()
}

/// Switches log categories on or off; all of them if none is named.
///
/// # Safety
///
/// `instance` as for every function; `categories` points to `category_count` strings.
#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3SetDebugLogging(
    instance: Opaque,
    logging_on: Boolean,
    category_count: usize,
    categories: *const Text,
) -> Status {
    // SAFETY: the importer's promise
    let Some(handle) = (unsafe { handle::from_c(instance) }) else {
        return Status::Error;
    };
    // SAFETY: the importer's promise
    let named = catch_unwind(|| unsafe { named_categories(category_count, categories) })
        .unwrap_or(Err(Refusal::Internal));
    match named {
        Ok(categories) => {
            handle.logger.switch(&categories, logging_on != 0);
            Status::Ok
        }
        Err(refusal) => conclude("fmi3SetDebugLogging", handle, Err(refusal)),
    }
}

/// # Safety
///
/// `categories` points to `count` strings.
unsafe fn named_categories(
    count: usize,
    categories: *const Text,
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

/// New instance for Co-Simulation, or null after a message that says why not.
///
/// # Safety
///
/// The strings are terminated or null, the array has the length that is told, the callback is callable.
#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3InstantiateCoSimulation(
    instance_name: Text,
    instantiation_token: Text,
    resource_path: Text,
    _visible: Boolean,
    logging_on: Boolean,
    event_mode_used: Boolean,
    _early_return_allowed: Boolean,
    _required_intermediate_variables: *const ValueReference,
    required_intermediate_variable_count: usize,
    instance_environment: *mut c_void,
    log_message: Option<Callback>,
    _intermediate_update: Option<unsafe extern "C" fn()>,
) -> Opaque {
    let logger = Logger::new(log_message, instance_environment, logging_on != 0);
    let instance = catch_unwind(|| {
        // SAFETY: the importer's promise
        unsafe { named(instance_name) }?;
        if event_mode_used != 0 {
            return Err(Refusal::NotProvided {
                reason: "eventModeUsed is true, but the model has no events and modelDescription.xml has no hasEventMode",
            });
        }
        if required_intermediate_variable_count != 0 {
            return Err(Refusal::NotProvided {
                reason: "requiredIntermediateVariables is not empty, but no variable has intermediateUpdate in \
                         modelDescription.xml",
            });
        }
        // SAFETY: the importer's promise
        unsafe {
            new_instance(
                instantiation_token,
                resource_path,
                InterfaceType::CoSimulation,
            )
        }
    });
    hand_over("fmi3InstantiateCoSimulation", instance, logger)
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
    _visible: Boolean,
    logging_on: Boolean,
    instance_environment: *mut c_void,
    log_message: Option<Callback>,
) -> Opaque {
    let logger = Logger::new(log_message, instance_environment, logging_on != 0);
    let instance = catch_unwind(|| {
        // SAFETY: the importer's promise
        unsafe {
            named(instance_name)?;
            new_instance(
                instantiation_token,
                resource_path,
                InterfaceType::ModelExchange,
            )
        }
    });
    hand_over("fmi3InstantiateModelExchange", instance, logger)
}

/// # Safety
///
/// The strings are terminated or null.
unsafe fn new_instance(
    token: Text,
    resource_path: Text,
    interface_type: InterfaceType,
) -> Result<Instance, Refusal> {
    // SAFETY: the caller's promise
    let (token, resources) = unsafe {
        (
            text(token, "instantiationToken")?,
            optional_text(resource_path, "resourcePath")?,
        )
    };
    Instance::new(read_start_file(resources)?, token, interface_type)
}

/// Hands the new instance to the importer, or says why there is none.
fn hand_over(
    function: &str,
    instance: std::thread::Result<Result<Instance, Refusal>>,
    logger: Logger,
) -> Opaque {
    match instance.unwrap_or(Err(Refusal::Internal)) {
        Ok(instance) => handle::to_c(instance, logger),
        Err(refusal) => {
            logger.error(function, &refusal);
            std::ptr::null_mut()
        }
    }
}

/// # Safety
///
/// `name` is a terminated string or null.
unsafe fn named(name: Text) -> Result<(), Refusal> {
    // SAFETY: the caller's promise
    let name = unsafe { text(name, "instanceName") }?;
    if name.trim().is_empty() {
        return Err(Refusal::Empty {
            argument: "instanceName",
        });
    }
    Ok(())
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
    _visible: Boolean,
    logging_on: Boolean,
    instance_environment: *mut c_void,
    log_message: Option<Callback>,
    _clock_update: Option<unsafe extern "C" fn()>,
    _lock_preemption: Option<unsafe extern "C" fn()>,
    _unlock_preemption: Option<unsafe extern "C" fn()>,
) -> Opaque {
    let logger = Logger::new(log_message, instance_environment, logging_on != 0);
    let reason =
        "modelDescription.xml has no <ScheduledExecution>; use Co-Simulation or Model Exchange";
    logger.error(
        "fmi3InstantiateScheduledExecution",
        &Refusal::NotProvided { reason },
    );
    std::ptr::null_mut()
}

/// Frees the instance; a null pointer is ignored.
///
/// # Safety
///
/// `instance` as for every function; it must not be used again.
#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3FreeInstance(instance: Opaque) {
    // SAFETY: the importer's promise
    let freed = catch_unwind(|| unsafe { handle::free(instance) });
    // nothing can be told after the instance is gone
    drop(freed);
}
