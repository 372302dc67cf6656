//! The interface as one joint: stiffness and damping of every element of the contact, summed with their lever arms.
//!
//! [`Contact`] is what an element has per area, [`InterfaceJoint`] the sum: symmetric 6×6 matrices for the relative motion of
//! two nodes, one on each part, at a reference point. [`Motions`] is the part of it that a joint file holds. [`matrix27`] and
//! [`table`] write the whole of it for finite-element programs.

mod axis;
mod contact;
mod damping;
mod interface;
mod matrix27;
mod motions;
mod own;
mod table;

pub use axis::{Axis, AxisError, SignedAxis};
pub use contact::{Contact, PatchMoments};
pub use damping::{LossFactor, NormalDamping};
pub use interface::{DOFS, InterfaceJoint, Matrix6};
pub use matrix27::matrix27;
pub use motions::{Motion, Motions, PartOfInterface, PlanarError};
pub use own::{OwnStiffness, Principal};
pub use table::table;
