//! Where this library was loaded from, for importers that do not say where the FMU's resources are.

use std::path::PathBuf;

/// Path of the file that holds this very function, absolute.
pub(crate) fn path() -> Option<PathBuf> {
    std::path::absolute(platform::path()?).ok()
}

#[cfg(unix)]
mod platform {
    use std::{
        ffi::{CStr, OsStr, c_char, c_int, c_void},
        mem::MaybeUninit,
        os::unix::ffi::OsStrExt as _,
        path::PathBuf,
    };

    /// `Dl_info` of `<dlfcn.h>`.
    #[repr(C)]
    struct SymbolInfo {
        file_name: *const c_char,
        file_base: *mut c_void,
        symbol_name: *const c_char,
        symbol_address: *mut c_void,
    }

    unsafe extern "C" {
        fn dladdr(address: *const c_void, info: *mut SymbolInfo) -> c_int;
    }

    pub(super) fn path() -> Option<PathBuf> {
        let mut info = MaybeUninit::<SymbolInfo>::uninit();
        // SAFETY: dladdr takes any address and fills the structure if it returns non-zero.
        let found = unsafe {
            dladdr(
                path as fn() -> Option<PathBuf> as *const c_void,
                info.as_mut_ptr(),
            )
        };
        if found == 0 {
            return None;
        }
        // SAFETY: dladdr has filled the structure.
        let info = unsafe { info.assume_init() };
        if info.file_name.is_null() {
            return None;
        }
        // SAFETY: the file name is a terminated string that lives as long as the library is loaded.
        let name = unsafe { CStr::from_ptr(info.file_name) };
        Some(PathBuf::from(OsStr::from_bytes(name.to_bytes())))
    }
}

#[cfg(windows)]
mod platform {
    use std::{
        ffi::{OsString, c_int, c_void},
        os::windows::ffi::OsStringExt as _,
        path::PathBuf,
        ptr,
    };

    const FROM_ADDRESS: u32 = 4;
    const UNCHANGED_REFCOUNT: u32 = 2;
    /// Longest path that Windows knows, in UTF-16 units.
    const LONGEST_PATH: u32 = 32_768;

    #[link(name = "kernel32")]
    unsafe extern "system" {
        fn GetModuleHandleExW(flags: u32, address: *const u16, module: *mut *mut c_void) -> c_int;
        fn GetModuleFileNameW(module: *mut c_void, file_name: *mut u16, size: u32) -> u32;
    }

    pub(super) fn path() -> Option<PathBuf> {
        let mut module = ptr::null_mut();
        let address = path as fn() -> Option<PathBuf> as *const u16;
        // SAFETY: with FROM_ADDRESS the second argument is any address inside a loaded module.
        let found = unsafe {
            GetModuleHandleExW(FROM_ADDRESS | UNCHANGED_REFCOUNT, address, &raw mut module)
        };
        if found == 0 {
            return None;
        }
        let mut buffer = vec![0_u16; LONGEST_PATH as usize];
        // SAFETY: the module handle is valid, the buffer has the size that is told.
        let length = unsafe { GetModuleFileNameW(module, buffer.as_mut_ptr(), LONGEST_PATH) };
        if length == 0 || length >= LONGEST_PATH {
            return None;
        }
        buffer.truncate(length as usize);
        Some(PathBuf::from(OsString::from_wide(&buffer)))
    }
}

#[cfg(not(any(unix, windows)))]
mod platform {
    use std::path::PathBuf;

    pub(super) fn path() -> Option<PathBuf> {
        None
    }
}
