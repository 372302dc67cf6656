//! A hundred thousand instances, one after the other: memory, open files and threads stay as they were.

#![allow(
    clippy::unwrap_used,
    clippy::panic,
    reason = "a test that cannot go on has failed"
)]

use std::{
    alloc::{GlobalAlloc, Layout, System},
    env,
    ffi::{CString, c_char, c_int, c_void},
    fs,
    path::Path,
    sync::atomic::{AtomicIsize, Ordering},
};

// the functions come from the library's symbols
extern crate bolted_joint as _;

mod raw;

use raw::{request::Request, start_text};

/// Counts the bytes that are allocated at present. The library is linked into this program and allocates here too.
struct Counting;

static ALLOCATED: AtomicIsize = AtomicIsize::new(0);

// SAFETY: all is left to the system's allocator
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        ALLOCATED.fetch_add(layout.size().cast_signed(), Ordering::Relaxed);
        // SAFETY: the caller's promise
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        ALLOCATED.fetch_sub(layout.size().cast_signed(), Ordering::Relaxed);
        // SAFETY: the caller's promise
        unsafe { System.dealloc(pointer, layout) };
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// Counts messages.
unsafe extern "C" fn count(environment: *mut c_void, _: c_int, _: *const c_char, _: *const c_char) {
    // SAFETY: the environment is a number that outlives the instance
    unsafe { *environment.cast::<u64>() += 1 };
}

/// An instance from its beginning to its end, with a step, a saved state, and a refused step.
fn live(resources: &CString) {
    let mut messages = 0_u64;
    let request = Request {
        token: Some(c"{endurance}"),
        resources: Some(resources),
        environment: (&raw mut messages).cast(),
        log: (None, Some(count)),
        ..Request::NONE
    };
    let instance = request.instantiate().unwrap();
    assert_eq!(instance.enter_initialization(0.0, None), 0);
    assert_eq!(instance.exit_initialization(), 0);
    let state = instance.save();
    assert_eq!(instance.step(0.0, 1e-4), 0);
    assert_eq!(instance.step(0.5, 1e-4), 3);
    instance.free_state(state);
    instance.free();
    assert_eq!(messages, 1);
}

/// Memory of the process that is not on disk, in KiB, and the number of its open files and threads.
#[cfg(target_os = "linux")]
fn of_the_process() -> (u64, usize, usize) {
    let status = fs::read_to_string("/proc/self/status").unwrap();
    let line = status
        .lines()
        .find_map(|line| line.strip_prefix("VmRSS:"))
        .unwrap();
    let resident = line.trim().trim_end_matches(" kB").parse().unwrap();
    let number_in = |folder| fs::read_dir(folder).unwrap().count();
    (
        resident,
        number_in("/proc/self/fd"),
        number_in("/proc/self/task"),
    )
}

#[test]
fn a_hundred_thousand_instances_leave_nothing_behind() {
    let cycles: u32 = env::var("BOLTED_JOINT_CYCLES").map_or(100_000, |text| text.parse().unwrap());
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("endurance");
    fs::create_dir_all(&folder).unwrap();
    let start = start_text(true, 1, "{endurance}", &[("joint.k3_y", 1e11)]);
    fs::write(folder.join("start.txt"), start).unwrap();
    let resources = CString::new(folder.to_str().unwrap()).unwrap();
    // what is made once in a process is made now
    for _ in 0..100 {
        live(&resources);
    }
    #[cfg(target_os = "linux")]
    let before = of_the_process();
    let allocated = ALLOCATED.load(Ordering::Relaxed);
    for _ in 0..cycles {
        live(&resources);
    }
    // the test harness may have allocated something meanwhile, but less than a byte for each instance
    let lost = ALLOCATED.load(Ordering::Relaxed) - allocated;
    assert!(lost.unsigned_abs() < cycles as usize, "{lost} bytes");
    #[cfg(target_os = "linux")]
    {
        // nor does the heap grow by holes: a leak of one byte in an instance would be 98 KiB, a page for each 390 MiB
        let after = of_the_process();
        let growth = after.0.saturating_sub(before.0);
        assert!(growth <= 64, "{growth} KiB more than before");
        assert_eq!((after.1, after.2), (before.1, before.2));
    }
}
