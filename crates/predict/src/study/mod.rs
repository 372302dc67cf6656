//! The study of a prediction, from its file to the joint: what is known of surfaces, materials and bolts, checked before
//! anything is computed, and what follows from it.
//!
//! [`InterfaceStudy::read`] takes a study of method `fractal-contact` or `virtual-material`, [`Prediction::of`] computes it at the
//! values given and at every draw of those that are uncertain, and [`Prediction::joint_file`] is what the export takes. Studies
//! of method `layered-beam` are those of [`super::layered_beam`]; [`bolted_joint_study::StudyText::method`] tells which it is.

mod both_surfaces;
mod check;
mod clamping;
mod contact_curve;
mod error;
mod field_csv;
mod geometry;
mod joint_file;
mod law;
mod model;
mod prediction;
mod refusal;
mod results;
mod slip;
mod tables;
mod warnings;

pub use check::InterfaceStudy;
pub use error::ModelError;
pub use geometry::Plate;
pub use law::Layer;
pub use model::State;
pub use prediction::{CONTACT_ALONE, Prediction};
pub use results::Unknown;
pub use slip::{Microslip, Slip};
