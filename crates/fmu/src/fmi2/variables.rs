//! Reading and writing variables.

use crate::{
    abi::{
        handle::Handle,
        shortcut::{arrays, arrays_mut, taken},
    },
    fmi2::{
        Boolean, Done, Integer, Opaque, Text, ValueReference,
        arguments::{array, array_mut},
        call, call_evaluating,
    },
    logging::Status,
    mode::Mode,
    version::Abi,
};

/// States in which variables can be read: all but instantiated.
const READABLE: &[Mode] = &[
    Mode::Initialization,
    Mode::Step,
    Mode::Event,
    Mode::ContinuousTime,
    Mode::Terminated,
];

/// Reads variables of type Real, which is that of all variables.
///
/// # Safety
///
/// `instance` as for every function; the arrays have the length that is told.
#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2GetReal(
    instance: Opaque,
    value_references: *const ValueReference,
    count: usize,
    values: *mut f64,
) -> Status {
    // SAFETY: the importer's promise
    unsafe {
        let shortcut = |handle: &mut Handle| {
            arrays_mut(value_references, values, count).is_some_and(|(references, values)| {
                handle.instance.get_between_steps(references, values)
            })
        };
        if taken(Abi::Fmi2, instance, shortcut) {
            return Status::Ok;
        }
        get_real(instance, value_references, count, values)
    }
}

/// # Safety
///
/// As for [`fmi2GetReal`].
#[cold]
unsafe fn get_real(
    instance: Opaque,
    value_references: *const ValueReference,
    count: usize,
    values: *mut f64,
) -> Status {
    // SAFETY: the caller's promise
    unsafe {
        call_evaluating("fmi2GetReal", instance, |instance| {
            instance.require(READABLE)?;
            let references = array(value_references, count, "vr")?;
            let values = array_mut(values, count, "value")?;
            instance.get(references, values)?;
            Ok(Done::Silently)
        })
    }
}

/// Sets variables of type Real, all or none.
///
/// # Safety
///
/// `instance` as for every function; the arrays have the length that is told.
#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2SetReal(
    instance: Opaque,
    value_references: *const ValueReference,
    count: usize,
    values: *const f64,
) -> Status {
    // SAFETY: the importer's promise
    unsafe {
        let shortcut = |handle: &mut Handle| {
            arrays(value_references, values, count).is_some_and(|(references, values)| {
                handle.instance.set_between_steps(references, values)
            })
        };
        if taken(Abi::Fmi2, instance, shortcut) {
            return Status::Ok;
        }
        set_real(instance, value_references, count, values)
    }
}

/// # Safety
///
/// As for [`fmi2SetReal`].
#[cold]
unsafe fn set_real(
    instance: Opaque,
    value_references: *const ValueReference,
    count: usize,
    values: *const f64,
) -> Status {
    // SAFETY: the caller's promise
    unsafe {
        call_evaluating("fmi2SetReal", instance, |instance| {
            let references = array(value_references, count, "vr")?;
            let values = array(values, count, "value")?;
            instance.set(references, values)?;
            Ok(Done::Silently)
        })
    }
}

/// Defines the functions for types that no variable has: they accept empty lists and refuse every variable.
macro_rules! other_types {
    ($($function:ident($asked:literal, $values:ty);)*) => {$(
        #[doc = concat!("Refuses every variable: none is of type ", $asked, ".")]
        ///
        /// # Safety
        ///
        /// `instance` as for every function; the value references have the length that is told.
        #[unsafe(no_mangle)]
        unsafe extern "C" fn $function(
            instance: Opaque,
            value_references: *const ValueReference,
            count: usize,
            _values: $values,
        ) -> Status {
            // SAFETY: the importer's promise
            unsafe {
                call(stringify!($function), instance, |instance| {
                    let references = array(value_references, count, "vr")?;
                    instance.refuse_type(references, $asked)?;
                    Ok(Done::Silently)
                })
            }
        }
    )*};
}

other_types! {
    fmi2GetInteger("Integer", *mut Integer);
    fmi2GetBoolean("Boolean", *mut Boolean);
    fmi2GetString("String", *mut Text);
    fmi2SetInteger("Integer", *const Integer);
    fmi2SetBoolean("Boolean", *const Boolean);
    fmi2SetString("String", *const Text);
}
