//! Frequency response functions: what was measured, between which degrees of freedom, in which units.

mod dof;
mod error;
mod function;
mod noise;
mod quantity;
mod resonance;
mod set;
mod uff;

pub use dof::{Direction, Dof, DofError, Sign};
pub use error::FrfError;
pub use function::Frf;
pub use noise::polluted;
pub use quantity::Quantity;
pub use resonance::{Resonance, resonances};
pub use set::{FrfSet, Receptance};
pub use uff::{
    SkippedFunction, UffOptions, UffProblem, UffReading, UnitFactorError, UnitSystem, read_uff58,
    read_uff58_from, write_uff58, write_uff58_to,
};
