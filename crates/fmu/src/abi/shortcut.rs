//! The short way through the calls that an importer makes for every communication step.
//!
//! It checks what the long way checks, with fewer instructions, because it has nothing to say: where anything is not as
//! it nearly always is, it does nothing and leaves the call to the long way, which deals with it or says why not.

use std::{
    mem::MaybeUninit,
    panic::{AssertUnwindSafe, catch_unwind},
    slice,
};

use crate::{
    abi::{
        Opaque, ValueReference,
        handle::{self, Handle},
    },
    interface::REFERENCE_COUNT,
    version::Abi,
};

/// Runs `body` on the instance behind `instance`, and tells whether it has done all that was asked.
///
/// # Safety
///
/// As for [`crate::abi::call`].
#[inline]
pub(crate) unsafe fn taken(
    abi: Abi,
    instance: Opaque,
    body: impl FnOnce(&mut Handle) -> bool,
) -> bool {
    // SAFETY: the caller's promise
    match unsafe { handle::from_c(abi, instance) } {
        Some(handle) => matches!(catch_unwind(AssertUnwindSafe(|| body(handle))), Ok(true)),
        None => false,
    }
}

/// Value references and as many values, if there are some but no more than an FMU has variables, and at sound addresses.
///
/// # Safety
///
/// If the pointers are not null they point to `count` values that nobody changes for as long as the slices are used.
#[inline]
pub(crate) unsafe fn arrays<'a>(
    references: *const ValueReference,
    values: *const f64,
    count: usize,
) -> Option<(&'a [ValueReference], &'a [f64])> {
    // SAFETY: sound addresses, a small size; the rest is the caller's promise
    are_sound(references, values, count).then(|| unsafe {
        (
            slice::from_raw_parts(references, count),
            slice::from_raw_parts(values, count),
        )
    })
}

/// Value references and room for as many values, like [`arrays`].
///
/// # Safety
///
/// As for [`arrays`]; the values are writable, and nobody else uses them meanwhile.
#[inline]
pub(crate) unsafe fn arrays_mut<'a>(
    references: *const ValueReference,
    values: *mut f64,
    count: usize,
) -> Option<(&'a [ValueReference], &'a mut [MaybeUninit<f64>])> {
    // SAFETY: sound addresses, a small size; the rest is the caller's promise
    are_sound(references, values, count).then(|| unsafe {
        (
            slice::from_raw_parts(references, count),
            slice::from_raw_parts_mut(values.cast(), count),
        )
    })
}

#[inline]
fn are_sound(references: *const ValueReference, values: *const f64, count: usize) -> bool {
    (1..=REFERENCE_COUNT).contains(&count)
        && !references.is_null()
        && references.is_aligned()
        && !values.is_null()
        && values.is_aligned()
}
