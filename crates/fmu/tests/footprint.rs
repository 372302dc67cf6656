//! Memory that one instance holds: all that it allocates, from its making to the steps for which it is prepared.

#![allow(
    clippy::unwrap_used,
    clippy::panic,
    reason = "a test that cannot go on has failed"
)]

use std::{
    alloc::{GlobalAlloc, Layout, System},
    cell::Cell,
    ffi::CString,
    fs,
};

// the functions come from the library's symbols
extern crate bolted_joint as _;

mod raw;

use raw::{request::Request, start_text};

/// Bytes that an instance may hold, of a joint in a plane and of one in space.
const LIMITS: [isize; 2] = [8 << 10, 16 << 10];

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

/// Bytes held by an instance with these resources after instantiation, and after steps and a look at an output.
fn held(resources: &CString) -> [isize; 2] {
    let before = HELD.get();
    let request = Request {
        token: Some(c"{footprint}"),
        resources: Some(resources),
        ..Request::NONE
    };
    let instance = request.instantiate().unwrap();
    let made = HELD.get() - before;
    assert_eq!(instance.enter_initialization(0.0, None), 0);
    assert_eq!(instance.exit_initialization(), 0);
    let mut time_s = 0.0;
    for _ in 0..100 {
        let (status, last) = instance.step_to(time_s, 1e-3);
        assert_eq!(status, 0);
        time_s = last;
    }
    instance.get([15]);
    let used = HELD.get() - before;
    instance.free();
    assert_eq!(HELD.get(), before, "something was not freed");
    [made, used]
}

#[test]
fn an_instance_takes_few_kibibytes() {
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
        ("element", 6, 1e11),
        ("lap", 6, 0.0),
        ("lap", 6, 1e11),
    ] {
        let start = start_text(model == "lap", dofs, "{footprint}", &[("joint.k3_y", k3)]);
        fs::write(folder.join("start.txt"), start).unwrap();
        // what the first one allocates for good is no part of an instance
        held(&resources);
        let [made, used] = held(&resources);
        println!("{model}, {dofs} DOF, k3 = {k3:e}: {made} bytes when made, {used} in use");
        let limit = LIMITS[usize::from(dofs == 6)];
        assert!(made > 0 && used <= limit, "{model}, {dofs} DOF: {used}");
    }
    fs::remove_dir_all(&folder).unwrap();
}
