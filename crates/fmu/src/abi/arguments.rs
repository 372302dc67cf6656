//! Checked conversion of C arguments.

use std::{ffi::CStr, mem::MaybeUninit, slice};

use crate::{abi::Text, refusal::Refusal};

/// The array that a pointer and a length stand for.
///
/// # Safety
///
/// If `pointer` is not null it points to `length` values that nobody changes for as long as the slice is used.
#[inline]
pub(crate) unsafe fn array<'a, T>(
    pointer: *const T,
    length: usize,
    argument: &'static str,
) -> Result<&'a [T], Refusal> {
    if length == 0 {
        return Ok(&[]);
    }
    check(pointer, length, argument)?;
    // SAFETY: not null, aligned, not larger than memory; the rest is the caller's promise
    Ok(unsafe { slice::from_raw_parts(pointer, length) })
}

/// The array to write to that a pointer and a length stand for.
///
/// # Safety
///
/// If `pointer` is not null it points to writable memory for `length` values that nobody else uses meanwhile.
#[inline]
pub(crate) unsafe fn array_mut<'a, T>(
    pointer: *mut T,
    length: usize,
    argument: &'static str,
) -> Result<&'a mut [MaybeUninit<T>], Refusal> {
    if length == 0 {
        return Ok(&mut []);
    }
    check(pointer, length, argument)?;
    // SAFETY: not null, aligned, not larger than memory; the rest is the caller's promise
    Ok(unsafe { slice::from_raw_parts_mut(pointer.cast(), length) })
}

/// A single value of the importer's to write to. It is no reference: two results may go to the same place.
#[derive(Clone, Copy)]
pub(crate) struct Output<T>(*mut T);

impl<T> Output<T> {
    #[inline]
    pub(crate) fn write(self, value: T) {
        // SAFETY: not null and aligned; the rest is the promise of whoever asked for it with `output`
        unsafe { self.0.write(value) };
    }
}

/// The single value to write to.
///
/// # Safety
///
/// If `pointer` is not null it points to writable memory for one value, for as long as the output is used.
#[inline]
pub(crate) unsafe fn output<T>(
    pointer: *mut T,
    argument: &'static str,
) -> Result<Output<T>, Refusal> {
    check(pointer, 1, argument)?;
    Ok(Output(pointer))
}

/// The single values to write to, all or none.
///
/// # Safety
///
/// As for [`output`].
#[inline]
pub(crate) unsafe fn outputs<T, const N: usize>(
    pointers: [(*mut T, &'static str); N],
) -> Result<[Output<T>; N], Refusal> {
    for (pointer, argument) in pointers {
        check(pointer, 1, argument)?;
    }
    Ok(pointers.map(|(pointer, _)| Output(pointer)))
}

/// The single value that is read and written to.
///
/// # Safety
///
/// If `pointer` is not null it points to a value that nobody else uses meanwhile.
pub(crate) unsafe fn variable<'a, T>(
    pointer: *mut T,
    argument: &'static str,
) -> Result<&'a mut T, Refusal> {
    check(pointer, 1, argument)?;
    // SAFETY: not null and aligned; the rest is the caller's promise
    Ok(unsafe { &mut *pointer })
}

/// A string, or `None` for a null pointer.
///
/// # Safety
///
/// If `text` is not null it points to a terminated string that nobody changes for as long as it is used.
pub(crate) unsafe fn optional_text<'a>(
    text: Text,
    argument: &'static str,
) -> Result<Option<&'a str>, Refusal> {
    if text.is_null() {
        return Ok(None);
    }
    // SAFETY: the caller's promise
    let text = unsafe { CStr::from_ptr(text) };
    text.to_str()
        .map(Some)
        .map_err(|_| Refusal::NotUtf8 { argument })
}

/// A string.
///
/// # Safety
///
/// As for [`optional_text`].
pub(crate) unsafe fn text<'a>(text: Text, argument: &'static str) -> Result<&'a str, Refusal> {
    // SAFETY: the caller's promise
    unsafe { optional_text(text, argument) }?.ok_or(Refusal::NullPointer { argument })
}

#[inline]
fn check<T>(pointer: *const T, length: usize, argument: &'static str) -> Result<(), Refusal> {
    if pointer.is_null() {
        return Err(Refusal::NullPointer { argument });
    }
    // the longest array that memory can hold
    if !pointer.is_aligned() || length > isize::MAX as usize / size_of::<T>() {
        return Err(Refusal::BadArray { argument });
    }
    Ok(())
}

/// Refuses arrays that belong together but differ in length.
#[inline]
pub(crate) fn same_count(
    argument: &'static str,
    found: usize,
    expected: usize,
) -> Result<(), Refusal> {
    if found == expected {
        Ok(())
    } else {
        Err(Refusal::Count {
            argument,
            found,
            expected,
        })
    }
}
