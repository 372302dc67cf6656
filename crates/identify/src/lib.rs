//! Identification of a joint's stiffness and damping matrices from frequency response functions.
//!
//! A [`Study`] names the data; [`identify`] decouples the joint line by line (Tol 3.21), averages over bands, refines the
//! average by weighted least squares on the assembly's receptances and says how well the result is determined.
#![forbid(unsafe_code)]

mod assemble;
mod assessment;
mod averages;
mod band_choice;
mod bands;
mod block;
mod bolt_starts;
mod bootstrap;
mod budget;
mod choice;
mod corrected;
mod data;
mod decoupling;
mod draw;
mod error;
mod estimator;
mod finals;
mod formed;
mod from_modes;
mod glance;
mod group;
mod identification;
mod independent;
mod independent_parts;
mod joint_estimate;
mod joint_file;
mod kernel;
mod lanes;
mod layout;
mod level;
mod likelihood;
mod line;
mod line_by_line;
mod lines;
mod lines_estimate;
mod marquardt;
mod model;
mod motions;
mod noise;
mod normal;
mod objective;
mod observed;
mod outliers;
pub mod parallel;
mod passive;
mod provenance;
mod receptances;
mod reliability;
mod residuals;
mod rival;
mod robust;
mod roughness;
mod scoring;
mod search;
mod seen;
mod sensitivity;
mod slips;
mod standing;
mod starts;
mod strip;
mod study;
mod torque;
mod trials;
mod two_step;
mod uncertainty;
mod unknown;
mod used;
mod watch;
mod weights;

pub use assemble::{predict_assembly, predict_lines};
pub use assessment::Assessment;
pub use band_choice::choose_bands;
pub use bands::{BandChoice, BandChoices, BandOrigin, Bands, UsedBands, band_average};
pub use bootstrap::Bootstrap;
pub use budget::Systematic;
pub use choice::{ModelChoice, ModelFit};
pub use decoupling::{Equation, Inverse, decouple, from_rr, from_rs, from_sr, from_ss, of_bolt};
pub use error::IdentifyError;
pub use from_modes::FromModes;
pub use identification::{AssemblyFit, FunctionFit, Identification, identify, identify_and_draw};
pub use joint_estimate::{BootstrapResult, JointEstimate};
pub use layout::{Bolts, MOST_BOLTS};
pub use level::{Level, LevelMeasure, LevelQuantity};
pub use line_by_line::Equations;
pub use lines::{Lines, Repeats};
pub use lines_estimate::{LinesEstimate, Options, identify_lines};
pub use model::{JointMatrices, JointModel};
pub use noise::{Noise, NoiseLevel, StatedFloor, StatedLevel};
pub use outliers::{Outlier, Outliers};
pub use receptances::{MeasuredSubstructure, Receptances};
pub use sensitivity::{Sensitivity, sensitivities};
pub use slips::{FoundSlip, Slip};
pub use study::{
    Accelerometer, Deviations, FrfFile, FurtherAssembly, MassAtJoint, MeasuredJoint, Rotation,
    SetUp, Source, Study, Substructure,
};
pub use torque::{DependenceFit, TorqueChoice, TorqueDependence};
pub use two_step::{Amplitudes, TwoStep, update_in_two_steps};
pub use uncertainty::{Covariance, unit_covariance};
pub use unknown::Unknown;
pub use watch::Watch;
