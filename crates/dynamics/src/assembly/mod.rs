//! Whole assemblies in time: structures of many coordinates, and joints of any law between them.
//!
//! The linear part is propagated exactly, at any length of step; only the joints' own frequency limits the step, and that only
//! where their laws are not linear.

mod columns;
mod coordinates;
mod equations;
mod exponential;
mod ladder;
mod lobatto;
mod matrix;
mod modal;
mod modes;
mod phi;
mod preload;
pub mod products;
mod propagator;
mod scratch;
mod stages;
mod state;
mod steps;
mod system;
#[cfg(test)]
mod tests;

pub use coordinates::AssemblyCoordinates;
pub use equations::AssemblyMotion;
pub use matrix::Matrix;
pub use preload::LawOverPreload;
pub use state::{AssemblyState, Underway};
pub use steps::{AssemblySteps, TOLERANCE};
pub use system::{Assembly, AssemblyJoint};
