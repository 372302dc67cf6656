//! Identification of joints in space: six relative motions, from functions of two substructures and their assembly.
//!
//! The functions of a substructure are measured by sensors and hammer impacts near the interface, which make a virtual point
//! ([`bolted_joint_virtual_point`]), or are those of a node with six DOFs, as a finite-element program gives them. Whatever
//! functions of the assembly were measured between the same sensors and impacts are data.
//!
//! [`SpatialStudy`] is what a study of method `frf-space` says, [`SpatialStudy::identify`] estimates the joint by maximum
//! likelihood and carries the errors of the set-up into its deviations, [`SpatialIdentification`] is what was found.
#![forbid(unsafe_code)]

mod advice;
mod anew;
mod as_a_whole;
mod assembled;
mod budget;
mod chain;
mod coherence;
mod coherent_parts;
mod compliant;
mod consistency;
mod contradicted;
mod dyads;
mod error;
mod estimate;
mod few;
mod fit;
mod fits;
mod functions;
mod further;
mod hidden;
mod identification;
mod joint_file;
mod lack;
mod level;
mod links;
mod loose;
mod lossy;
mod massive;
mod mirrored;
mod misfits;
mod motionless;
mod normal;
mod numbers;
mod odd;
mod outcome;
mod parallel;
mod part_noise;
mod passive;
mod patterns;
mod phases;
mod prior;
mod problem;
mod reasons;
mod richer;
mod rigid;
mod rivals;
#[cfg(test)]
mod samples;
mod search;
mod settled;
mod shifted;
mod side;
mod spread;
mod starts;
mod steps;
mod study;
mod sums;
mod tables;
mod together;
mod transformations;
mod uneven;
mod valley;

pub use chain::{
    Addition, Aim, Answer, Answers, Apart, ChainIdentification, ChainStudy, FoundJoint, Plan,
    Planned, Reason, joints_sought,
};
pub use consistency::SideConsistency;
pub use error::SpatialError;
pub use identification::{
    FunctionFit, Group, SetUpError, SpatialIdentification, Substructures, Unknown,
};
pub use misfits::{Misfit, MisfitCause};
pub use part_noise::PartNoise;
pub use problem::Level;
pub use study::SpatialStudy;
// what its errors and indicators are told by
pub use bolted_joint_virtual_point::{Change, Role};
