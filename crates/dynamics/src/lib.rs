//! Equations of a bolted joint and their time integration.
//!
//! This crate is what runs inside every exported FMU: no dependencies, no I/O, no allocation in a step.
//! All quantities are in SI units. The const generic `D` is the number of DOFs a side, rows of [`DOFS`]; `N` is the
//! kind of number, real ones or [`Dual`] ones that carry their changes.
#![forbid(unsafe_code)]

pub mod assembly;
mod complex;
mod condensation;
mod counted;
mod definiteness;
mod dof;
mod eigenvalues;
mod elementary;
mod escape;
mod integrator;
mod lap;
pub mod law;
mod motion;
mod number;
mod pair;
mod power_series;
mod propagator;
mod rk4;
mod spectrum;
mod stepper;
mod vector;

pub use counted::{CountedState, LapConditions, PassedEnergy};
pub use definiteness::is_positive_semidefinite;
pub use dof::{DOF_COUNT, DOF_SETS, DOFS, Dof, DofCount, DofKind, SPACE, SPACE_COUNT};
pub use integrator::LapIntegrator;
pub use lap::{Body, Defect, Lap, LapLoads, LapState};
pub use law::{
    Beyond, DOF_AT_REST, DofLaws, DofMemory, JointLaw, JointMemory, JointOverPreload, Linear,
    Polynomial, TableDefect,
};
pub use motion::Motion;
pub use number::{Dual, Number};
pub use propagator::LapPropagator;
pub use rk4::{PHASE_ERROR_PER_PERIOD, STABILITY_LIMIT_IMAGINARY, STABILITY_LIMIT_REAL, substeps};
pub use spectrum::{Eigenvalue, Spectrum};
pub use stepper::{LapMoment, LapStepper};

#[cfg(test)]
mod alike;
#[cfg(test)]
mod random;
