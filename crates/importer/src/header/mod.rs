//! The C interfaces of FMI, as the standard's headers declare them: what an importer loads, or is linked with.
//!
//! Each function stands here twice under its name: as a type, for what is looked up in a library at run time, and as a
//! declaration, for programs that an FMU's library is linked into. Nothing is linked that is not called.
#![allow(
    non_snake_case,
    non_camel_case_types,
    reason = "the C headers give the names"
)]

use std::ffi::{c_char, c_int, c_void};

pub mod fmi2;
pub mod fmi3;

/// Instances, environments and saved states: pointers to what the other side knows.
pub type Opaque = *mut c_void;
/// A terminated string.
pub type Text = *const c_char;
/// A status, as the number that C makes of the enumeration.
pub type StatusCode = c_int;
/// A value reference.
pub type Reference = u32;

/// `fmi2OK`, `fmi3OK`.
pub const OK: StatusCode = 0;
/// `fmi2Warning`, `fmi3Warning`.
pub const WARNING: StatusCode = 1;
/// `fmi2Discard`, `fmi3Discard`.
pub const DISCARD: StatusCode = 2;
/// `fmi2Error`, `fmi3Error`.
pub const ERROR: StatusCode = 3;
/// `fmi2Fatal`, `fmi3Fatal`.
pub const FATAL: StatusCode = 4;
/// `fmi2Pending`.
pub const PENDING: StatusCode = 5;

/// Declares functions and their types.
macro_rules! declare {
    ($($name:ident($($type:ty),* $(,)?) $(-> $result:ty)?;)*) => {
        $(
            #[doc = concat!("Type of `", stringify!($name), "`.")]
            pub type $name = unsafe extern "C" fn($($type),*) $(-> $result)?;
        )*

        unsafe extern "C" {
            $(
                #[doc = concat!("`", stringify!($name), "` of the library that is linked.")]
                pub fn $name($(_: $type),*) $(-> $result)?;
            )*
        }
    };
}
use declare;
