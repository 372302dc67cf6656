//! Memory that one instance holds: all that it allocates, from its making to the steps for which it is prepared.

#![allow(
    clippy::unwrap_used,
    clippy::panic,
    reason = "a test that cannot go on has failed"
)]

use std::{
    alloc::{GlobalAlloc, Layout, System},
    cell::Cell,
    ffi::{CString, c_char, c_int, c_void},
    fs, ptr,
};

// the functions come from the library's symbols
extern crate bolted_joint as _;

/// Bytes that an instance of any FMU may hold.
const LIMIT: isize = 4096;

/// Counts the bytes that this thread holds. The library is linked into this program and allocates here too.
struct Counting;

thread_local! {
    static HELD: Cell<isize> = const { Cell::new(0) };
}

fn count(bytes: isize) {
    HELD.set(HELD.get() + bytes);
}

// SAFETY: all is left to the system's allocator
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        count(layout.size().cast_signed());
        // SAFETY: the caller's promise
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        count(-layout.size().cast_signed());
        // SAFETY: the caller's promise
        unsafe { System.dealloc(pointer, layout) };
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

unsafe extern "C" {
    fn fmi3InstantiateCoSimulation(
        name: *const c_char,
        token: *const c_char,
        resources: *const c_char,
        visible: bool,
        logging: bool,
        event_mode: bool,
        early_return: bool,
        intermediate: *const u32,
        intermediate_count: usize,
        environment: *mut c_void,
        log: Option<unsafe extern "C" fn(*mut c_void, c_int, *const c_char, *const c_char)>,
        update: Option<unsafe extern "C" fn()>,
    ) -> *mut c_void;
    fn fmi3EnterInitializationMode(
        i: *mut c_void,
        tolerance_defined: bool,
        tolerance: f64,
        start: f64,
        stop_defined: bool,
        stop: f64,
    ) -> c_int;
    fn fmi3ExitInitializationMode(i: *mut c_void) -> c_int;
    fn fmi3DoStep(
        i: *mut c_void,
        t: f64,
        h: f64,
        no_set_prior: bool,
        event: *mut bool,
        terminate: *mut bool,
        early: *mut bool,
        last: *mut f64,
    ) -> c_int;
    fn fmi3GetFloat64(i: *mut c_void, vr: *const u32, n: usize, v: *mut f64, nv: usize) -> c_int;
    fn fmi3FreeInstance(i: *mut c_void);
}

fn start_text(model: &str, dofs: u8, k3: f64) -> String {
    let mut text = format!(
        "bolted-joint-start/1\nmodel {model}\ndofs {dofs}\ntoken {{footprint}}\njoint.k_yy 4e6\njoint.c_yy 8\n\
         joint.k3_y {k3:e}\njoint.k5_y 0\njoint.k7_y 0\njoint.c2_y 0\njoint.c4_y 0\n"
    );
    if dofs == 2 {
        text += "joint.k_ytheta 1e4\njoint.k_thetatheta 2e3\njoint.c_ytheta 0.5\njoint.c_thetatheta 0.25\n\
                 joint.k3_theta 0\njoint.k5_theta 0\njoint.k7_theta 0\njoint.c2_theta 0\njoint.c4_theta 0\n";
    }
    if model == "lap" {
        for side in ["a", "b"] {
            text += &format!("{side}.m 2\n{side}.k_y 8e5\n{side}.c_y 1\n");
            if dofs == 2 {
                text += &format!("{side}.J 1e-3\n{side}.k_theta 1e3\n{side}.c_theta 1e-3\n");
            }
        }
        text += "step_size_max 2e-5\n";
    }
    text
}

/// Bytes held by an instance with these resources after instantiation, and after steps and a look at an output.
fn held(resources: &CString) -> [isize; 2] {
    let before = HELD.get();
    // SAFETY: strings are terminated, pointers are to locals, the handle lives until it is freed
    unsafe {
        let instance = fmi3InstantiateCoSimulation(
            c"joint".as_ptr(),
            c"{footprint}".as_ptr(),
            resources.as_ptr(),
            false,
            false,
            false,
            false,
            ptr::null(),
            0,
            ptr::null_mut(),
            None,
            None,
        );
        assert!(!instance.is_null());
        let made = HELD.get() - before;
        assert_eq!(
            fmi3EnterInitializationMode(instance, false, 0.0, 0.0, false, 0.0),
            0
        );
        assert_eq!(fmi3ExitInitializationMode(instance), 0);
        let (mut event, mut terminate, mut early, mut time_s) = (false, false, false, 0.0);
        for _ in 0..100 {
            let status = fmi3DoStep(
                instance,
                time_s,
                1e-3,
                true,
                &raw mut event,
                &raw mut terminate,
                &raw mut early,
                &raw mut time_s,
            );
            assert_eq!(status, 0);
        }
        let mut force = f64::NAN;
        assert_eq!(fmi3GetFloat64(instance, &13, 1, &raw mut force, 1), 0);
        let used = HELD.get() - before;
        fmi3FreeInstance(instance);
        assert_eq!(HELD.get(), before, "something was not freed");
        [made, used]
    }
}

#[test]
fn an_instance_takes_four_kibibytes_at_most() {
    let folder =
        std::env::temp_dir().join(format!("bolted joint footprint {}", std::process::id()));
    fs::create_dir_all(&folder).unwrap();
    let resources = CString::new(folder.to_str().unwrap()).unwrap();
    for (model, dofs, k3) in [
        ("element", 1, 0.0),
        ("element", 2, 1e11),
        ("lap", 1, 0.0),
        ("lap", 1, 1e11),
        ("lap", 2, 0.0),
        ("lap", 2, 1e11),
    ] {
        fs::write(folder.join("start.txt"), start_text(model, dofs, k3)).unwrap();
        // what the first one allocates for good is no part of an instance
        held(&resources);
        let [made, used] = held(&resources);
        println!("{model}, {dofs} DOF, k3 = {k3:e}: {made} bytes when made, {used} in use");
        assert!(made > 0 && used <= LIMIT, "{model}, {dofs} DOF: {used}");
    }
    fs::remove_dir_all(&folder).unwrap();
}
