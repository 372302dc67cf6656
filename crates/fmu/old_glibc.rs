//! The few functions of newer GNU C libraries that the FMU library would ask for, in terms of what old ones have.
//!
//! A library that is linked on a machine with a new C library asks for the newest version of each symbol that it
//! uses, and an older system then refuses to load it. `stat64` and `fstat64` have been symbols since glibc 2.33 only,
//! `gettid` since 2.30, `statx` since 2.28, and 2.34 moved `dladdr`. Defined here, and hidden in the FMU library, they
//! are not asked for. docs/platforms.md states what is left, and a test holds it to that.
//!
//! Only for 64-bit Linux on x86-64 and AArch64, where glibc's `struct stat64` and `struct statx` are the kernel's own.
//! The build script of `crates/export` compiles this file to an object and links it into the FMU library.

#![no_std]

use core::ffi::{c_char, c_int, c_long, c_uint, c_void};

#[cfg(target_arch = "x86_64")]
mod number {
    use core::ffi::c_long;

    pub(crate) const FSTAT: c_long = 5;
    pub(crate) const GETTID: c_long = 186;
    pub(crate) const NEWFSTATAT: c_long = 262;
    pub(crate) const STATX: c_long = 332;
}

/// Call numbers of the kernel's `asm-generic/unistd.h`.
#[cfg(target_arch = "aarch64")]
mod number {
    use core::ffi::c_long;

    pub(crate) const NEWFSTATAT: c_long = 79;
    pub(crate) const FSTAT: c_long = 80;
    pub(crate) const GETTID: c_long = 178;
    pub(crate) const STATX: c_long = 291;
}

/// `Elf64_Phdr` of `<elf.h>`.
#[repr(C)]
struct ProgramHeader {
    kind: u32,
    flags: u32,
    offset: u64,
    virtual_address: u64,
    physical_address: u64,
    file_size: u64,
    memory_size: u64,
    alignment: u64,
}

/// `PT_LOAD`.
const LOADED: u32 = 1;

/// The first members of `dl_phdr_info` of `<link.h>`.
#[repr(C)]
struct LoadedObject {
    base: usize,
    name: *const c_char,
    headers: *const ProgramHeader,
    header_count: u16,
}

/// `Dl_info` of `<dlfcn.h>`.
#[repr(C)]
pub struct SymbolInfo {
    file_name: *const c_char,
    file_base: *mut c_void,
    symbol_name: *const c_char,
    symbol_address: *mut c_void,
}

/// What [`visit`] looks for, and where it puts what it finds.
struct Search {
    address: usize,
    found: *mut SymbolInfo,
}

/// "Relative to the working directory", in place of a folder's descriptor.
const AT_FDCWD: c_int = -100;

unsafe extern "C" {
    /// Calls the kernel: −1 and `errno` where it refuses, as the functions below have it.
    fn syscall(number: c_long, ...) -> c_long;

    /// Shows each loaded object to `visit`, until it returns other than zero, and returns that.
    fn dl_iterate_phdr(
        visit: unsafe extern "C" fn(*const LoadedObject, usize, *mut c_void) -> c_int,
        data: *mut c_void,
    ) -> c_int;
}

/// The object that holds an address; names no symbol, which nobody here asks for.
///
/// # Safety
/// `info` points to a `Dl_info`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn dladdr(address: *const c_void, info: *mut SymbolInfo) -> c_int {
    let mut search = Search {
        address: address as usize,
        found: info,
    };
    // SAFETY: `visit` takes what dl_iterate_phdr gives, and the search outlives the call.
    unsafe { dl_iterate_phdr(visit, (&raw mut search).cast()) }
}

/// Fills the search's result and returns 1 if `object` holds its address.
unsafe extern "C" fn visit(
    object: *const LoadedObject,
    _size: usize,
    search: *mut c_void,
) -> c_int {
    // SAFETY: dl_iterate_phdr gives a valid object, and back the search that it was given.
    let (object, search) = unsafe { (&*object, &*search.cast::<Search>()) };
    for index in 0..usize::from(object.header_count) {
        // SAFETY: there are as many headers as the object says.
        let header = unsafe { &*object.headers.add(index) };
        let start = object.base.wrapping_add(header.virtual_address as usize);
        if header.kind == LOADED && search.address.wrapping_sub(start) < header.memory_size as usize
        {
            // SAFETY: the caller of dladdr has given a place for the result.
            unsafe {
                search.found.write(SymbolInfo {
                    file_name: object.name,
                    file_base: object.base as *mut c_void,
                    symbol_name: core::ptr::null(),
                    symbol_address: core::ptr::null_mut(),
                });
            }
            return 1;
        }
    }
    0
}

/// `stat` of a path, links followed.
///
/// # Safety
/// `path` is a terminated string, `status` points to a `struct stat64`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stat64(path: *const c_char, status: *mut c_void) -> c_int {
    let follow_links: c_int = 0;
    // SAFETY: the caller's pointers are those that the kernel asks for.
    unsafe { syscall(number::NEWFSTATAT, AT_FDCWD, path, status, follow_links) as c_int }
}

/// `stat` of an open file.
///
/// # Safety
/// `status` points to a `struct stat64`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fstat64(descriptor: c_int, status: *mut c_void) -> c_int {
    // SAFETY: the caller's pointer is the one that the kernel asks for.
    unsafe { syscall(number::FSTAT, descriptor, status) as c_int }
}

/// Extended `stat`; kernels before 4.11 refuse it, and the standard library then takes `stat64`.
///
/// # Safety
/// `path` is a terminated string, `status` points to a `struct statx`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn statx(
    folder: c_int,
    path: *const c_char,
    flags: c_int,
    mask: c_uint,
    status: *mut c_void,
) -> c_int {
    // SAFETY: the caller's pointers are those that the kernel asks for.
    unsafe { syscall(number::STATX, folder, path, flags, mask, status) as c_int }
}

/// Number of the calling thread.
///
/// # Safety
/// None is asked; the signature is the C library's.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn gettid() -> c_int {
    // SAFETY: the call takes nothing and cannot fail.
    unsafe { syscall(number::GETTID) as c_int }
}
