//! Equations of a bolted joint and their time integration.
//!
//! This crate is what runs inside every exported FMU: no dependencies, no I/O, no allocation in a step.
//! All quantities are in SI units; the const generic `D` is the number of DOFs a side: 1 (translation y)
//! or 2 (translation y, rotation θ).
#![forbid(unsafe_code)]

mod definiteness;
mod dof;
mod eigenvalues;
mod elementary;
mod escape;
mod higher;
mod integrator;
mod joint;
mod lap;
pub mod law;
mod linearised;
mod loosening;
mod over_preload;
mod pair;
mod propagator;
mod rk4;
mod spectrum;
mod tangent;
mod vector;

pub use definiteness::is_positive_semidefinite;
pub use dof::{DOF_COUNT, DOF_SETS, DOFS, Dof, DofKind};
pub use higher::HigherTerms;
pub use integrator::LapIntegrator;
pub use joint::{JointLaw, Motion};
pub use lap::{Body, Defect, Lap, LapLoads, LapState};
pub use loosening::{CountedState, LapConditions, PassedEnergy};
pub use over_preload::{Beyond, JointOverPreload, TableDefect};
pub use propagator::LapPropagator;
pub use rk4::{PHASE_ERROR_PER_PERIOD, STABILITY_LIMIT_IMAGINARY, STABILITY_LIMIT_REAL, substeps};
pub use spectrum::{Eigenvalue, Spectrum};
