//! What can be wrong with a model description as a whole, with the frame that it is made from, and between two of them.

use super::DefinitionProblem;

/// What is wrong inside one model description or its frame, or between two.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum InterfaceProblem {
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
    /// What is wrong with a variable, a unit, a type or the unit of a derivative.
    #[error(transparent)]
    Definition(#[from] DefinitionProblem),
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
    /// A variable or an unknown is not written as one empty element on one line.
    #[error(
        "line {line} is not one whole element; write it as <{tag} name=\"value\" …/> on a line of its own"
    )]
    NotALine {
        /// Line number, from 1.
        line: usize,
        /// XML element.
        tag: &'static str,
    },
    /// An element has no name.
    #[error("line {line} has no name; name the variable that it is about")]
    NoName {
        /// Line number, from 1.
        line: usize,
    },
    /// An attribute of the frame's own has a word that it cannot have.
    #[error("line {line}: found {attribute}=\"{found}\", expected {expected}")]
    Word {
        /// Line number, from 1.
        line: usize,
        /// Attribute's name.
        attribute: &'static str,
        /// Word found.
        found: String,
        /// Words that it can have.
        expected: &'static str,
    },
    /// A placeholder stands for nothing there.
    #[error(
        "line {line}: {{{placeholder}}} stands for nothing there; is the line one for each DOF?"
    )]
    Placeholder {
        /// Line number, from 1.
        line: usize,
        /// Word between the braces.
        placeholder: String,
    },
    /// A name that is referred to is not declared.
    #[error("line {line} refers to \"{name}\", which no variable has as its name")]
    UndefinedName {
        /// Line number, from 1.
        line: usize,
        /// Name found.
        name: String,
    },
    /// An unknown says nothing of its dependencies, and no line before it does.
    #[error(
        "line {line} says nothing of what \"{name}\" depends on; say it here, or with the same name in a line above"
    )]
    NothingDependedOn {
        /// Line number, from 1.
        line: usize,
        /// Variable's name.
        name: String,
    },
    /// The frame's type is not what the law says.
    #[error(
        "type \"{declared_type}\" has unit \"{unit}\", but \"{of_law}\" by the declaration of its law; make them agree"
    )]
    TypeUnit {
        /// Type's name.
        declared_type: String,
        /// Its unit in the frame.
        unit: String,
        /// Its unit by the law.
        of_law: String,
    },
    /// The list of value references has a name twice.
    #[error("\"{name}\" has two value references; keep the first")]
    ReferenceTwice {
        /// Variable's name.
        name: String,
    },
    /// A variable has another value reference than in the other file.
    #[error(
        "variable \"{variable}\" has valueReference {reference}, but {other_reference} in {other}; the same name has the same number in every file"
    )]
    ReferenceDiffers {
        /// Variable's name.
        variable: String,
        /// Value reference here.
        reference: u32,
        /// Name of the other file.
        other: String,
        /// Value reference there.
        other_reference: u32,
    },
    /// A value reference names another variable than in the other file.
    #[error(
        "valueReference {reference} is \"{variable}\", but \"{other_variable}\" in {other}; take a number that no file uses"
    )]
    ReferenceReused {
        /// Value reference.
        reference: u32,
        /// Variable's name here.
        variable: String,
        /// Name of the other file.
        other: String,
        /// Variable's name there.
        other_variable: String,
    },
    /// Value references leave gaps, so that they are no index.
    #[error(
        "valueReference {reference} is used by no file though larger ones are; number the variables without gaps"
    )]
    Gap {
        /// Smallest value reference that is missing.
        reference: u32,
    },
    /// A definition shared by both files differs.
    #[error("{what} \"{name}\" is not the same as in {other}; make them equal")]
    DefinitionDiffers {
        /// Kind of definition.
        what: &'static str,
        /// Its name.
        name: String,
        /// Name of the other file.
        other: String,
    },
}

impl InterfaceProblem {
    /// The problem of a placeholder on the line with this number.
    pub(crate) fn placeholder(line: usize) -> impl Fn(String) -> Self {
        move |placeholder| Self::Placeholder { line, placeholder }
    }
}
