//! What can be wrong with a model description, told so that it can be mended in the file.

mod definition;
mod problem;

pub use definition::DefinitionProblem;
pub use problem::InterfaceProblem;

/// A model description that the library must not be built from.
#[derive(Debug, thiserror::Error)]
pub enum InterfaceError {
    /// The file is not an FMI 3.0 model description.
    #[error(
        "{file}: is not an FMI 3.0 model description: {source}; compare it with fmi3ModelDescription.xsd"
    )]
    Malformed {
        /// File name.
        file: String,
        /// What the parser said.
        source: fmi_schema::Error,
    },
    /// The file contradicts itself, the FMI standard or this project's rules.
    #[error("{file}: {problem}")]
    Inconsistent {
        /// File name.
        file: String,
        /// What is wrong, and how to mend it.
        problem: InterfaceProblem,
    },
}
