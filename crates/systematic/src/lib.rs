//! Systematic errors of a test: every quantity of the set-up that a laboratory does not know exactly is a [`Cause`] with a
//! prior standard deviation, and enters the estimate beside the joint.
//!
//! An [`Experiment`] holds what was measured, a [`Budget`] how well the set-up is known. [`estimate`] finds the joint and the
//! causes that are most likely together, with what each group of causes contributes to the variance of each unknown;
//! [`score_tests`] name what is wrong where something is.
#![forbid(unsafe_code)]

mod bending;
mod bending_fit;
mod bending_shape;
mod bends;
mod budget;
mod cause;
mod consistency;
mod coupling;
mod curvature;
mod draw;
mod effect;
mod estimate;
mod experiment;
mod far;
mod freed;
mod line;
mod measured;
mod modal_fit;
mod normal;
mod place;
mod refine;
mod score;
mod search;
mod shares;
mod slope;
mod starts;
mod structures;
mod suspect;
mod taking_part;

pub use budget::{Budget, Prior, priors};
pub use cause::{Cause, Group, MeasuredSet, Side};
pub use consistency::{BandConsistency, BandEstimate, consistency};
pub use curvature::curvature;
pub use draw::{Origin, draw};
pub use estimate::{
    CONTRADICTED, CauseEstimate, Estimate, FAR, Settings, Start, estimate, estimate_near, evaluated,
};
pub use experiment::{
    Assembly, Change, ComplexMatrix, Compute, Computed, Entry, Experiment, JointShape,
    MeasuredFunctions, Structure,
};
pub use measured::{Measured, Places};
pub use refine::refine;
pub use score::{Score, score_tests};
pub use shares::Shares;
pub use suspect::{Diagnosis, Suspect, TELLING, diagnose};
