//! What the importer may ask about communication steps (FMI 2.0, 4.2.3).

use std::{ffi::c_int, mem::MaybeUninit};

use crate::{
    fmi2::{Boolean, Done, FALSE, Integer, Opaque, TRUE, Text, arguments::output, call_for},
    instance::Instance,
    interface::InterfaceType,
    logging::Status,
    mode::Mode,
    refusal::Refusal,
};

/// `fmi2LastSuccessfulTime` of `fmi2StatusKind`.
const LAST_SUCCESSFUL_TIME: c_int = 2;
/// `fmi2Terminated` of `fmi2StatusKind`.
const TERMINATED: c_int = 3;

/// Runs `answer` where it is allowed to ask, with the importer's variable for the answer.
///
/// # Safety
///
/// As for [`crate::abi::call`]; `value` is null or points to one value.
unsafe fn ask<T>(
    function: &'static str,
    instance: Opaque,
    value: *mut T,
    answer: impl FnOnce(&Instance, &mut MaybeUninit<T>) -> Result<(), Refusal>,
) -> Status {
    // SAFETY: the caller's promise
    unsafe {
        call_for(
            InterfaceType::CoSimulation,
            function,
            instance,
            |instance| {
                instance.require(&[Mode::Step, Mode::Terminated])?;
                answer(instance, output(value, "value")?)?;
                Ok(Done::Silently)
            },
        )
    }
}

/// Time that the latest communication step has reached.
///
/// # Safety
///
/// `instance` as for every function; `value` points to one value.
#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2GetRealStatus(instance: Opaque, kind: c_int, value: *mut f64) -> Status {
    // SAFETY: the importer's promise
    unsafe {
        ask("fmi2GetRealStatus", instance, value, |instance, value| {
            if kind != LAST_SUCCESSFUL_TIME {
                return Err(Refusal::NoStatus { kind });
            }
            value.write(instance.time_s());
            Ok(())
        })
    }
}

/// Whether the simulation has ended, be it by a step that failed.
///
/// # Safety
///
/// `instance` as for every function; `value` points to one value.
#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2GetBooleanStatus(
    instance: Opaque,
    kind: c_int,
    value: *mut Boolean,
) -> Status {
    // SAFETY: the importer's promise
    unsafe {
        ask(
            "fmi2GetBooleanStatus",
            instance,
            value,
            |instance, value| {
                if kind != TERMINATED {
                    return Err(Refusal::NoStatus { kind });
                }
                let has_ended = instance.mode() == Mode::Terminated;
                value.write(if has_ended { TRUE } else { FALSE });
                Ok(())
            },
        )
    }
}

/// Defines the functions that have nothing to tell, because no step is ever pending.
macro_rules! nothing_to_tell {
    ($($function:ident($value:ty);)*) => {$(
        #[doc = "Answers `fmi2Discard`: there is no such status."]
        ///
        /// # Safety
        ///
        /// `instance` as for every function; `value` points to one value.
        #[unsafe(no_mangle)]
        unsafe extern "C" fn $function(
            instance: Opaque,
            kind: c_int,
            value: *mut $value,
        ) -> Status {
            // SAFETY: the importer's promise
            unsafe {
                ask(stringify!($function), instance, value, |_, _| {
                    Err(Refusal::NoStatus { kind })
                })
            }
        }
    )*};
}

nothing_to_tell! {
    fmi2GetStatus(c_int);
    fmi2GetIntegerStatus(Integer);
    fmi2GetStringStatus(Text);
}
