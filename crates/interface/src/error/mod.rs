//! What can be wrong with a model description, told so that it can be mended in the file.

mod definition;
mod problem;

pub use definition::DefinitionProblem;
pub use problem::InterfaceProblem;

/// A model description that the library must not be built from.
#[derive(Debug, thiserror::Error)]
#[error("{file}: {problem}")]
pub struct InterfaceError {
    /// File name.
    pub file: String,
    /// What is wrong, and how to mend it.
    pub problem: InterfaceProblem,
}
