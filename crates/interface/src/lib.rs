//! Reads `modelDescription/*.xml`, checks it and turns it into the tables of the FMU library.
//!
//! The two files are the only place where a variable of the FMUs is declared. Build scripts call [`Interfaces::read`],
//! which refuses anything that an importer could stumble over, and write [`Interfaces::to_rust`] for the library to include.
#![forbid(unsafe_code)]

mod agreement;
mod combination;
mod dependence;
mod emit;
mod error;
mod interface;
mod rotation;
mod structure;
mod units;
mod variable;

pub use dependence::{Dependence, dependence};
pub use error::{
    AgreementProblem, InterfaceError, Problem, StructureProblem, UnitProblem, VariableProblem,
};
pub use interface::{ContinuousState, Interface, Interfaces};
pub use rotation::requires_rotation;
pub use variable::{Role, Variable};
