//! Arrays for C, right and wrong: null, misaligned, too short, and of lengths that no memory holds.

use std::{
    ffi::{CStr, c_char},
    ptr,
};

use super::choices::Choices;

/// Lengths that no array has: in bytes they exceed `isize::MAX`, whatever the type.
const HUGE: [usize; 2] = [usize::MAX, usize::MAX / 2 + 1];

/// Draws the arguments of one call and remembers whether all of them are right.
pub(crate) struct Arguments<'c, 'b> {
    pub(crate) choices: &'c mut Choices<'b>,
    /// Whether wrong arguments may come.
    pub(crate) wild: bool,
    /// No argument so far is wrong.
    pub(crate) right: bool,
}

impl<'c, 'b> Arguments<'c, 'b> {
    /// Arguments for one call; every fourth call may get wrong ones.
    pub(crate) fn new(choices: &'c mut Choices<'b>) -> Self {
        let wild = choices.one_in(4);
        Self {
            choices,
            wild,
            right: true,
        }
    }

    /// Whether to do something wrong now, about once in `n` arguments of a wild call.
    pub(crate) fn wrong(&mut self, n: usize) -> bool {
        let wrong = self.wild && self.choices.one_in(n);
        self.right &= !wrong;
        wrong
    }

    /// Whether to do something now that is unusual but allowed.
    pub(crate) fn unusual(&mut self, n: usize) -> bool {
        self.wild && self.choices.one_in(n)
    }

    /// An array whose memory ends with its last element, so that a sanitizer sees any access beyond.
    pub(crate) fn array<T: Copy>(&mut self, content: impl Into<Box<[T]>>) -> Array<T> {
        let mut data = content.into();
        let mut pointer = data.as_mut_ptr();
        let mut count = data.len();
        if self.wrong(16) {
            match self.choices.below(4) {
                0 => pointer = ptr::null_mut(),
                1 if align_of::<T>() > 1 => pointer = pointer.wrapping_byte_add(1),
                // not to an empty list, which may be accepted in any mode
                2 if count > 1 => count -= 1,
                _ => count = self.choices.pick(&HUGE),
            }
        }
        Array {
            data,
            pointer,
            count,
        }
    }

    /// One value for the library to write to.
    pub(crate) fn output<T: Copy>(&mut self, before: T) -> Array<T> {
        let mut array = Array {
            data: [before].into(),
            pointer: ptr::null_mut(),
            count: 1,
        };
        if !self.wrong(16) {
            array.pointer = array.data.as_mut_ptr();
        }
        array
    }

    /// A double: moderate, or any.
    pub(crate) fn number(&mut self) -> f64 {
        if self.wrong(6) {
            self.choices.any_number()
        } else {
            self.choices.moderate_number()
        }
    }

    /// The right text, or another one, or null.
    pub(crate) fn text(&mut self, right: &'static CStr) -> *const c_char {
        const WRONG: [&CStr; 6] = [
            c"",
            c" ",
            c"\xff\xfe not UTF-8",
            c"something else",
            c"file:///%zz/nowhere%",
            c"/nowhere/at/all/",
        ];
        if !self.wrong(8) {
            return right.as_ptr();
        }
        match self.choices.below(7) {
            0 => ptr::null(),
            other => WRONG[other - 1].as_ptr(),
        }
    }

    /// A byte for a C `bool`; not only 0 and 1.
    pub(crate) fn flag(&mut self) -> u8 {
        if self.unusual(8) {
            self.choices.below(256) as u8
        } else {
            self.choices.below(2) as u8
        }
    }
}

/// Memory, and how the library is told of it.
pub(crate) struct Array<T> {
    data: Box<[T]>,
    pointer: *mut T,
    count: usize,
}

impl<T> Array<T> {
    /// The pointer to hand over.
    pub(crate) fn pointer(&self) -> *mut T {
        self.pointer
    }

    /// The length to hand over.
    pub(crate) fn count(&self) -> usize {
        self.count
    }

    /// What the memory holds now.
    pub(crate) fn content(&self) -> &[T] {
        &self.data
    }
}
