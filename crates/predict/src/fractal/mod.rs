//! Normal and tangential stiffness and damping of two rough surfaces under a pressure (Zhao).
//!
//! Contacts of all sizes up to a largest one share the load: small ones flow, large ones are elastic. The pressure fixes the
//! size of the largest contact ([`FractalContact::at`]), and with it all that the contacts sum up to ([`PerArea`]).
//! Y. Zhao et al., Stroj. vestn. – J. Mech. Eng. 62 (2016) 665–677.

mod contact;
mod domain;
mod friction;
mod microslip;
mod per_area;

pub use contact::FractalContact;
pub use domain::domain_extension_factor;
pub use friction::Friction;
pub use microslip::StoredEnergy;
pub use per_area::{PerArea, Regime};
