//! The microslip of an interface: patches of a pressure field that slip one after the other, as one law of friction.
//!
//! A patch of the pressure p and the area ΔA slips through at μ p ΔA. Up to there it follows Mindlin's contact, whose stiffness
//! falls with the load by (1 − T/(μP))^(1/3). All patches side by side are a law with memory that obeys Masing's rule; a joint
//! file has Segalman's four parameters in its place.

mod fit;
mod patches;

pub use fit::{Amplitudes, MicroslipLaw};
pub use patches::{Patch, Patches};
