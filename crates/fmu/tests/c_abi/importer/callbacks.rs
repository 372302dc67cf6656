//! What the library calls back: the log, and intermediate updates within a communication step.

use std::{
    ffi::{CStr, c_char, c_int, c_void},
    mem::ManuallyDrop,
};

use super::Instance;

/// One log message.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Message {
    pub(crate) status: c_int,
    pub(crate) category: String,
    pub(crate) text: String,
}

/// The importer's log callback: the environment is the list to append to.
pub(crate) unsafe extern "C" fn record(
    environment: *mut c_void,
    status: c_int,
    category: *const c_char,
    text: *const c_char,
) {
    // SAFETY: the tests pass a list that outlives the instance, and strings come from the library
    unsafe {
        (*environment.cast::<Vec<Message>>()).push(Message {
            status,
            category: CStr::from_ptr(category).to_str().unwrap().to_owned(),
            text: CStr::from_ptr(text).to_str().unwrap().to_owned(),
        });
    }
}

/// What the callback within a communication step is told.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Update {
    pub(crate) time: f64,
    pub(crate) set: bool,
    pub(crate) get: bool,
    pub(crate) finished: bool,
    pub(crate) can_return_early: bool,
}

/// What the importer does in the callback; it returns the time of an early return.
pub(super) type Script = Box<dyn FnMut(&mut Instance, Update) -> Option<f64>>;

/// `instanceEnvironment`: the log comes first, where [`record`] looks for it.
#[repr(C)]
#[derive(Default)]
pub(super) struct Environment {
    pub(super) log: Vec<Message>,
    pub(super) handle: Option<*mut c_void>,
    pub(super) script: Option<Script>,
}

/// The importer's callback within a communication step: runs the script of the environment.
pub(super) unsafe extern "C" fn update(
    environment: *mut c_void,
    time: f64,
    set: bool,
    get: bool,
    finished: bool,
    can_return_early: bool,
    early_return_requested: *mut bool,
    early_return_time: *mut f64,
) {
    let environment = environment.cast::<Environment>();
    // SAFETY: the tests pass an environment that outlives the instance, the pointers come from the library
    unsafe {
        assert!(!*early_return_requested && *early_return_time == time);
        let Some(mut script) = (*environment).script.take() else {
            return;
        };
        // the instance that called, which is not ours to drop
        let mut instance = ManuallyDrop::new(Instance {
            handle: (*environment).handle.unwrap(),
            environment,
            start_s: 0.0,
        });
        let told = Update {
            time,
            set,
            get,
            finished,
            can_return_early,
        };
        if let Some(at) = script(&mut instance, told) {
            *early_return_requested = true;
            *early_return_time = at;
        }
        (*environment).script = Some(script);
    }
}
