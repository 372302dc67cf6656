//! A joint's matrices in space: axes, transport, centre of elasticity, patterns of bolts.
//!
//! In space a joint has six relative motions r = q_a − q_b, q = (x, y, z, rx, ry, rz), and its stiffness up to 21
//! numbers. They belong to a point and to axes; what they say of the joint itself does not.
//!
//! ```
//! use bolted_joint_space::{CentreOfElasticity, JointModel, Mirrors, Part, Uncertainty, transported};
//! use nalgebra::Vector3;
//!
//! # fn main() -> Result<(), bolted_joint_space::SpaceError> {
//! // One bolt along z, told 20 mm below its middle.
//! let bolt = JointModel::Bolt { axis: Vector3::z(), mirrors: Mirrors::Kept }.parametrisation()?;
//! assert_eq!(bolt.names(Part::Stiffness), ["k_x", "k_z", "k_rx", "k_rz", "k_x_ry"]);
//! let stiffness = bolt.matrix(&[2e8, 5e8, 3e4, 1e4, 1e6])?;
//! let below = transported(&stiffness, &Vector3::new(0.0, 0.0, -0.02));
//!
//! // Its centre of elasticity is k_x_ry/k_x = 5 mm above the middle.
//! let centre = CentreOfElasticity::of(&below, &Uncertainty::None)?;
//! assert!(centre.is_unique() && (centre.offset_m.z - 0.025).abs() < 1e-12);
//!
//! // It is a bolt still, and all that the model cannot hold is rounding.
//! assert!(bolt.nearest(&below, 0.02)?.left_out_share < 1e-12);
//! # Ok(())
//! # }
//! ```
//!
//! * [`transported`], [`rotated`]: a matrix at another point, in other [`Axes`]; [`planar`] and [`in_space`] go to
//!   planar beams and back; [`JointMatrices`] moves stiffness, damping and inertia together.
//! * [`CentreOfElasticity`], [`PrincipalAxes`]: what a joint has of its own, as far as an [`Uncertainty`] lets it be
//!   told.
//! * [`condensed`]: a joint for some of its DOFs.
//! * [`JointModel`]: which of the 21 numbers are unknown, and how the others follow; [`Parametrisation`] has the
//!   matrices.
//! * [`Coupled`]: receptances of an assembly, and what changes of its joints do; [`Selection`] says where the joints
//!   are.
//! * [`ToldApart`]: whether measurements tell two joints apart.
#![forbid(unsafe_code)]

mod axes;
mod centre;
mod chain;
mod condensed;
mod coupled;
mod dof;
mod elimination;
mod error;
mod matrices;
mod model;
mod motions;
mod planar;
mod principal;
mod selection;
mod symmetry;
mod transport;
mod uncertainty;

#[cfg(test)]
mod samples;

pub use axes::{Axes, rotated};
pub use centre::CentreOfElasticity;
pub use chain::ToldApart;
pub use condensed::{Others, condensed};
pub use coupled::Coupled;
pub use dof::{Dof, Entry, Part, numbers, symmetric};
pub use error::SpaceError;
pub use matrices::JointMatrices;
pub use model::{BoltNumbers, JointModel, Mirrors, Nearest, Parametrisation};
pub use motions::Motions;
pub use planar::{BeamAlong, in_space, planar};
pub use principal::{PrincipalAxes, PrincipalStiffness};
pub use selection::{Connection, Selection, block_diagonal, lumped};
pub use symmetry::semidefinite;
pub use transport::{transport, transported};
pub use uncertainty::Uncertainty;
