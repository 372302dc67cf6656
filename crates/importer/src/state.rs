//! Saved states of an instance.

use std::ptr;
use std::rc::Rc;

use crate::error::ImportError;
use crate::header::Opaque;
use crate::instance::{Handle, Instance};

/// A state that an instance can go back to; the FMU is told to free it when it is dropped.
pub struct SavedState<'l> {
    pointer: Opaque,
    /// Keeps the instance until its states are freed.
    owner: Rc<Handle<'l>>,
}

impl Drop for SavedState<'_> {
    fn drop(&mut self) {
        let free = self.owner.library.functions.free_state.function;
        // SAFETY: both were made by this library and live; a refusal changes nothing
        unsafe { free(self.owner.pointer, &raw mut self.pointer) };
    }
}

impl<'l> Instance<'l> {
    /// Saves the present state.
    ///
    /// # Errors
    ///
    /// [`ImportError::Refused`], [`ImportError::Null`].
    pub fn save(&mut self) -> Result<SavedState<'l>, ImportError> {
        let get = self.functions().get_state;
        let mut pointer = ptr::null_mut();
        // SAFETY: the instance lives, the pointer is to a local
        self.call(get.name, || unsafe {
            (get.function)(self.handle.pointer, &raw mut pointer)
        })?;
        self.owned(get.name, pointer)
    }

    /// Goes back to a state that was saved from an instance of the same library.
    ///
    /// # Errors
    ///
    /// [`ImportError::ForeignState`], [`ImportError::Refused`].
    pub fn restore(&mut self, state: &SavedState<'_>) -> Result<(), ImportError> {
        let set = self.functions().set_state;
        self.check_owner(set.name, state)?;
        // SAFETY: instance and state live and belong to one library
        self.call(set.name, || unsafe {
            (set.function)(self.handle.pointer, state.pointer)
        })
    }

    /// The state as bytes.
    ///
    /// # Errors
    ///
    /// [`ImportError::ForeignState`], [`ImportError::Refused`].
    pub fn serialize(&mut self, state: &SavedState<'_>) -> Result<Vec<u8>, ImportError> {
        let (size_of, serialize) = (
            self.functions().state_size,
            self.functions().serialize_state,
        );
        self.check_owner(size_of.name, state)?;
        let mut size = 0;
        // SAFETY: instance and state live and belong to one library, the pointer is to a local
        self.call(size_of.name, || unsafe {
            (size_of.function)(self.handle.pointer, state.pointer, &raw mut size)
        })?;
        let mut bytes = vec![0; size];
        let target = bytes.as_mut_ptr();
        // SAFETY: as above, and the bytes have the size that is told
        self.call(serialize.name, || unsafe {
            (serialize.function)(self.handle.pointer, state.pointer, target, size)
        })?;
        Ok(bytes)
    }

    /// The state that [`Instance::serialize`] made `bytes` of.
    ///
    /// # Errors
    ///
    /// [`ImportError::Refused`], [`ImportError::Null`].
    pub fn deserialize(&mut self, bytes: &[u8]) -> Result<SavedState<'l>, ImportError> {
        let deserialize = self.functions().deserialize_state;
        let mut pointer = ptr::null_mut();
        let (start, size) = (bytes.as_ptr(), bytes.len());
        // SAFETY: the instance lives, pointer and size are those of a slice
        self.call(deserialize.name, || unsafe {
            (deserialize.function)(self.handle.pointer, start, size, &raw mut pointer)
        })?;
        self.owned(deserialize.name, pointer)
    }

    fn owned(
        &self,
        function: &'static str,
        pointer: Opaque,
    ) -> Result<SavedState<'l>, ImportError> {
        if pointer.is_null() {
            let messages = Vec::new();
            return Err(ImportError::Null { function, messages });
        }
        Ok(SavedState {
            pointer,
            owner: Rc::clone(&self.handle),
        })
    }

    fn check_owner(
        &self,
        function: &'static str,
        state: &SavedState<'_>,
    ) -> Result<(), ImportError> {
        if ptr::eq(state.owner.library, self.handle.library) {
            Ok(())
        } else {
            Err(ImportError::ForeignState { function })
        }
    }
}
