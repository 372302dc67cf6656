//! What an instance and an FMU state of the importer point to.

use std::{
    collections::BTreeSet,
    ffi::c_void,
    sync::{Mutex, MutexGuard, PoisonError},
};

use crate::{
    abi::Opaque, fmu_state::Snapshot, instance::Instance, logging::Logger, models::MODEL_SIZE_MAX,
    version::Abi,
};

/// `fmi3Boolean`: a C `bool`, taken as a byte so that no value of it is undefined behaviour.
pub(crate) type Fmi3Boolean = u8;

/// `fmi3IntermediateUpdateCallback`.
pub(crate) type IntermediateUpdateCallback = unsafe extern "C" fn(
    environment: *mut c_void,
    intermediate_update_time: f64,
    intermediate_variable_set_requested: Fmi3Boolean,
    intermediate_variable_get_allowed: Fmi3Boolean,
    intermediate_step_finished: Fmi3Boolean,
    can_return_early: Fmi3Boolean,
    early_return_requested: *mut Fmi3Boolean,
    early_return_time: *mut f64,
);

/// How the importer takes part in communication steps.
#[derive(Clone, Copy, Debug)]
pub(crate) struct IntermediateUpdate {
    pub(crate) callback: IntermediateUpdateCallback,
    pub(crate) environment: *mut c_void,
    pub(crate) early_return_allowed: bool,
}

/// Addresses of the FMU states that live: an importer's pointer is looked up before anything is read through it.
static STATES: Mutex<BTreeSet<usize>> = Mutex::new(BTreeSet::new());

fn living() -> MutexGuard<'static, BTreeSet<usize>> {
    // the set is whole whatever a thread has done that stopped
    STATES.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Left behind in what was freed.
const FREED: u64 = 0;

/// Marks a living instance of FMI 3.0 while its importer's callback has the word within a communication step.
const INSIDE_STEP: u64 = 0x626a_7374_6570_0003;

impl Abi {
    /// Marks a living instance that was made by this version's functions: "bjinst" and the version.
    #[inline]
    const fn mark(self) -> u64 {
        match self {
            Self::Fmi2 => 0x626a_696e_7374_0002,
            Self::Fmi3 => 0x626a_696e_7374_0003,
        }
    }
}

/// What an `fmi2Component` or `fmi3Instance` points to.
#[repr(C)]
pub(crate) struct Handle {
    mark: u64,
    pub(crate) instance: Instance,
    pub(crate) logger: Logger,
    pub(crate) intermediate_update: Option<IntermediateUpdate>,
}

// an instance takes this memory, and what its model is prepared for
const _: () = assert!(size_of::<Handle>() + MODEL_SIZE_MAX <= 11 << 10);

/// What an `fmi2FMUstate` or `fmi3FMUState` points to.
pub(crate) struct StateHandle {
    pub(crate) snapshot: Snapshot,
}

/// Hands an instance over to the importer.
pub(crate) fn to_c(abi: Abi, instance: Instance, logger: Logger) -> Opaque {
    Box::into_raw(Box::new(Handle {
        mark: abi.mark(),
        instance,
        logger,
        intermediate_update: None,
    }))
    .cast()
}

/// The instance behind the importer's pointer, or `None` for a null pointer and for what is not an instance that was
/// made by functions of this version.
///
/// # Safety
///
/// `handle` is null or points to readable memory; if that is an instance, nothing else refers to it.
#[inline]
pub(crate) unsafe fn from_c<'a>(abi: Abi, handle: Opaque) -> Option<&'a mut Handle> {
    let handle = handle.cast::<Handle>();
    if handle.is_null() || !handle.is_aligned() {
        return None;
    }
    // SAFETY: the mark comes first (repr(C)) and is readable, by the caller's promise
    if unsafe { (&raw const (*handle).mark).read() } != abi.mark() {
        return None;
    }
    // SAFETY: the mark says that this is an instance, to which the caller has the only pointer
    Some(unsafe { &mut *handle })
}

/// The instance behind the importer's pointer also while the importer's callback has the word within a communication
/// step, for the functions that are allowed there.
///
/// # Safety
///
/// As for [`from_c`].
#[inline]
pub(crate) unsafe fn from_c_inside<'a>(abi: Abi, handle: Opaque) -> Option<&'a mut Handle> {
    // SAFETY: the caller's promise
    unsafe {
        match from_c(abi, handle) {
            None if is_inside_step(abi, handle) => Some(&mut *handle.cast::<Handle>()),
            found => found,
        }
    }
}

/// Whether this is an instance whose importer's callback has the word within a communication step.
///
/// # Safety
///
/// As for [`from_c`].
#[cold]
pub(crate) unsafe fn is_inside_step(abi: Abi, handle: Opaque) -> bool {
    let handle = handle.cast::<Handle>();
    if abi != Abi::Fmi3 || handle.is_null() || !handle.is_aligned() {
        return false;
    }
    // SAFETY: the mark comes first (repr(C)) and is readable, by the caller's promise
    unsafe { (&raw const (*handle).mark).read() == INSIDE_STEP }
}

impl Handle {
    /// From now on only the functions that are allowed within a communication step reach the instance, or all again.
    pub(crate) fn set_inside_step(&mut self, inside: bool) {
        self.mark = if inside {
            INSIDE_STEP
        } else {
            Abi::Fmi3.mark()
        };
    }
}

/// Frees an instance; nothing happens to a null pointer and to what is not an instance of this version.
///
/// # Safety
///
/// As for [`from_c`]; the pointer must not be used again.
pub(crate) unsafe fn free(abi: Abi, handle: Opaque) -> bool {
    // SAFETY: the caller's promise
    let Some(handle) = (unsafe { from_c(abi, handle) }) else {
        return false;
    };
    handle.mark = FREED;
    // SAFETY: made by Box::into_raw in `to_c`
    drop(unsafe { Box::from_raw(handle) });
    true
}

/// Hands an FMU state over to the importer.
pub(crate) fn state_to_c(snapshot: Snapshot) -> Opaque {
    let state: Opaque = Box::into_raw(Box::new(StateHandle { snapshot })).cast();
    living().insert(state as usize);
    state
}

/// The FMU state behind the importer's pointer, or `None` for a pointer to anything else, which need not even be readable: to
/// nothing, to what is freed, to a state of another FMU.
///
/// What cannot be known: a freed state whose memory a later one took is that later one.
///
/// # Safety
///
/// If `state` is an FMU state, nothing else refers to it.
pub(crate) unsafe fn state_from_c<'a>(state: Opaque) -> Option<&'a mut StateHandle> {
    if !living().contains(&(state as usize)) {
        return None;
    }
    // SAFETY: made by `state_to_c` and not freed, and the caller has the only pointer to it
    Some(unsafe { &mut *state.cast::<StateHandle>() })
}

/// Frees an FMU state; tells whether it was one.
///
/// # Safety
///
/// As for [`state_from_c`]; the pointer must not be used again.
pub(crate) unsafe fn free_state(state: Opaque) -> bool {
    let mut states = living();
    if !states.remove(&(state as usize)) {
        return false;
    }
    if states.is_empty() {
        // leaves no memory behind when the library is unloaded
        *states = BTreeSet::new();
    }
    drop(states);
    // SAFETY: made by Box::into_raw in `state_to_c`, and the last that knew it
    drop(unsafe { Box::from_raw(state.cast::<StateHandle>()) });
    true
}
