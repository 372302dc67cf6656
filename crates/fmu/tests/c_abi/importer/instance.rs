//! An instance, from instantiation to the end of its initialisation, with its values and its log.

use std::ffi::{c_int, c_void};

use super::callbacks::Environment;
use super::{Folder, Kind, Message, Request, Update, start_text};
use crate::c;

/// An instance with its log.
pub(crate) struct Instance {
    pub(crate) handle: *mut c_void,
    pub(super) environment: *mut Environment,
    pub(super) start_s: f64,
}

// SAFETY: FMI instances may be moved between threads
unsafe impl Send for Instance {}

impl Drop for Instance {
    fn drop(&mut self) {
        // SAFETY: made together, freed together
        unsafe {
            c::fmi3FreeInstance(self.handle);
            drop(Box::from_raw(self.environment));
        }
    }
}

impl Instance {
    /// Instance in state Instantiated.
    pub(crate) fn new(kind: Kind, dofs: u8, changes: &[(&str, f64)]) -> Self {
        let folder = Folder::with_start(&start_text(kind, dofs, changes));
        let request = Request {
            resources: folder.0.to_str(),
            ..Request::default()
        };
        request.instantiate().unwrap()
    }

    /// Instance for Model Exchange in state Instantiated.
    pub(crate) fn exchanging(kind: Kind, dofs: u8, changes: &[(&str, f64)]) -> Self {
        let folder = Folder::with_start(&start_text(kind, dofs, changes));
        let request = Request {
            resources: folder.0.to_str(),
            ..Request::default()
        };
        request.instantiate_model_exchange().unwrap()
    }

    /// Instance in Step Mode at t = 0.
    pub(crate) fn stepping(kind: Kind, dofs: u8, changes: &[(&str, f64)]) -> Self {
        let mut instance = Self::new(kind, dofs, changes);
        assert_eq!(instance.enter_initialization(0.0, None), c::OK);
        assert_eq!(instance.exit_initialization(), c::OK);
        instance
    }

    /// All messages since the last call.
    pub(crate) fn take_log(&mut self) -> Vec<Message> {
        // SAFETY: the library writes to the log only during a call
        std::mem::take(unsafe { &mut (*self.environment).log })
    }

    /// The one error message since the last call; events are ignored.
    pub(crate) fn error(&mut self) -> String {
        let log = self.take_log();
        let errors: Vec<&Message> = log
            .iter()
            .filter(|message| message.status == c::ERROR)
            .collect();
        match errors.as_slice() {
            [error] => {
                assert_eq!(error.category, "logStatusError");
                error.text.clone()
            }
            _ => panic!("expected one error, found {log:?}"),
        }
    }

    /// The message of a call that is refused, and that must leave the instance as it was, mode included.
    pub(crate) fn refused(&mut self, call: impl FnOnce(&mut Self) -> c_int) -> String {
        let before = self.state_bytes();
        assert_eq!(call(self), c::ERROR);
        assert!(
            self.state_bytes() == before,
            "the call changed the instance"
        );
        self.error()
    }

    /// All that the instance remembers: mode, stop time, values.
    pub(crate) fn state_bytes(&mut self) -> Vec<u8> {
        let state = self.save();
        let bytes = self.serialize(state);
        self.free_state(state);
        bytes
    }

    pub(crate) fn enter_initialization(&mut self, start_s: f64, stop_s: Option<f64>) -> c_int {
        self.start_s = start_s;
        // SAFETY: the instance lives
        unsafe {
            c::fmi3EnterInitializationMode(
                self.handle,
                false,
                0.0,
                start_s,
                stop_s.is_some(),
                stop_s.unwrap_or(f64::NAN),
            )
        }
    }

    pub(crate) fn exit_initialization(&mut self) -> c_int {
        // SAFETY: the instance lives
        unsafe { c::fmi3ExitInitializationMode(self.handle) }
    }

    pub(crate) fn terminate(&mut self) -> c_int {
        // SAFETY: the instance lives
        unsafe { c::fmi3Terminate(self.handle) }
    }

    pub(crate) fn reset(&mut self) -> c_int {
        // SAFETY: the instance lives
        unsafe { c::fmi3Reset(self.handle) }
    }

    pub(crate) fn set(&mut self, references: &[u32], values: &[f64]) -> c_int {
        // SAFETY: pointers and lengths are those of slices
        unsafe {
            c::fmi3SetFloat64(
                self.handle,
                references.as_ptr(),
                references.len(),
                values.as_ptr(),
                values.len(),
            )
        }
    }

    pub(crate) fn try_get(&mut self, references: &[u32]) -> Result<Vec<f64>, c_int> {
        let mut values = vec![f64::NAN; references.len()];
        // SAFETY: pointers and lengths are those of slices
        let status = unsafe {
            c::fmi3GetFloat64(
                self.handle,
                references.as_ptr(),
                references.len(),
                values.as_mut_ptr(),
                values.len(),
            )
        };
        if status == c::OK {
            Ok(values)
        } else {
            Err(status)
        }
    }

    pub(crate) fn get<const N: usize>(&mut self, references: [u32; N]) -> [f64; N] {
        self.try_get(&references).unwrap().try_into().unwrap()
    }

    /// What to do in the callback within a communication step.
    pub(crate) fn on_update(
        &mut self,
        script: impl FnMut(&mut Instance, Update) -> Option<f64> + 'static,
    ) {
        // SAFETY: the library uses the environment only during a call
        unsafe { (*self.environment).script = Some(Box::new(script)) };
    }

    /// Status of a step that ends where it shall or not at all, and the time that it reached.
    pub(crate) fn step(&mut self, t: f64, h: f64) -> (c_int, f64) {
        let Stepped {
            status,
            early,
            last,
        } = self.do_step(t, h);
        assert!(!early);
        (status, last)
    }

    /// What a step returned.
    pub(crate) fn do_step(&mut self, t: f64, h: f64) -> Stepped {
        let (mut event, mut terminate, mut early, mut last) = (true, true, true, f64::NAN);
        // SAFETY: the instance lives, all pointers are to locals
        let status = unsafe {
            c::fmi3DoStep(
                self.handle,
                t,
                h,
                true,
                &raw mut event,
                &raw mut terminate,
                &raw mut early,
                &raw mut last,
            )
        };
        assert!(!event && !terminate);
        Stepped {
            status,
            early,
            last,
        }
    }
}

/// What a communication step returned.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Stepped {
    pub(crate) status: c_int,
    pub(crate) early: bool,
    pub(crate) last: f64,
}
