//! Makes the model descriptions of the FMUs from `modelDescription/*.xml`, the table of DOFs and the laws of the joint, checks
//! them and turns them into the tables of the FMU library.
//!
//! A variable is declared once: what belongs to a side or to no DOF in one of the two files, what belongs to a law with the law.
//! Build scripts call [`Interfaces::present`], which refuses anything that an importer could stumble over, and write
//! [`Interfaces::to_rust`] for the library to include.
#![forbid(unsafe_code)]

mod agreement;
mod combination;
mod emit;
mod error;
mod frame;
mod interface;
mod scope;
mod structure;
mod units;
mod variable;

pub use error::{DefinitionProblem, InterfaceError, InterfaceProblem};
pub use frame::{At, Expanded, Filling, Frames, LawParameter, law_parameters};
pub use interface::{ContinuousState, Interface, Interfaces};
pub use scope::{Joints, Rows, Scope};
pub use variable::{Role, Variable};
