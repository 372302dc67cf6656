//! What the importer may ask about communication steps (FMI 2.0, 4.2.3).

use std::ffi::c_int;

use super::{Fmi2Boolean, Fmi2Integer, functions};
use crate::{
    abi::{
        Text,
        arguments::{Output, output},
    },
    instance::Instance,
    mode::Mode,
    refusal::Refusal,
};

/// `fmi2LastSuccessfulTime` of `fmi2StatusKind`.
const LAST_SUCCESSFUL_TIME: c_int = 2;
/// `fmi2Terminated` of `fmi2StatusKind`.
const TERMINATED: c_int = 3;

functions! {
    /// Time that the latest communication step has reached.
    fmi2GetRealStatus(kind: c_int, value: *mut f64) for STEPPING => |instance| {
        let value = answer(instance, value)?;
        only(kind, LAST_SUCCESSFUL_TIME)?;
        value.write(instance.time_s());
        Ok(())
    };

    /// Whether the simulation has ended, be it by a step that failed.
    fmi2GetBooleanStatus(kind: c_int, value: *mut Fmi2Boolean) for STEPPING => |instance| {
        let value = answer(instance, value)?;
        only(kind, TERMINATED)?;
        value.write((instance.mode() == Mode::Terminated).into());
        Ok(())
    };

    /// Answers `fmi2Discard`: there is no such status, because no step is ever pending.
    fmi2GetStatus(kind: c_int, value: *mut c_int) for STEPPING =>
        |instance| nothing_to_tell(instance, kind, value);
    /// Answers `fmi2Discard`: there is no such status, because no step is ever pending.
    fmi2GetIntegerStatus(kind: c_int, value: *mut Fmi2Integer) for STEPPING =>
        |instance| nothing_to_tell(instance, kind, value);
    /// Answers `fmi2Discard`: there is no such status, because no step is ever pending.
    fmi2GetStringStatus(kind: c_int, value: *mut Text) for STEPPING =>
        |instance| nothing_to_tell(instance, kind, value);

    /// Refuses: there is never a step under way that could be cancelled.
    fmi2CancelStep() for STEPPING => |instance| Err::<(), _>(Refusal::NoStepUnderWay { mode: instance.mode() });
}

/// The importer's variable for the answer, where it is allowed to ask.
///
/// # Safety
///
/// As for [`output`].
unsafe fn answer<T>(instance: &Instance, value: *mut T) -> Result<Output<T>, Refusal> {
    instance.require(&[Mode::Step, Mode::Terminated])?;
    // SAFETY: the caller's promise
    unsafe { output(value, "value") }
}

/// Refuses statuses of another kind.
fn only(kind: c_int, expected: c_int) -> Result<(), Refusal> {
    if kind == expected {
        Ok(())
    } else {
        Err(Refusal::NoStatus { kind })
    }
}

/// # Safety
///
/// As for [`output`].
unsafe fn nothing_to_tell<T>(
    instance: &Instance,
    kind: c_int,
    value: *mut T,
) -> Result<(), Refusal> {
    // SAFETY: the caller's promise
    unsafe { answer(instance, value) }?;
    Err(Refusal::NoStatus { kind })
}
