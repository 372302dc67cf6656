//! Identification of a joint's stiffness and damping matrices from frequency response functions.
//!
//! A [`Study`] names the data; [`identify`] decouples the joint line by line (Tol 3.21), averages over bands, refines the
//! average by weighted least squares on the assembly's receptances and says how well the result is determined.

mod assemble;
mod bands;
mod decoupling;
mod error;
mod estimator;
mod identification;
mod lines;
mod model;
mod provenance;
mod starts;
mod study;
mod unknown;

pub use assemble::predict_assembly;
pub use bands::Bands;
pub use decoupling::{from_rr, from_rs, from_sr, from_ss};
pub use error::IdentifyError;
pub use estimator::NoiseLevel;
pub use identification::{FunctionFit, Identification, LinesEstimate, identify, identify_lines};
pub use lines::Lines;
pub use model::{JointMatrices, JointModel};
pub use study::{FrfFile, Rotation, Source, Study, Substructure};
pub use unknown::Unknown;
