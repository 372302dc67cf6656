//! Identification of a joint's stiffness and damping matrices from frequency response functions.
//!
//! A [`Study`] names the data; [`identify`] decouples the joint line by line (Tol 3.21), averages over bands, refines the
//! average by weighted least squares on the assembly's receptances and says how well the result is determined.

mod assemble;
mod assessment;
mod bands;
mod block;
mod bootstrap;
mod choice;
mod decoupling;
mod error;
mod estimator;
mod group;
mod identification;
mod independent;
mod joint_file;
mod kernel;
mod lanes;
mod line_by_line;
mod lines;
mod lines_estimate;
mod model;
mod noise;
mod normal;
mod objective;
pub(crate) mod parallel;
mod passive;
mod provenance;
mod search;
mod sensitivity;
mod starts;
mod strip;
mod study;
mod two_step;
mod uncertainty;
mod unknown;
mod watch;
mod weights;

pub use assemble::{predict_assembly, predict_lines};
pub use assessment::Assessment;
pub use bands::{Bands, band_average, choose_bands};
pub use bootstrap::Bootstrap;
pub use choice::{ModelChoice, ModelFit};
pub use decoupling::{Equation, Inverse, decouple, from_rr, from_rs, from_sr, from_ss, of_bolt};
pub use error::IdentifyError;
pub use identification::{AssemblyFit, FunctionFit, Identification, identify, identify_and_draw};
pub use lines::{Lines, MeasuredSubstructure, Repeats};
pub use lines_estimate::{BootstrapResult, LinesEstimate, Options, identify_lines};
pub use model::{JointMatrices, JointModel};
pub use noise::{Noise, NoiseLevel, StatedLevel};
pub use sensitivity::{Sensitivity, sensitivities};
pub use study::{FrfFile, FurtherAssembly, Rotation, Source, Study, Substructure};
pub use two_step::{Amplitudes, TwoStep, update_in_two_steps};
pub use uncertainty::Covariance;
pub use unknown::Unknown;
pub use watch::Watch;
