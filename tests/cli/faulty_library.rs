//! Source of FMU libraries that fail, each in the way that the cfg `fault` names; compiled by the tests with rustc.

use std::ffi::{c_char, c_int, c_void};

type Opaque = *mut c_void;
type Text = *const c_char;
type Log = unsafe extern "C" fn(Opaque, c_int, Text, Text);

#[unsafe(no_mangle)]
extern "C" fn fmi3GetVersion() -> Text {
    c"3.0".as_ptr()
}

#[unsafe(no_mangle)]
#[allow(unused_variables, reason = "the standard gives the arguments")]
unsafe extern "C" fn fmi3InstantiateCoSimulation(
    name: Text,
    token: Text,
    resources: Text,
    visible: bool,
    logging: bool,
    event_mode: bool,
    early_return: bool,
    intermediate: *const u32,
    count: usize,
    environment: Opaque,
    log: Option<Log>,
    update: Option<unsafe extern "C" fn()>,
) -> Opaque {
    if cfg!(fault = "prints") {
        println!("a library that talks");
    }
    if let Some(log) = log {
        unsafe { log(environment, 1, c"logStatusWarning".as_ptr(), c"about to fail".as_ptr()) };
    }
    if cfg!(fault = "refuses") {
        return std::ptr::null_mut();
    }
    std::ptr::dangling_mut::<u64>().cast()
}

#[unsafe(no_mangle)]
extern "C" fn fmi3DoStep(
    _: Opaque,
    _: f64,
    _: f64,
    _: bool,
    _: *mut bool,
    _: *mut bool,
    _: *mut bool,
    _: *mut f64,
) -> c_int {
    if cfg!(fault = "crashes") {
        std::process::abort();
    }
    if cfg!(fault = "exits") {
        eprintln!("licence not found");
        std::process::exit(7);
    }
    if cfg!(fault = "hangs") {
        loop {
            std::thread::sleep(std::time::Duration::from_secs(1));
        }
    }
    0
}

/// Leaves the values as they were: zero.
#[unsafe(no_mangle)]
extern "C" fn fmi3GetFloat64(_: Opaque, _: *const u32, _: usize, _: *mut f64, _: usize) -> c_int {
    0
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3GetFMUState(_: Opaque, state: *mut Opaque) -> c_int {
    unsafe { *state = std::ptr::dangling_mut::<u64>().cast() };
    0
}

macro_rules! does_nothing {
    ($($name:ident($($argument:ty),*);)*) => {$(
        #[unsafe(no_mangle)]
        extern "C" fn $name($(_: $argument),*) -> c_int {
            0
        }
    )*};
}

does_nothing! {
    fmi3FreeInstance(Opaque);
    fmi3EnterInitializationMode(Opaque, bool, f64, f64, bool, f64);
    fmi3ExitInitializationMode(Opaque);
    fmi3Terminate(Opaque);
    fmi3Reset(Opaque);
    fmi3SetFloat64(Opaque, *const u32, usize, *const f64, usize);
    fmi3GetDirectionalDerivative(Opaque, *const u32, usize, *const u32, usize, *const f64, usize, *mut f64, usize);
    fmi3SetFMUState(Opaque, Opaque);
    fmi3FreeFMUState(Opaque, *mut Opaque);
    fmi3SerializedFMUStateSize(Opaque, Opaque, *mut usize);
    fmi3SerializeFMUState(Opaque, Opaque, *mut u8, usize);
}

#[cfg(not(fault = "lacks"))]
does_nothing! {
    fmi3DeserializeFMUState(Opaque, *const u8, usize, *mut Opaque);
}
