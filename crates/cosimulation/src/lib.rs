//! How long a communication step may be when an FMU and its neighbours are coupled explicitly, each held still for the
//! other while it steps.
//!
//! The bound is that of the discrete loop itself: its one-step map is written down exactly, and the bound is the shortest
//! step at which an eigenvalue leaves the unit circle.
#![forbid(unsafe_code)]

mod element;
mod flexible;
mod lap;
mod stability;

pub use element::{CouplingError, Inertia, Master, Neighbours, element_bound};
pub use flexible::{Flexible, LoadOfStep};
pub use lap::{Restraint, lap_bound};
pub use stability::StepBound;
