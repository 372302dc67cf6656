//! What the C interfaces of FMI 2.0 and 3.0 have in common.

use std::ffi::{c_char, c_int, c_void};

/// Instances, environments and saved states: pointers to what the other side knows.
pub(crate) type Opaque = *mut c_void;
/// A terminated string.
pub(crate) type Text = *const c_char;
/// A status, as the number that C makes of the enumeration.
pub(crate) type StatusCode = c_int;
/// Value references of both standards.
pub(crate) type Reference = u32;

/// Declares a table of functions with their C names and types, and how it is filled from a library.
macro_rules! function_table {
    ($(#[$attribute:meta])* $table:ident { $($field:ident = $symbol:literal: $kind:ty,)* }) => {
        $(#[$attribute])*
        pub(crate) struct $table {
            $(pub(crate) $field: $kind,)*
        }

        impl $table {
            /// Looks up all functions; the first that is missing is the error.
            ///
            /// # Safety
            ///
            /// The functions of these names have the types that the standard's headers declare.
            pub(crate) unsafe fn of(
                library: &libloading::Library,
            ) -> Result<Self, (&'static str, libloading::Error)> {
                Ok(Self {
                    $(
                        // SAFETY: the caller's promise
                        $field: *unsafe { library.get::<$kind>($symbol) }
                            .map_err(|refused| ($symbol, refused))?,
                    )*
                })
            }
        }
    };
}
pub(crate) use function_table;
