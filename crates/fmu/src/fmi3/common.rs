//! Version, logging, instantiation and its end.

use std::{
    ffi::{c_char, c_void},
    panic::catch_unwind,
};

use crate::{
    abi::{
        arguments::array,
        handle,
        instantiation::{check_name, free, hand_over, new_instance, switch_logging},
    },
    fmi3::{
        Boolean, IntermediateUpdate, IntermediateUpdateCallback, Opaque, Text, ValueReference,
        function,
    },
    interface::InterfaceType,
    logging::{Fmi3Callback, Logger, Status},
    refusal::Refusal,
    version::Abi,
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
    let function = function("fmi3SetDebugLogging");
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
    early_return_allowed: Boolean,
    required_intermediate_variables: *const ValueReference,
    required_intermediate_variable_count: usize,
    instance_environment: *mut c_void,
    log_message: Option<Fmi3Callback>,
    intermediate_update: Option<IntermediateUpdateCallback>,
) -> Opaque {
    let logger = Logger::fmi3(log_message, instance_environment, logging_on != 0);
    let instance = catch_unwind(|| {
        // SAFETY: the importer's promise
        unsafe {
            check_name(instance_name)?;
            let required = array(
                required_intermediate_variables,
                required_intermediate_variable_count,
                "requiredIntermediateVariables",
            )?;
            if !required.is_empty() && intermediate_update.is_none() {
                return Err(Refusal::NoIntermediateUpdate);
            }
            let mut instance = new_instance(
                Abi::Fmi3,
                InterfaceType::CoSimulation,
                instantiation_token,
                resource_path,
            )?;
            instance.require_intermediate(required)?;
            if event_mode_used != 0 {
                instance.use_event_mode();
            }
            Ok(instance)
        }
    });
    let instance = hand_over(Abi::Fmi3, "fmi3InstantiateCoSimulation", instance, logger);
    // SAFETY: a new instance, or null
    if let Some(handle) = unsafe { handle::from_c(Abi::Fmi3, instance) } {
        handle.intermediate_update = intermediate_update.map(|callback| IntermediateUpdate {
            callback,
            environment: instance_environment,
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
    _visible: Boolean,
    logging_on: Boolean,
    instance_environment: *mut c_void,
    log_message: Option<Fmi3Callback>,
) -> Opaque {
    let logger = Logger::fmi3(log_message, instance_environment, logging_on != 0);
    let instance = catch_unwind(|| {
        // SAFETY: the importer's promise
        unsafe {
            check_name(instance_name)?;
            new_instance(
                Abi::Fmi3,
                InterfaceType::ModelExchange,
                instantiation_token,
                resource_path,
            )
        }
    });
    hand_over(Abi::Fmi3, "fmi3InstantiateModelExchange", instance, logger)
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
    log_message: Option<Fmi3Callback>,
    _clock_update: Option<unsafe extern "C" fn()>,
    _lock_preemption: Option<unsafe extern "C" fn()>,
    _unlock_preemption: Option<unsafe extern "C" fn()>,
) -> Opaque {
    let logger = Logger::fmi3(log_message, instance_environment, logging_on != 0);
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
    unsafe { free(function("fmi3FreeInstance"), instance) }
}
