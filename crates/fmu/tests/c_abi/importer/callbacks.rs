//! What the library calls back: the log, and intermediate updates within a communication step.

use std::{
    ffi::{CStr, c_char, c_int, c_void},
    mem::ManuallyDrop,
};

use super::Instance;
use crate::raw::{Fmi3, Raw};

/// One log message, as the importer's callback got it; FMI 3.0 tells no instance name.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Message {
    pub(crate) instance_name: Option<String>,
    pub(crate) status: c_int,
    pub(crate) category: String,
    pub(crate) text: String,
}

unsafe fn owned(text: *const c_char) -> String {
    // SAFETY: strings come from the library
    unsafe { CStr::from_ptr(text) }.to_str().unwrap().to_owned()
}

#[cfg(unix)]
unsafe extern "C" {
    fn snprintf(buffer: *mut c_char, size: usize, format: *const c_char, ...) -> c_int;
}

/// The message as an importer shows it that takes it as a format of `printf`, as FMI 2.0 says.
#[cfg(unix)]
unsafe fn formatted(message: *const c_char) -> String {
    let mut buffer = vec![0_u8; 1 << 16];
    // SAFETY: the buffer has the size that is told; the library promises a format without conversions
    let length = unsafe { snprintf(buffer.as_mut_ptr().cast(), buffer.len(), message) };
    buffer.truncate(usize::try_from(length).unwrap());
    String::from_utf8(buffer).unwrap()
}

#[cfg(not(unix))]
unsafe fn formatted(message: *const c_char) -> String {
    // SAFETY: the library passes a terminated string
    unsafe { owned(message) }.replace("%%", "%")
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
            instance_name: None,
            status,
            category: owned(category),
            text: owned(text),
        });
    }
}

/// The same for FMI 2.0, which tells the instance's name, and formats.
pub(crate) unsafe extern "C" fn record_fmi2(
    environment: *mut c_void,
    instance_name: *const c_char,
    status: c_int,
    category: *const c_char,
    message: *const c_char,
    _: *const c_char,
) {
    // SAFETY: as above
    unsafe {
        (*environment.cast::<Vec<Message>>()).push(Message {
            instance_name: Some(owned(instance_name)),
            status,
            category: owned(category),
            text: formatted(message),
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
    set: u8,
    get: u8,
    finished: u8,
    can_return_early: u8,
    early_return_requested: *mut u8,
    early_return_time: *mut f64,
) {
    let environment = environment.cast::<Environment>();
    // SAFETY: the tests pass an environment that outlives the instance, the pointers come from the library
    unsafe {
        assert!(*early_return_requested == 0 && *early_return_time == time);
        let Some(mut script) = (*environment).script.take() else {
            return;
        };
        // the instance that called, which is not ours to drop
        let raw = Raw {
            version: Fmi3,
            handle: (*environment).handle.unwrap(),
        };
        let mut instance = ManuallyDrop::new(Instance { raw, environment });
        let told = Update {
            time,
            set: is_true(set),
            get: is_true(get),
            finished: is_true(finished),
            can_return_early: is_true(can_return_early),
        };
        if let Some(at) = script(&mut instance, told) {
            *early_return_requested = 1;
            *early_return_time = at;
        }
        (*environment).script = Some(script);
    }
}

/// A C `bool` is 0 or 1.
fn is_true(flag: u8) -> bool {
    assert!(flag <= 1);
    flag == 1
}
