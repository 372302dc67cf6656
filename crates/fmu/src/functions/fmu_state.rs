//! FMU states in the importer's hands: saving, restoring, freeing and serialising them.
//!
//! Where an importer hands over a variable for a state, it has set it to null or to a state.

use super::functions;
use crate::{
    abi::{
        Event, Opaque,
        arguments::{array, array_mut, output, variable},
        handle,
    },
    fmu_state::Snapshot,
    refusal::Refusal,
};

/// The importer's name of a state.
const STATE: &str = "FMUState";
/// The importer's name of a state's bytes.
const BYTES: &str = "serializedState";

functions! {
    /// Saves the state of the instance: in a new FMU state, or in the one that `state` points to.
    fmi2GetFMUstate, fmi3GetFMUState(state: *mut Opaque) => |instance| put(state, instance.snapshot());

    /// Restores a saved state, in any state of the state machine.
    fmi2SetFMUstate, fmi3SetFMUState(state: Opaque) => |instance| {
        instance.restore(saved(state)?)?;
        Ok(Event::Restored { time_s: instance.time_s() })
    };

    /// Frees a saved state and sets the pointer to null; a null pointer is ignored.
    fmi2FreeFMUstate, fmi3FreeFMUState(state: *mut Opaque) => |_| free(state);

    /// Number of bytes that the serialised state takes.
    fmi2SerializedFMUstateSize, fmi3SerializedFMUStateSize(state: Opaque, size: *mut usize) => |_| {
        let state = saved(state)?;
        output(size, "size").map(|size| size.write(state.serialize().len()))
    };

    /// Writes a saved state as bytes.
    fmi2SerializeFMUstate, fmi3SerializeFMUState(state: Opaque, bytes: *mut u8, size: usize) => |_| {
        let content = saved(state)?.serialize();
        let expected = content.len();
        if size != expected {
            return Err(Refusal::Size { found: size, expected });
        }
        for (byte, content) in array_mut(bytes, size, BYTES)?.iter_mut().zip(content) {
            byte.write(content);
        }
        Ok(())
    };

    /// Makes an FMU state from bytes that were serialised by this or another instance of the same FMU.
    fmi2DeSerializeFMUstate, fmi3DeserializeFMUState(bytes: *const u8, size: usize, state: *mut Opaque) => |instance| {
        let bytes = array(bytes, size, BYTES)?;
        put(state, instance.deserialize(bytes)?)
    };
}

/// Puts a snapshot in a new FMU state, or in the one that `state` points to.
///
/// # Safety
///
/// `state` is null or points to a null pointer or to an FMU state of this library.
unsafe fn put(state: *mut Opaque, snapshot: Snapshot) -> Result<(), Refusal> {
    // SAFETY: the caller's promise
    unsafe {
        let state = variable(state, STATE)?;
        if state.is_null() {
            *state = handle::state_to_c(snapshot);
        } else {
            let existing = handle::state_from_c(*state).ok_or(Refusal::ForeignState)?;
            existing.snapshot = snapshot;
        }
    }
    Ok(())
}

/// # Safety
///
/// `state` is null or an FMU state of this library.
unsafe fn saved<'a>(state: Opaque) -> Result<&'a Snapshot, Refusal> {
    if state.is_null() {
        return Err(Refusal::NullPointer { argument: STATE });
    }
    // SAFETY: the caller's promise
    let state = unsafe { handle::state_from_c(state) };
    state
        .map(|state| &state.snapshot)
        .ok_or(Refusal::ForeignState)
}

/// # Safety
///
/// As for [`put`].
unsafe fn free(state: *mut Opaque) -> Result<(), Refusal> {
    if state.is_null() {
        return Ok(());
    }
    // SAFETY: the caller's promise
    unsafe {
        let state = variable(state, STATE)?;
        if !state.is_null() {
            if !handle::free_state(*state) {
                return Err(Refusal::ForeignState);
            }
            *state = std::ptr::null_mut();
        }
    }
    Ok(())
}
