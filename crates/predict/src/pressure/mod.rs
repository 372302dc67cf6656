//! The pressure between two parts that bolts hold together.

mod balance;
mod bolt;
mod bolted;
mod error;
mod field;
mod file;
mod plate;
mod radial;
mod tightening;
mod uniform;
mod unilateral;
mod zone;

pub use balance::Balance;
pub use bolt::{Bolt, bolts_in_rows, bolts_on_circle, bolts_under_moment, with_preloads};
pub use bolted::{BoltShare, BoltedField, BoltedInterface};
pub use error::PressureError;
pub use field::{Element, PressureField};
pub use plate::Rectangle;
pub use tightening::{ThreadFriction, Tightening, coarse_pitch_m};
pub use unilateral::UnilateralField;
pub use zone::{Cone, ConePressure, Reach, ThicknessRatio, Zone, ZoneForce};
