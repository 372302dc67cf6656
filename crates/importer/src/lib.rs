//! The calling side of FMI: loads the shared library of an FMU and drives its instances, in Co-Simulation, through safe calls.
//!
//! FMI 2.0 and 3.0 differ in names, argument lists and callbacks, not in what is done; [`Library`] and [`Instance`] are
//! the same for both. What the FMU logs is kept ([`Instance::messages`]) and is part of every error.
//!
//! [`header`] declares the C interfaces themselves, every function of both versions.
//!
//! No signature can be checked across the C interface, and a faulty library can do anything to the process that loads it:
//! load code that you do not trust in a process of its own.
#![warn(clippy::undocumented_unsafe_blocks)]

mod error;
pub mod header;
mod instance;
mod library;
mod message;
mod state;

pub use error::ImportError;
pub use instance::{Instance, Setup, Step};
pub use library::{FmiVersion, Library};
pub use message::{Listener, Message, Status};
pub use state::SavedState;
