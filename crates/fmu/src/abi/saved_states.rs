//! FMU states in the importer's hands: saving, restoring, freeing and serialising them.

use std::mem::MaybeUninit;

use crate::{
    abi::{
        Done, Event, Opaque,
        arguments::{array, array_mut, output},
        handle,
    },
    fmu_state::Snapshot,
    instance::Instance,
    refusal::Refusal,
};

/// Saves the state of the instance: in a new FMU state, or in the one that `state` points to.
///
/// # Safety
///
/// `state` is null or points to a null pointer or to an FMU state of this library.
pub(crate) unsafe fn save(instance: &Instance, state: *mut Opaque) -> Result<Done, Refusal> {
    // SAFETY: the caller's promise
    unsafe { put(state, instance.snapshot()) }
}

/// Restores a saved state.
///
/// # Safety
///
/// `state` is null or an FMU state of this library.
pub(crate) unsafe fn restore(instance: &mut Instance, state: Opaque) -> Result<Done, Refusal> {
    // SAFETY: the caller's promise
    instance.restore(&unsafe { state_of(state) }?.snapshot)?;
    Ok(Done::Event(Event::Restored {
        time_s: instance.time_s(),
    }))
}

/// Frees a saved state and sets the pointer to null; null pointers are ignored.
///
/// # Safety
///
/// `state` is null or points to a null pointer or to an FMU state of this library.
pub(crate) unsafe fn free(state: *mut Opaque) -> Result<Done, Refusal> {
    if state.is_null() {
        return Ok(Done::Silently);
    }
    // SAFETY: the caller's promise
    unsafe {
        let state = initialized(state)?;
        if !state.is_null() {
            if !handle::free_state(*state) {
                return Err(Refusal::ForeignState);
            }
            *state = std::ptr::null_mut();
        }
    }
    Ok(Done::Silently)
}

/// Writes the number of bytes that the serialised state takes to `size`.
///
/// # Safety
///
/// `state` is null or an FMU state of this library; `size` is null or points to one value.
pub(crate) unsafe fn serialized_size(state: Opaque, size: *mut usize) -> Result<Done, Refusal> {
    // SAFETY: the caller's promise
    unsafe {
        let state = state_of(state)?;
        output(size, "size")?.write(state.snapshot.serialize().len());
    }
    Ok(Done::Silently)
}

/// Writes a saved state as bytes.
///
/// # Safety
///
/// `state` is null or an FMU state of this library; `bytes` is null or has the length `size`.
pub(crate) unsafe fn serialize(
    state: Opaque,
    bytes: *mut u8,
    size: usize,
) -> Result<Done, Refusal> {
    // SAFETY: the caller's promise
    let content = unsafe { state_of(state) }?.snapshot.serialize();
    if size != content.len() {
        let expected = content.len();
        return Err(Refusal::Size {
            found: size,
            expected,
        });
    }
    // SAFETY: the caller's promise
    let bytes = unsafe { array_mut(bytes, size, "serializedState") }?;
    for (byte, content) in bytes.iter_mut().zip(content) {
        byte.write(content);
    }
    Ok(Done::Silently)
}

/// Makes an FMU state from bytes that were serialised by this or another instance of the same FMU.
///
/// # Safety
///
/// `bytes` is null or has the length `size`; `state` is null or points to a null pointer or to an FMU state of this
/// library.
pub(crate) unsafe fn deserialize(
    instance: &Instance,
    bytes: *const u8,
    size: usize,
    state: *mut Opaque,
) -> Result<Done, Refusal> {
    // SAFETY: the caller's promise
    unsafe {
        let bytes = array(bytes, size, "serializedState")?;
        put(state, instance.deserialize(bytes)?)
    }
}

/// Puts a snapshot in a new FMU state, or in the one that `state` points to.
///
/// # Safety
///
/// `state` is null or points to a null pointer or to an FMU state of this library.
unsafe fn put(state: *mut Opaque, snapshot: Snapshot) -> Result<Done, Refusal> {
    // SAFETY: the caller's promise
    unsafe {
        let state = initialized(state)?;
        if state.is_null() {
            *state = handle::state_to_c(snapshot);
        } else {
            let existing = handle::state_from_c(*state).ok_or(Refusal::ForeignState)?;
            existing.snapshot = snapshot;
        }
    }
    Ok(Done::Silently)
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
    let state: &mut MaybeUninit<Opaque> = unsafe { output(state, "FMUState") }?;
    // SAFETY: the caller's promise
    Ok(unsafe { state.assume_init_mut() })
}
