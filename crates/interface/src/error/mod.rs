//! What can be wrong with a model description, told so that it can be mended in the file.

mod agreement;
mod frame;
mod structure;
mod unit;
mod variable;

pub use agreement::AgreementProblem;
pub use frame::FrameProblem;
pub use structure::StructureProblem;
pub use unit::UnitProblem;
pub use variable::VariableProblem;

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
        problem: Problem,
    },
}

/// What is wrong inside one model description, or between two.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Problem {
    /// `fmiVersion` is not 3.0.
    #[error("fmiVersion is \"{found}\", expected \"3.0\"")]
    Version {
        /// Version found.
        found: String,
    },
    /// There is no `CoSimulation` element.
    #[error("has no <CoSimulation> element; the library implements Co-Simulation, so declare it")]
    NoCoSimulation,
    /// There is no `ModelExchange` element.
    #[error("has no <ModelExchange> element; the library implements Model Exchange, so declare it")]
    NoModelExchange,
    /// The two interface types name different libraries.
    #[error(
        "modelIdentifier is \"{model_exchange}\" in <ModelExchange> and \"{co_simulation}\" in <CoSimulation>; one library implements both"
    )]
    TwoModelIdentifiers {
        /// Identifier in `ModelExchange`.
        model_exchange: String,
        /// Identifier in `CoSimulation`.
        co_simulation: String,
    },
    /// The model identifier cannot name a C function and a library file.
    #[error(
        "modelIdentifier \"{found}\" is not a C identifier; use letters, digits and underscores only"
    )]
    ModelIdentifier {
        /// Identifier found.
        found: String,
    },
    /// A name is defined twice in a list where names are unique.
    #[error("{list} defines \"{name}\" twice; remove one")]
    DuplicateDefinition {
        /// XML element of the list.
        list: &'static str,
        /// Name that occurs twice.
        name: String,
    },
    /// What is wrong with a variable.
    #[error(transparent)]
    Variable(#[from] VariableProblem),
    /// What is wrong with a unit, a type or the unit of a derivative.
    #[error(transparent)]
    Unit(#[from] UnitProblem),
    /// What is wrong in `ModelStructure`.
    #[error(transparent)]
    Structure(#[from] StructureProblem),
    /// What is wrong with the frame that the model description is made from.
    #[error(transparent)]
    Frame(#[from] FrameProblem),
    /// Where a model description disagrees with the other one.
    #[error(transparent)]
    Agreement(#[from] AgreementProblem),
}
