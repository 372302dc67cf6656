//! Making an instance, and choosing what it logs.

use std::panic::catch_unwind;

use crate::{
    abi::{
        Function, Opaque, Text,
        arguments::{array, optional_text, text},
        conclude, handle, refuse_handle,
    },
    instance::Instance,
    interface::InterfaceType,
    logging::{Category, Logger, Status},
    refusal::Refusal,
    resources::read_start_file,
    version::Abi,
};

/// New instance of the FMU whose resources are at `resources`, if `token` is its token.
///
/// # Safety
///
/// The strings are terminated or null.
pub(crate) unsafe fn new_instance(
    abi: Abi,
    interface_type: InterfaceType,
    token: Text,
    resources: Text,
) -> Result<Instance, Refusal> {
    // SAFETY: the caller's promise
    let (token, resources) = unsafe {
        (
            text(token, abi.token_argument())?,
            optional_text(resources, abi.resource_argument())?,
        )
    };
    let file = read_start_file(resources, abi.resource_argument())?;
    Instance::new(file, token, abi, interface_type)
}

/// Hands the new instance to the importer, or says why there is none.
pub(crate) fn hand_over(
    abi: Abi,
    function: &str,
    instance: std::thread::Result<Result<Instance, Refusal>>,
    logger: Logger,
) -> Opaque {
    match instance.unwrap_or(Err(Refusal::Internal)) {
        Ok(instance) => handle::to_c(abi, instance, logger),
        Err(refusal) => {
            logger.error(function, &refusal);
            std::ptr::null_mut()
        }
    }
}

/// Refuses instances without a name.
///
/// # Safety
///
/// `name` is a terminated string or null.
pub(crate) unsafe fn check_name(name: Text) -> Result<(), Refusal> {
    // SAFETY: the caller's promise
    let name = unsafe { text(name, "instanceName") }?;
    if name.trim().is_empty() {
        return Err(Refusal::Empty {
            argument: "instanceName",
        });
    }
    Ok(())
}

/// Switches log categories on or off; all of them if none is named.
///
/// # Safety
///
/// `instance` as for [`crate::abi::call`]; `categories` points to `count` strings.
pub(crate) unsafe fn switch_logging(
    function: Function,
    instance: Opaque,
    on: bool,
    count: usize,
    categories: *const Text,
) -> Status {
    // SAFETY: the caller's promise
    let Some(handle) = (unsafe { handle::from_c_inside(function.abi, instance) }) else {
        // SAFETY: the caller's promise
        return unsafe { refuse_handle(function, instance) };
    };
    // SAFETY: the caller's promise
    let named = catch_unwind(|| unsafe { named_categories(count, categories) })
        .unwrap_or(Err(Refusal::Internal));
    match named {
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

/// Frees an instance; nothing happens to a null pointer.
///
/// # Safety
///
/// `instance` as for [`crate::abi::call`]; it must not be used again.
pub(crate) unsafe fn free(function: Function, instance: Opaque) {
    // SAFETY: the caller's promise
    let freed = catch_unwind(|| unsafe {
        if !handle::free(function.abi, instance) {
            refuse_handle(function, instance);
        }
    });
    // nothing can be told after the instance is gone
    drop(freed);
}
