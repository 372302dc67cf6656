//! Whole assemblies: structures that joints connect, as one model in modal coordinates, from an assembly file.
//!
//! A structure comes from its modes, from matrices of another program, or is computed as a beam. What is cut of its modes stays
//! as residual vectors, so that the joints see its whole flexibility.
#![forbid(unsafe_code)]

mod error;
mod freedom;
mod from_file;
mod harmonic;
mod linear;
mod modal_form;
mod model;
mod place;
mod reached;
mod read;
mod residual;
mod response;
mod structure;
mod tables;

pub use error::AssemblyError;
pub use harmonic::{ForcedPoint, FreePoint};
pub use linear::AssemblyMode;
pub use modal_form::ModalForm;
pub use model::{AssemblyModel, NamedStructure, PlacedJoint};
pub use place::{Channel, Place};
pub use reached::{BeyondObserved, Reached};
pub use response::{LoadCourse, Response, Span};
