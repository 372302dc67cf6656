//! Identification of the symmetric lap model (Pirdayr): from natural frequencies, which determine little, and from responses
//! at several levels, which determine its springs, dampers and their dependence on amplitude.
//!
//!   m ẍ₁ + c ẋ₁ + k x₁ + c₁₂(ẋ₁ − ẋ₂) + k₁₂(x₁ − x₂) + k_N (x₁ − x₂)³ = F₁, and the same for x₂ with the joint's load reversed
#![forbid(unsafe_code)]

mod error;
mod input;
mod parameter;
mod response;
mod update;

pub use bolted_joint_dynamics::law::Term;
pub use error::LapError;
pub use parameter::{LapParameter, LapParameters};
pub use response::{
    AtLimit, BackboneLine, BackbonePrediction, BackboneRun, BetweenRuns, Coloured, CurvePoint,
    Estimate, Expected, Fall, Fit, InTime, LapResponse, LapResponseStudy, Limit, Model,
    ModelComparison, Motion, NoInterval, Noise, NoiseIs, NotInTime, Place, PointPrediction,
    Prediction, Resonance, ResonanceInterval, ResponseUnknown, RunScatter, SineLine, SineRun,
    Slider, SliderParameter, SliderValues, TermSet, Unpredicted, Use, Values, fit_responses,
};
pub use update::{
    Combination, Firefly, FireflyResult, Identifiability, Knowledge, LapUpdate, LapUpdateStudy,
    Range, TorqueData, TorqueUpdate, UpdateProblem, fireflies, least_squares,
};
