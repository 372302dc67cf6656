//! The lap model from responses at several levels: stepped sines with force, response and phase, by maximum likelihood through
//! harmonic balance.
//!
//! Phase and amplitude and nothing else of the bodies' sum x₁ + x₂ are linear, and the relative motion r = x₁ − x₂ is an
//! oscillator by itself. Taken as a function of its own amplitude it never folds, so that lines beyond a fold and runs with
//! controlled response are as good as any.

mod backbone;
mod choice;
mod data;
mod decay;
mod dynamic_stiffness;
mod file;
mod fit;
mod kinks;
mod model;
mod odd;
mod passive;
mod plausible;
mod prediction;
mod reliability;
mod result;
mod slider;
mod slip;
mod start;
mod step;
mod study;
mod table;
mod terms;
mod told;
mod warnings;

pub use backbone::{BackboneLine, BackboneRun};
pub use choice::ModelComparison;
pub use data::{SineLine, SineRun, Use};
pub use decay::{Coloured, InTime, NotInTime};
pub use fit::{AtLimit, Fit};
pub use model::{Model, Motion, ResponseUnknown, Values};
pub use passive::Limit;
pub use prediction::{
    BackbonePrediction, BetweenRuns, CurvePoint, Expected, Fall, NoInterval, PointPrediction,
    Prediction, Resonance, ResonanceInterval, RunScatter, Unpredicted,
};
pub use result::{Estimate, LapResponse};
pub use slider::{Slider, SliderParameter, SliderValues};
pub use start::fit_responses;
pub use study::{LapResponseStudy, Noise, NoiseIs, Place};
pub use terms::TermSet;
