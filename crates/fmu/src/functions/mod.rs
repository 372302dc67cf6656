//! The C functions of FMI 2.0 and FMI 3.0, as `fmi2Functions.h` and `fmi3Functions.h` declare them, by what they do.
//!
//! How they work is told in [`crate::abi`]. Section numbers of FMI 2.0 are those of FMI 2.0.4; its tables of allowed calls
//! are in sections 3.2.3 and 4.2.4.

// the names of the functions are those of the C headers
#![allow(non_snake_case, reason = "the C headers give the names")]

mod co_simulation;
mod derivatives;
mod events;
mod fmu_state;
mod instantiation;
mod lifecycle;
mod model_exchange;
mod not_provided;
mod status;
mod variables;

use std::ffi::c_int;

/// `fmi2Boolean`: any other number than zero is true.
type Fmi2Boolean = c_int;
/// `fmi2Integer`.
type Fmi2Integer = c_int;

/// Defines C functions that work on an instance and return a status: name, the arguments after the instance, on which
/// instances they work (one of the constants of `Way`), and what they do with the instance. Two names are those of two
/// functions, one of each version, that are otherwise the same.
///
/// What is behind the arrow runs within [`call`](crate::abi::call), and may take arguments apart with the unsafe functions
/// of [`arguments`](crate::abi::arguments): their callers' promise is that of the importer.
macro_rules! functions {
    () => {};
    (
        $(#[$doc:meta])*
        $name:ident $arguments:tt $(for $way:ident)? => $body:expr;
        $($rest:tt)*
    ) => {
        functions! { @one [$(#[$doc])*] $name $arguments [$($way)?] $body }
        functions! { $($rest)* }
    };
    (
        $(#[$doc:meta])*
        $name:ident, $other:ident $arguments:tt $(for $way:ident)? => $body:expr;
        $($rest:tt)*
    ) => {
        functions! { @one [$(#[$doc])*] $name $arguments [$($way)?] $body }
        functions! { @one [$(#[$doc])*] $other $arguments [$($way)?] $body }
        functions! { $($rest)* }
    };
    (@one $docs:tt $name:ident $arguments:tt [] $body:expr) => {
        functions! { @one $docs $name $arguments [PLAIN] $body }
    };
    (
        @one [$(#[$doc:meta])*] $name:ident ($($argument:ident: $type:ty),* $(,)?) [$way:ident] $body:expr
    ) => {
        $(#[$doc])*
        ///
        /// # Safety
        ///
        /// `instance` is null, or was returned by an instantiating function and not freed since, and no other thread uses
        /// it. Pointers are null or point to as many values as the arguments beside them tell, to one where they tell none;
        /// nobody else uses these values meanwhile.
        #[unsafe(no_mangle)]
        unsafe extern "C" fn $name(
            instance: $crate::abi::Opaque,
            $($argument: $type),*
        ) -> $crate::logging::Status {
            const FUNCTION: $crate::abi::Function =
                $crate::abi::Function::new(stringify!($name), $crate::abi::Way::$way);
            // SAFETY: the importer's promise
            unsafe { $crate::abi::call(FUNCTION, instance, $body) }
        }
    };
}
use functions;
