//! The six motions and loads of an interface from sensors and hammer impacts near it.
//!
//! Nobody can put a sensor or a hammer on the six motions of an interface. Around it the structure is stiff: it moves
//! as a rigid body about a virtual point, and what sensors read and impacts do follows from six motions and loads
//! there. With more than six channels and impacts least squares find these, and what is left tells of errors.
//!
//! Axes are right-handed, positions count from the virtual point. Motions are (x, y, z, rx, ry, rz), loads
//! (fx, fy, fz, mx, my, mz).
//!
//! ```
//! use bolted_joint_space::Axes;
//! use bolted_joint_virtual_point::{Impact, Role, Sensor, SetUp, VirtualPoint, Weights};
//! use nalgebra::{Matrix6, Vector3};
//! use num_complex::Complex64;
//!
//! # fn main() -> Result<(), bolted_joint_virtual_point::VirtualPointError> {
//! // Three triaxial sensors, two hits along each axis.
//! let corners = [[0.03, 0.0, 0.01], [0.0, 0.03, 0.0], [-0.02, 0.0, -0.02]].map(Vector3::from);
//! let axes = Axes::identity();
//! let sensors: Vec<_> =
//!     corners.iter().map(|&at| Sensor::triaxial(at, &axes, [1.0; 3])).collect::<Result<_, _>>()?;
//! let mut impacts = Vec::new();
//! for direction in [Vector3::x(), Vector3::y(), Vector3::z()] {
//!     for aside in [direction.yzx(), -direction.yzx(), direction.zxy()] {
//!         impacts.push(Impact::new((aside + direction) * 0.02, direction, 1.0)?);
//!     }
//! }
//! let set_up = SetUp::new(&sensors, &impacts)?;
//!
//! // What would be measured on a rigid interface, and back.
//! let receptance = Matrix6::<f64>::identity().map(Complex64::from);
//! let functions = set_up.functions(&receptance);
//! let point = VirtualPoint::new(set_up, &Weights::Equal, &Weights::Equal)?;
//! assert!(point.conditioning(Role::Channel).advice().is_empty());
//! assert!((point.receptance(&functions)? - receptance).norm() < 1e-10);
//! # Ok(())
//! # }
//! ```
//!
//! * [`Sensor`], [`Impact`], [`SetUp`]: where they are, R_u and R_f in [`Places`], what they would measure, and the
//!   derivatives by their errors. An estimate of a joint that knows the set-up to a tolerance compares with this.
//! * [`VirtualPoint`]: Y_qm = T_u Y T_f, with its derivatives, its [`Covariance`] by [`Noise`] and by [`Tolerances`].
//! * [`Conditioning`]: whether they tell six motions apart, and [`Advice`]; what they do not see is an
//!   [`UnseenMotion`].
//! * [`Consistency`], [`NoiseTest`]: whether the interface is rigid. [`Suspects`]: which place is bad, with a
//!   [`Diagnosis`].
#![forbid(unsafe_code)]

mod beyond;
mod conditioning;
mod consistency;
mod covariance;
mod diagnosis;
mod error;
mod exchanged;
mod likely;
mod noise;
mod place;
mod places;
mod point;
mod projection;
mod search;
mod sensitivity;
mod setup;
mod suspects;
mod turns;
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
