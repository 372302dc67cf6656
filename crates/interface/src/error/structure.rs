//! What can be wrong with the model structure of a model description.

/// What is wrong in `ModelStructure`.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum StructureProblem {
    /// A continuous state has no derivative.
    #[error(
        "state \"{variable}\" has no derivative; declare a variable with its valueReference as derivative"
    )]
    NoDerivative {
        /// State's name.
        variable: String,
    },
    /// A value reference in the model structure points nowhere.
    #[error("<{element}> refers to valueReference {reference}, which no variable has")]
    UndefinedReference {
        /// XML element.
        element: &'static str,
        /// Value reference found.
        reference: u32,
    },
    /// A variable is listed twice in a list of the model structure.
    #[error("variable \"{variable}\" has two <{element}> entries; remove one")]
    DuplicateUnknown {
        /// XML element.
        element: &'static str,
        /// Variable's name.
        variable: String,
    },
    /// A variable is missing from a list of the model structure.
    #[error("variable \"{variable}\" has no <{element}> entry; add one with its dependencies")]
    MissingUnknown {
        /// XML element.
        element: &'static str,
        /// Variable's name.
        variable: String,
    },
    /// A variable does not belong in a list of the model structure.
    #[error(
        "variable \"{variable}\" has an <{element}> entry, but it is not an unknown of that kind; remove the entry"
    )]
    UnexpectedUnknown {
        /// XML element.
        element: &'static str,
        /// Variable's name.
        variable: String,
    },
    /// An unknown does not say what it depends on.
    #[error("<{element}> of \"{variable}\" has no dependencies; list them, or give an empty list")]
    NoDependencies {
        /// XML element.
        element: &'static str,
        /// Variable's name.
        variable: String,
    },
    /// An unknown depends on something that is not known at that moment.
    #[error(
        "<{element}> of \"{variable}\" depends on \"{dependency}\", which is not a known there; remove it"
    )]
    NotKnown {
        /// XML element.
        element: &'static str,
        /// Variable's name.
        variable: String,
        /// Name of the variable that it claims to depend on.
        dependency: String,
    },
    /// An unknown lists a dependency twice.
    #[error(
        "<{element}> of \"{variable}\" lists its dependency on \"{dependency}\" twice; remove one"
    )]
    DuplicateDependency {
        /// XML element.
        element: &'static str,
        /// Variable's name.
        variable: String,
        /// Name of the dependency.
        dependency: String,
    },
    /// Dependencies and their kinds differ in number.
    #[error(
        "<{element}> of \"{variable}\" has {dependencies} dependencies and {kinds} dependenciesKind; give one kind for each"
    )]
    KindCount {
        /// XML element.
        element: &'static str,
        /// Variable's name.
        variable: String,
        /// Number of dependencies.
        dependencies: usize,
        /// Number of kinds.
        kinds: usize,
    },
    /// A kind of dependency that is not allowed during initialisation.
    #[error(
        "<InitialUnknown> of \"{variable}\" has a dependenciesKind other than dependent and constant, which FMI 3.0 forbids there"
    )]
    InitialKind {
        /// Variable's name.
        variable: String,
    },
}
