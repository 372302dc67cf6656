//! Saved states with slices in place of pointers.

use std::{
    ffi::{c_int, c_void},
    ptr,
};

use super::Instance;
use crate::c;

impl Instance {
    pub(crate) fn save(&mut self) -> *mut c_void {
        let mut state = ptr::null_mut();
        // SAFETY: the instance lives, the pointer is to a local
        let status = unsafe { c::fmi3GetFMUState(self.handle, &raw mut state) };
        assert_eq!(status, c::OK);
        assert!(!state.is_null());
        state
    }

    pub(crate) fn restore(&mut self, state: *mut c_void) -> c_int {
        // SAFETY: the instance lives, the tests pass living states
        unsafe { c::fmi3SetFMUState(self.handle, state) }
    }

    pub(crate) fn free_state(&mut self, mut state: *mut c_void) {
        // SAFETY: the instance lives, the tests pass living states
        let status = unsafe { c::fmi3FreeFMUState(self.handle, &raw mut state) };
        assert_eq!(status, c::OK);
        assert!(state.is_null());
    }

    pub(crate) fn serialize(&mut self, state: *mut c_void) -> Vec<u8> {
        let mut size = 0;
        // SAFETY: the instance lives, the tests pass living states, pointers are to locals
        unsafe {
            assert_eq!(
                c::fmi3SerializedFMUStateSize(self.handle, state, &raw mut size),
                c::OK
            );
            let mut bytes = vec![0xaa; size];
            assert_eq!(
                c::fmi3SerializeFMUState(self.handle, state, bytes.as_mut_ptr(), size),
                c::OK
            );
            bytes
        }
    }

    pub(crate) fn deserialize(&mut self, bytes: &[u8]) -> Result<*mut c_void, c_int> {
        let mut state = ptr::null_mut();
        // SAFETY: the instance lives, pointers are to slices and locals
        let status = unsafe {
            c::fmi3DeserializeFMUState(self.handle, bytes.as_ptr(), bytes.len(), &raw mut state)
        };
        if status == c::OK {
            assert!(!state.is_null());
            Ok(state)
        } else {
            assert!(state.is_null());
            Err(status)
        }
    }
}
