//! What an `fmi3Instance` and an `fmi3FMUState` point to.

use crate::{fmi3::Opaque, fmu_state::Snapshot, instance::Instance, logging::Logger};

/// Marks a living instance: "bjinst" and a version.
const INSTANCE: u64 = 0x626a_696e_7374_0003;
/// Marks a living FMU state: "bjstat" and a version.
const STATE: u64 = 0x626a_7374_6174_0003;
/// Left behind in what was freed.
const FREED: u64 = 0;

/// What an `fmi3Instance` points to.
#[repr(C)]
pub(super) struct Handle {
    mark: u64,
    pub(super) instance: Instance,
    pub(super) logger: Logger,
}

/// What an `fmi3FMUState` points to.
#[repr(C)]
pub(super) struct StateHandle {
    mark: u64,
    pub(super) snapshot: Snapshot,
}

/// Hands an instance over to the importer.
pub(super) fn to_c(instance: Instance, logger: Logger) -> Opaque {
    Box::into_raw(Box::new(Handle {
        mark: INSTANCE,
        instance,
        logger,
    }))
    .cast()
}

/// The instance behind the importer's pointer, or `None` for a null pointer and for what is not an instance.
///
/// # Safety
///
/// `handle` is null or points to readable memory; if that is an instance, nothing else refers to it.
#[inline]
pub(super) unsafe fn from_c<'a>(handle: Opaque) -> Option<&'a mut Handle> {
    let handle = handle.cast::<Handle>();
    if handle.is_null() || !handle.is_aligned() {
        return None;
    }
    // SAFETY: the mark comes first (repr(C)) and is readable, by the caller's promise
    if unsafe { (&raw const (*handle).mark).read() } != INSTANCE {
        return None;
    }
    // SAFETY: the mark says that this is an instance, to which the caller has the only pointer
    Some(unsafe { &mut *handle })
}

/// Frees an instance; nothing happens to a null pointer and to what is not an instance.
///
/// # Safety
///
/// As for [`from_c`]; the pointer must not be used again.
pub(super) unsafe fn free(handle: Opaque) {
    // SAFETY: the caller's promise
    if let Some(handle) = unsafe { from_c(handle) } {
        handle.mark = FREED;
        // SAFETY: made by Box::into_raw in `to_c`
        drop(unsafe { Box::from_raw(handle) });
    }
}

/// Hands an FMU state over to the importer.
pub(super) fn state_to_c(snapshot: Snapshot) -> Opaque {
    Box::into_raw(Box::new(StateHandle {
        mark: STATE,
        snapshot,
    }))
    .cast()
}

/// The FMU state behind the importer's pointer, or `None` for a null pointer and for what is not an FMU state.
///
/// # Safety
///
/// `state` is null or points to readable memory; if that is an FMU state, nothing else refers to it.
pub(super) unsafe fn state_from_c<'a>(state: Opaque) -> Option<&'a mut StateHandle> {
    let state = state.cast::<StateHandle>();
    if state.is_null() || !state.is_aligned() {
        return None;
    }
    // SAFETY: the mark comes first (repr(C)) and is readable, by the caller's promise
    if unsafe { (&raw const (*state).mark).read() } != STATE {
        return None;
    }
    // SAFETY: the mark says that this is an FMU state, to which the caller has the only pointer
    Some(unsafe { &mut *state })
}

/// Frees an FMU state; tells whether it was one.
///
/// # Safety
///
/// As for [`state_from_c`]; the pointer must not be used again.
pub(super) unsafe fn free_state(state: Opaque) -> bool {
    // SAFETY: the caller's promise
    let Some(state) = (unsafe { state_from_c(state) }) else {
        return false;
    };
    state.mark = FREED;
    // SAFETY: made by Box::into_raw in `state_to_c`
    drop(unsafe { Box::from_raw(state) });
    true
}
