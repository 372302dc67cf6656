//! Layered beams that rivets or bolts hold together and whose interfaces slip in bending: natural frequencies, shapes, and
//! damping over the amplitude (Kavi).
//!
//! A [`LayeredBeam`] bends as one section of `stiffness_ratio` times the stiffness of the solid one. Its modes come from the
//! frequency equations ([`root`], [`ModeShape`]) or from finite elements; both become a [`BeamMode`], one mode as seen from the
//! drive point. Where the layers slip over each other, the [`Fasteners`]' normal force takes energy: [`SlipDamping`].
//!
//! # From a study
//!
//! [`LayeredBeamStudy::read`] takes a TOML file of `method = "layered-beam"`, [`LayeredBeamStudy::run`] computes, and the [`Outcome`] gives the
//! joint file ([`Outcome::joint_file`]), a table of frequencies and damping ratios over the amplitude ([`Outcome::csv`]), a
//! summary for people ([`Outcome::summary`]) and for machines (it serialises), and warnings ([`Outcome::warnings`]).

mod beam;
mod beam_mode;
mod damping;
mod dry_friction;
mod error;
mod fasteners;
mod joint_file;
mod lap;
mod normal_force;
mod outcome;
mod roots;
mod scatter;
mod shape;
mod study;

pub use beam::{Layer, LayeredBeam};
pub use beam_mode::{BeamMode, ELEMENTS, Route, StoredEnergy};
pub use damping::SlipDamping;
pub use dry_friction::{AmplitudeRange, DrySlider};
pub use error::LayeredBeamError;
pub use fasteners::{FastenerKind, Fasteners, NormalForceRule, RIVET_STRESS_PA};
pub use lap::{EquivalentDamping, EquivalentLap};
pub use normal_force::{normal_force_ratio, zone_radius_ratio};
pub use outcome::{AmplitudeRow, ModeRow, Outcome, SlipRow};
pub use roots::root;
pub use scatter::{Scatter, ScatterRow};
pub use shape::ModeShape;
pub use study::{Calibration, Friction, LayeredBeamStudy};
