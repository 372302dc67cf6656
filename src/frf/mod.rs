//! Frequency response functions: what was measured, between which degrees of freedom, in which units.

mod dof;
mod error;
mod function;
mod quantity;
mod set;

pub use dof::{Direction, Dof, DofError, Sign};
pub use error::FrfError;
pub use function::Frf;
pub use quantity::Quantity;
pub use set::{FrfSet, Receptance};
