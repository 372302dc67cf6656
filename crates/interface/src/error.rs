//! What can be wrong with a model description, told so that it can be mended in the file.

use fmi_schema::fmi3::{Causality, Initial, Variability};

/// A model description that the library must not be built from.
#[derive(Debug, thiserror::Error)]
pub enum InterfaceError {
    /// The file could not be read.
    #[error("{path}: cannot be read: {source}; put the model description there")]
    Unreadable {
        /// Path of the file.
        path: String,
        /// What the operating system said.
        source: std::io::Error,
    },
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
    /// A variable that does not change continuously claims intermediate updates.
    #[error(
        "variable {variable} has intermediateUpdate=\"true\", which only continuous inputs, outputs and local variables can have"
    )]
    IntermediateUpdate {
        /// Name of the variable.
        variable: String,
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
    /// A variable is not of type Float64.
    #[error("variable \"{variable}\" is not a Float64; the library knows no other type")]
    NotFloat64 {
        /// Variable's name.
        variable: String,
    },
    /// A variable is an array.
    #[error("variable \"{variable}\" has dimensions; declare one scalar variable for each element")]
    NotScalar {
        /// Variable's name.
        variable: String,
    },
    /// The name does not follow the structured naming convention, as far as this project uses it.
    #[error(
        "variable \"{variable}\" has an illegal name; join words of letters, digits and underscores, none starting with a digit, by dots"
    )]
    IllegalName {
        /// Variable's name.
        variable: String,
    },
    /// Two variables share a name.
    #[error("variable \"{variable}\" is declared twice; rename or remove one")]
    DuplicateName {
        /// Variable's name.
        variable: String,
    },
    /// Two variables share a value reference.
    #[error(
        "variables \"{first}\" and \"{second}\" share valueReference {reference}; give one of them the next free number"
    )]
    DuplicateReference {
        /// Value reference.
        reference: u32,
        /// Variable that came first.
        first: String,
        /// Variable that came second.
        second: String,
    },
    /// A variable has no description.
    #[error("variable \"{variable}\" has no description; add one")]
    NoDescription {
        /// Variable's name.
        variable: String,
    },
    /// A variable names no type.
    #[error("variable \"{variable}\" has no declaredType; name the type that carries its unit")]
    NoType {
        /// Variable's name.
        variable: String,
    },
    /// A variable names a type that does not exist.
    #[error(
        "variable \"{variable}\" has declaredType \"{declared_type}\", which <TypeDefinitions> does not define; define it"
    )]
    UndefinedType {
        /// Variable's name.
        variable: String,
        /// Type's name.
        declared_type: String,
    },
    /// A name is defined twice in a list where names are unique.
    #[error("{list} defines \"{name}\" twice; remove one")]
    DuplicateDefinition {
        /// XML element of the list.
        list: &'static str,
        /// Name that occurs twice.
        name: String,
    },
    /// A type has no unit.
    #[error("type \"{declared_type}\" has no unit; name one")]
    NoUnit {
        /// Type's name.
        declared_type: String,
    },
    /// A type has a unit that does not exist.
    #[error(
        "type \"{declared_type}\" has unit \"{unit}\", which <UnitDefinitions> does not define; define it with its SI exponents"
    )]
    UndefinedUnit {
        /// Type's name.
        declared_type: String,
        /// Unit's name.
        unit: String,
    },
    /// A type has a display unit that its unit does not offer.
    #[error(
        "type \"{declared_type}\" has displayUnit \"{display_unit}\", which unit \"{unit}\" does not define; add a <DisplayUnit> there"
    )]
    UndefinedDisplayUnit {
        /// Type's name.
        declared_type: String,
        /// Unit's name.
        unit: String,
        /// Display unit's name.
        display_unit: String,
    },
    /// A unit does not say what it is in SI base units.
    #[error("unit \"{unit}\" has no <BaseUnit>; give its SI exponents")]
    NoBaseUnit {
        /// Unit's name.
        unit: String,
    },
    /// A unit is not a coherent SI unit.
    #[error(
        "unit \"{unit}\" has a factor or an offset; the library computes in SI units, so make it a <DisplayUnit>"
    )]
    NotCoherent {
        /// Unit's name.
        unit: String,
    },
    /// A display unit has a useless factor.
    #[error(
        "display unit \"{display_unit}\" of unit \"{unit}\" has factor {factor}; it must be finite and greater than zero"
    )]
    DisplayFactor {
        /// Unit's name.
        unit: String,
        /// Display unit's name.
        display_unit: String,
        /// Factor found.
        factor: f64,
    },
    /// A type's nominal value is useless.
    #[error(
        "type \"{declared_type}\" has nominal {nominal}; it must be finite and greater than zero"
    )]
    Nominal {
        /// Type's name.
        declared_type: String,
        /// Nominal value found.
        nominal: f64,
    },
    /// Minimum above maximum.
    #[error(
        "type \"{declared_type}\" has min {min} and max {max}; the minimum must not be above the maximum"
    )]
    Range {
        /// Type's name.
        declared_type: String,
        /// Minimum.
        min: f64,
        /// Maximum.
        max: f64,
    },
    /// Causality and variability that the standard does not combine.
    #[error(
        "variable \"{variable}\" combines causality {causality:?} with variability {variability:?}, which FMI 3.0 forbids"
    )]
    Combination {
        /// Variable's name.
        variable: String,
        /// Causality found.
        causality: Causality,
        /// Variability found.
        variability: Variability,
    },
    /// `initial` that the standard does not allow there.
    #[error(
        "variable \"{variable}\" has initial {initial:?}, which FMI 3.0 forbids with causality {causality:?} and variability {variability:?}"
    )]
    ForbiddenInitial {
        /// Variable's name.
        variable: String,
        /// `initial` found.
        initial: Initial,
        /// Causality found.
        causality: Causality,
        /// Variability found.
        variability: Variability,
    },
    /// Legal in FMI, but nothing that the library implements.
    #[error(
        "variable \"{variable}\" has causality {causality:?}, variability {variability:?} and initial {initial:?}, which the library does not implement; use a tunable parameter, a continuous input, or a continuous output that is exact (a state) or calculated, or a local derivative"
    )]
    NoRole {
        /// Variable's name.
        variable: String,
        /// Causality found.
        causality: Causality,
        /// Variability found.
        variability: Variability,
        /// `initial` found, or its default.
        initial: Option<Initial>,
    },
    /// A start value is missing.
    #[error(
        "variable \"{variable}\" needs a start value: it is an input or has initial exact or approx"
    )]
    NoStart {
        /// Variable's name.
        variable: String,
    },
    /// A start value where none may be.
    #[error("variable \"{variable}\" must not have a start value: it is calculated or independent")]
    UnwantedStart {
        /// Variable's name.
        variable: String,
    },
    /// A start value that is not one finite number.
    #[error("variable \"{variable}\" has start {found:?}; expected one finite number")]
    IllegalStart {
        /// Variable's name.
        variable: String,
        /// Numbers found.
        found: Vec<f64>,
    },
    /// A start value outside the variable's range.
    #[error("variable \"{variable}\" starts at {start}, outside its range {min} to {max}")]
    StartOutOfRange {
        /// Variable's name.
        variable: String,
        /// Start value.
        start: f64,
        /// Minimum.
        min: f64,
        /// Maximum.
        max: f64,
    },
    /// The independent variable is not exactly one, named time, with value reference 0.
    #[error(
        "needs exactly one independent variable, \"time\" with valueReference 0; found {found:?}"
    )]
    Independent {
        /// Names and value references of the independent variables.
        found: Vec<(String, u32)>,
    },
    /// The `derivative` attribute points nowhere.
    #[error(
        "variable \"{variable}\" is the derivative of valueReference {reference}, which is no continuous variable of this file"
    )]
    UndefinedDerivative {
        /// Variable's name.
        variable: String,
        /// Value reference found.
        reference: u32,
    },
    /// The derivative's unit is not that of the variable per second.
    #[error(
        "variable \"{variable}\" has unit \"{unit}\", but it is the derivative of \"{of}\" in \"{of_unit}\": expected \"{of_unit}\" per second"
    )]
    DerivativeUnit {
        /// Variable's name.
        variable: String,
        /// Its unit.
        unit: String,
        /// Variable that it is the derivative of.
        of: String,
        /// That variable's unit.
        of_unit: String,
    },
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
