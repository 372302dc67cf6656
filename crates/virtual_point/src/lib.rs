//! The six motions and loads of an interface from sensors and hammer impacts near it.
#![forbid(unsafe_code)]

mod conditioning;
mod consistency;
mod covariance;
mod diagnosis;
mod error;
mod noise;
mod place;
mod places;
mod point;
mod projection;
mod sensitivity;
mod setup;
mod suspects;
mod unseen;
mod weights;
mod words;

pub use conditioning::{Advice, Conditioning};
pub use consistency::Consistency;
pub use covariance::{Covariance, Tolerance, Tolerances};
pub use diagnosis::Diagnosis;
pub use error::VirtualPointError;
pub use noise::{Noise, NoiseTest};
pub use place::{Change, Impact, Place, Role, Sensor};
pub use places::{Parameter, Places};
pub use point::VirtualPoint;
pub use setup::SetUp;
pub use suspects::{Suspect, Suspects};
pub use unseen::UnseenMotion;
pub use weights::Weights;

#[cfg(test)]
mod samples;
#[cfg(test)]
mod tests;
