//! Saved states of an instance.

use std::ptr;
use std::rc::Rc;

use crate::abi::Opaque;
use crate::error::ImportError;
use crate::instance::{Handle, Instance};
use crate::library::Functions;

/// A state that an instance can go back to; the FMU is told to free it when it is dropped.
pub struct SavedState<'l> {
    pointer: Opaque,
    /// Keeps the instance until its states are freed.
    owner: Rc<Handle<'l>>,
}

impl Drop for SavedState<'_> {
    fn drop(&mut self) {
        let instance = self.owner.pointer;
        // SAFETY: both were made by this library and live; a refusal changes nothing
        unsafe {
            match &self.owner.library.functions {
                Functions::Three(functions) => {
                    (functions.free_state)(instance, &raw mut self.pointer)
                }
                Functions::Two(functions) => {
                    (functions.free_state)(instance, &raw mut self.pointer)
                }
            }
        };
    }
}

impl<'l> Instance<'l> {
    /// Saves the present state.
    ///
    /// # Errors
    ///
    /// [`ImportError::Refused`], [`ImportError::Null`].
    pub fn save(&mut self) -> Result<SavedState<'l>, ImportError> {
        let (function, get) = match self.functions() {
            Functions::Three(functions) => ("fmi3GetFMUState", functions.get_state),
            Functions::Two(functions) => ("fmi2GetFMUstate", functions.get_state),
        };
        let mut pointer = ptr::null_mut();
        // SAFETY: the instance lives, the pointer is to a local
        self.call(function, || unsafe {
            get(self.handle.pointer, &raw mut pointer)
        })?;
        self.owned(function, pointer)
    }

    /// Goes back to a state that was saved from an instance of the same library.
    ///
    /// # Errors
    ///
    /// [`ImportError::ForeignState`], [`ImportError::Refused`].
    pub fn restore(&mut self, state: &SavedState<'_>) -> Result<(), ImportError> {
        let (function, set) = match self.functions() {
            Functions::Three(functions) => ("fmi3SetFMUState", functions.set_state),
            Functions::Two(functions) => ("fmi2SetFMUstate", functions.set_state),
        };
        self.check_owner(function, state)?;
        // SAFETY: instance and state live and belong to one library
        self.call(function, || unsafe {
            set(self.handle.pointer, state.pointer)
        })
    }

    /// The state as bytes.
    ///
    /// # Errors
    ///
    /// [`ImportError::ForeignState`], [`ImportError::Refused`].
    pub fn serialize(&mut self, state: &SavedState<'_>) -> Result<Vec<u8>, ImportError> {
        let (names, size_of, serialize) = match self.functions() {
            Functions::Three(functions) => (
                ["fmi3SerializedFMUStateSize", "fmi3SerializeFMUState"],
                functions.state_size,
                functions.serialize_state,
            ),
            Functions::Two(functions) => (
                ["fmi2SerializedFMUstateSize", "fmi2SerializeFMUstate"],
                functions.state_size,
                functions.serialize_state,
            ),
        };
        self.check_owner(names[0], state)?;
        let mut size = 0;
        // SAFETY: instance and state live and belong to one library, the pointer is to a local
        self.call(names[0], || unsafe {
            size_of(self.handle.pointer, state.pointer, &raw mut size)
        })?;
        let mut bytes = vec![0; size];
        let target = bytes.as_mut_ptr();
        // SAFETY: as above, and the bytes have the size that is told
        self.call(names[1], || unsafe {
            serialize(self.handle.pointer, state.pointer, target, size)
        })?;
        Ok(bytes)
    }

    /// The state that [`Instance::serialize`] made `bytes` of.
    ///
    /// # Errors
    ///
    /// [`ImportError::Refused`], [`ImportError::Null`].
    pub fn deserialize(&mut self, bytes: &[u8]) -> Result<SavedState<'l>, ImportError> {
        let (function, deserialize) = match self.functions() {
            Functions::Three(functions) => ("fmi3DeserializeFMUState", functions.deserialize_state),
            Functions::Two(functions) => ("fmi2DeSerializeFMUstate", functions.deserialize_state),
        };
        let mut pointer = ptr::null_mut();
        // SAFETY: the instance lives, pointer and size are those of a slice
        self.call(function, || unsafe {
            deserialize(
                self.handle.pointer,
                bytes.as_ptr(),
                bytes.len(),
                &raw mut pointer,
            )
        })?;
        self.owned(function, pointer)
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
