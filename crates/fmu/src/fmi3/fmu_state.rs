//! Saving, restoring and serialising the FMU state.

use crate::{
    abi::saved_states,
    fmi3::{Opaque, call},
    logging::Status,
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
            saved_states::save(instance, state)
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
            saved_states::restore(instance, state)
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
    unsafe { call("fmi3FreeFMUState", instance, |_| saved_states::free(state)) }
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
            saved_states::serialized_size(state, size)
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
            saved_states::serialize(state, bytes, size)
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
            saved_states::deserialize(instance, bytes, size, state)
        })
    }
}
