//! Saving, restoring and serialising the FMU state.

use std::mem::MaybeUninit;

use crate::{
    fmi3::{
        Done, Event, Opaque,
        arguments::{array, array_mut, output},
        call, handle,
    },
    logging::Status,
    refusal::Refusal,
};

/// Saves the state of the instance: in a new FMU state, or in the one that `state` points to.
///
/// # Safety
///
/// `instance` as for every function; `state` points to a null pointer or to an FMU state of this library.
#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3GetFMUState(instance: Opaque, state: *mut Opaque) -> Status {
    // SAFETY: the importer's promise
    unsafe {
        call("fmi3GetFMUState", instance, |instance| {
            let state = initialized(state)?;
            if state.is_null() {
                *state = handle::state_to_c(instance.snapshot());
            } else {
                let existing = handle::state_from_c(*state).ok_or(Refusal::ForeignState)?;
                existing.snapshot = instance.snapshot();
            }
            Ok(Done::Silently)
        })
    }
}

/// Restores a saved state, in any state of the state machine.
///
/// # Safety
///
/// `instance` as for every function; `state` is an FMU state of this library.
#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3SetFMUState(instance: Opaque, state: Opaque) -> Status {
    // SAFETY: the importer's promise
    unsafe {
        call("fmi3SetFMUState", instance, |instance| {
            instance.restore(&state_of(state)?.snapshot)?;
            Ok(Done::Event(Event::Restored {
                time_s: instance.time_s(),
            }))
        })
    }
}

/// Frees a saved state and sets the pointer to null; a null pointer is ignored.
///
/// # Safety
///
/// `instance` as for every function; `state` points to a null pointer or to an FMU state of this library.
#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3FreeFMUState(instance: Opaque, state: *mut Opaque) -> Status {
    // SAFETY: the importer's promise
    unsafe {
        call("fmi3FreeFMUState", instance, |_| {
            if state.is_null() {
                return Ok(Done::Silently);
            }
            let state = initialized(state)?;
            if !state.is_null() {
                if !handle::free_state(*state) {
                    return Err(Refusal::ForeignState);
                }
                *state = std::ptr::null_mut();
            }
            Ok(Done::Silently)
        })
    }
}

/// Number of bytes that the serialised state takes.
///
/// # Safety
///
/// `instance` as for every function; `state` is an FMU state of this library; `size` points to one value.
#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3SerializedFMUStateSize(
    instance: Opaque,
    state: Opaque,
    size: *mut usize,
) -> Status {
    // SAFETY: the importer's promise
    unsafe {
        call("fmi3SerializedFMUStateSize", instance, |_| {
            let state = state_of(state)?;
            output(size, "size")?.write(state.snapshot.serialized_size());
            Ok(Done::Silently)
        })
    }
}

/// Writes a saved state as bytes.
///
/// # Safety
///
/// `instance` as for every function; `state` is an FMU state of this library; `bytes` has the length that is told.
#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3SerializeFMUState(
    instance: Opaque,
    state: Opaque,
    bytes: *mut u8,
    size: usize,
) -> Status {
    // SAFETY: the importer's promise
    unsafe {
        call("fmi3SerializeFMUState", instance, |_| {
            let content = state_of(state)?.snapshot.serialize();
            if size != content.len() {
                let expected = content.len();
                return Err(Refusal::Size {
                    found: size,
                    expected,
                });
            }
            let bytes = array_mut(bytes, size, "serializedState")?;
            bytes.copy_from_slice(
                &content
                    .into_iter()
                    .map(MaybeUninit::new)
                    .collect::<Vec<_>>(),
            );
            Ok(Done::Silently)
        })
    }
}

/// Makes an FMU state from bytes that were serialised by this or another instance of the same FMU.
///
/// # Safety
///
/// `instance` as for every function; `bytes` has the length that is told; `state` points to a null pointer or to an
/// FMU state of this library.
#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3DeserializeFMUState(
    instance: Opaque,
    bytes: *const u8,
    size: usize,
    state: *mut Opaque,
) -> Status {
    // SAFETY: the importer's promise
    unsafe {
        call("fmi3DeserializeFMUState", instance, |instance| {
            let snapshot = instance.deserialize(array(bytes, size, "serializedState")?)?;
            let state = initialized(state)?;
            if state.is_null() {
                *state = handle::state_to_c(snapshot);
            } else {
                let existing = handle::state_from_c(*state).ok_or(Refusal::ForeignState)?;
                existing.snapshot = snapshot;
            }
            Ok(Done::Silently)
        })
    }
}

/// # Safety
///
/// `state` is null or points to readable memory.
unsafe fn state_of<'a>(state: Opaque) -> Result<&'a handle::StateHandle, Refusal> {
    if state.is_null() {
        return Err(Refusal::NullPointer {
            argument: "FMUState",
        });
    }
    // SAFETY: the caller's promise
    unsafe { handle::state_from_c(state) }
        .map(|state| &*state)
        .ok_or(Refusal::ForeignState)
}

/// The importer's variable for an FMU state, which it has set to null or to an FMU state.
///
/// # Safety
///
/// `state` is null or points to such a variable.
unsafe fn initialized<'a>(state: *mut Opaque) -> Result<&'a mut Opaque, Refusal> {
    // SAFETY: the caller's promise: the variable has a value
    Ok(unsafe { output(state, "FMUState")?.assume_init_mut() })
}
