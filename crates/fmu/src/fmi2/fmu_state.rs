//! Saving, restoring and serialising the FMU state.

use crate::{
    abi::saved_states,
    fmi2::{Opaque, call},
    logging::Status,
};

/// Saves the state of the instance: in a new FMU state, or in the one that `state` points to.
///
/// # Safety
///
/// `instance` as for every function; `state` points to a null pointer or to an FMU state of this library.
#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2GetFMUstate(instance: Opaque, state: *mut Opaque) -> Status {
    // SAFETY: the importer's promise
    unsafe {
        call("fmi2GetFMUstate", instance, |instance| {
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
unsafe extern "C" fn fmi2SetFMUstate(instance: Opaque, state: Opaque) -> Status {
    // SAFETY: the importer's promise
    unsafe {
        call("fmi2SetFMUstate", instance, |instance| {
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
unsafe extern "C" fn fmi2FreeFMUstate(instance: Opaque, state: *mut Opaque) -> Status {
    // SAFETY: the importer's promise
    unsafe { call("fmi2FreeFMUstate", instance, |_| saved_states::free(state)) }
}

/// Number of bytes that the serialised state takes.
///
/// # Safety
///
/// `instance` as for every function; `state` is an FMU state of this library; `size` points to one value.
#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2SerializedFMUstateSize(
    instance: Opaque,
    state: Opaque,
    size: *mut usize,
) -> Status {
    // SAFETY: the importer's promise
    unsafe {
        call("fmi2SerializedFMUstateSize", instance, |_| {
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
unsafe extern "C" fn fmi2SerializeFMUstate(
    instance: Opaque,
    state: Opaque,
    bytes: *mut u8,
    size: usize,
) -> Status {
    // SAFETY: the importer's promise
    unsafe {
        call("fmi2SerializeFMUstate", instance, |_| {
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
unsafe extern "C" fn fmi2DeSerializeFMUstate(
    instance: Opaque,
    bytes: *const u8,
    size: usize,
    state: *mut Opaque,
) -> Status {
    // SAFETY: the importer's promise
    unsafe {
        call("fmi2DeSerializeFMUstate", instance, |instance| {
            saved_states::deserialize(instance, bytes, size, state)
        })
    }
}
