//! The functions that stand in for those of newer C libraries, against what the standard library says of the same files.
//!
//! In the FMU library they are hidden, so the object that is linked into it is linked once more by itself.

use std::ffi::{CString, c_char, c_int, c_uint, c_void};
use std::fs;
use std::io::ErrorKind;
use std::os::fd::AsRawFd as _;
use std::os::unix::fs::MetadataExt as _;
use std::path::Path;
use std::process::Command;

use libloading::{Library, Symbol};

/// Bytes of `struct stat64` and `struct statx`, with room to spare.
type Status = [u64; 64];

/// `stx_mask` for all that the first version of the call knows.
const STATX_BASIC_STATS: c_uint = 0x7ff;

const AT_FDCWD: c_int = -100;

/// The object as a shared library, in a folder that goes with it.
struct Linked {
    library: Library,
    folder: tempfile::TempDir,
}

impl Linked {
    fn new() -> Self {
        let object = Path::new(env!("BOLTED_JOINT_LIBRARY")).with_file_name("old_glibc.o");
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("old glibc.so");
        let linker = std::env::var("CC").unwrap_or_else(|_| "cc".to_owned());
        let done = Command::new(linker)
            .arg("-shared")
            .arg("-o")
            .args([&path, &object])
            .output()
            .unwrap();
        assert!(done.status.success(), "{done:?}");
        // SAFETY: the library has no initialiser and no destructor.
        let library = unsafe { Library::new(&path).unwrap() };
        Self { library, folder }
    }

    /// A function of the library.
    ///
    /// # Safety
    /// `F` is its type.
    unsafe fn function<F>(&self, name: &str) -> Symbol<'_, F> {
        // SAFETY: the caller knows the type.
        unsafe { self.library.get(name).unwrap() }
    }
}

#[test]
fn files_have_the_size_and_number_that_the_standard_library_says() {
    let linked = Linked::new();
    let path = linked.folder.path().join("twelve bytes");
    fs::write(&path, b"twelve bytes").unwrap();
    let expected = fs::metadata(&path).unwrap();
    let name = CString::new(path.to_str().unwrap()).unwrap();

    let mut status: Status = [0; 64];
    // SAFETY: the types are the C library's; the strings are terminated and the buffers large enough.
    unsafe {
        let stat64 =
            linked.function::<unsafe extern "C" fn(*const c_char, *mut Status) -> c_int>("stat64");
        assert_eq!(stat64(name.as_ptr(), &mut status), 0);
    }
    // struct stat: st_ino at byte 8, st_size at byte 48, on both architectures
    assert_eq!((status[1], status[6]), (expected.ino(), 12));

    let file = fs::File::open(&path).unwrap();
    let mut status: Status = [0; 64];
    // SAFETY: as above.
    unsafe {
        let fstat64 =
            linked.function::<unsafe extern "C" fn(c_int, *mut Status) -> c_int>("fstat64");
        assert_eq!(fstat64(file.as_raw_fd(), &mut status), 0);
    }
    assert_eq!((status[1], status[6]), (expected.ino(), 12));

    let mut status: Status = [0; 64];
    // SAFETY: as above.
    unsafe {
        type Statx =
            unsafe extern "C" fn(c_int, *const c_char, c_int, c_uint, *mut Status) -> c_int;
        let statx = linked.function::<Statx>("statx");
        assert_eq!(
            statx(AT_FDCWD, name.as_ptr(), 0, STATX_BASIC_STATS, &mut status),
            0
        );
    }
    // struct statx: stx_ino at byte 32, stx_size at byte 40
    assert_eq!((status[4], status[5]), (expected.ino(), 12));
}

#[test]
fn a_file_that_does_not_exist_is_refused_with_the_systems_reason() {
    let linked = Linked::new();
    let mut status: Status = [0; 64];
    // SAFETY: the type is the C library's, the string is terminated, the buffer large enough.
    let result = unsafe {
        let stat64 =
            linked.function::<unsafe extern "C" fn(*const c_char, *mut Status) -> c_int>("stat64");
        stat64(c"no such file".as_ptr(), &mut status)
    };
    let error = std::io::Error::last_os_error();
    assert_eq!((result, error.kind()), (-1, ErrorKind::NotFound));
}

#[test]
fn the_thread_has_the_number_that_the_kernel_shows() {
    let linked = Linked::new();
    // SAFETY: the type is the C library's.
    let number = unsafe { linked.function::<unsafe extern "C" fn() -> c_int>("gettid")() };
    let shown = fs::read_link("/proc/thread-self").unwrap();
    assert_eq!(
        shown.file_name().unwrap().to_str().unwrap(),
        number.to_string()
    );
}

#[test]
fn an_address_is_found_in_the_file_that_holds_it() {
    let linked = Linked::new();
    let mut info = [std::ptr::null::<c_char>(); 4];
    // SAFETY: the type is the C library's; a Dl_info is four pointers.
    let path = unsafe {
        type Dladdr = unsafe extern "C" fn(*const c_void, *mut [*const c_char; 4]) -> c_int;
        let dladdr = linked.function::<Dladdr>("dladdr");
        assert_eq!(dladdr(*dladdr as *const c_void, &mut info), 1);
        std::ffi::CStr::from_ptr(info[0]).to_str().unwrap()
    };
    assert_eq!(Path::new(path), linked.folder.path().join("old glibc.so"));

    // SAFETY: as above; no object is loaded at address 16.
    let found = unsafe {
        type Dladdr = unsafe extern "C" fn(*const c_void, *mut [*const c_char; 4]) -> c_int;
        linked.function::<Dladdr>("dladdr")(16 as *const c_void, &mut info)
    };
    assert_eq!(found, 0);
}
