//! Frequency response functions: what was measured, between which degrees of freedom, in which units.

mod coherence;
mod dof;
mod error;
mod function;
mod gathered;
mod noise;
mod options;
mod quantity;
mod reading;
mod resonance;
mod selection;
mod set;
mod uff;
mod unit_label;

pub use coherence::{Coherence, relative_variance};
pub use dof::{Direction, Dof, DofError, Sign};
pub use error::FrfError;
pub use function::Frf;
pub use noise::polluted;
pub use options::ReadOptions;
pub use quantity::Quantity;
pub use reading::{FrfReading, SkippedFunction};
pub use resonance::{Resonance, resonances};
pub use selection::Selection;
pub use set::{FrfSet, Receptance};
pub use uff::{
    ByteOrder, UffProblem, UnitFactorError, UnitSystem, read_uff58, read_uff58_from, write_uff58,
    write_uff58_to, write_uff58b, write_uff58b_to,
};
