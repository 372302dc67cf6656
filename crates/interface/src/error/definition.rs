//! What can be wrong with the variables, units and types of a model description.

use fmi_schema::fmi3::{Causality, Initial, Variability};

/// What is wrong with a variable, a unit, a type or the unit of a derivative.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum DefinitionProblem {
    /// A variable that does not change continuously claims intermediate updates.
    #[error(
        "variable {variable} has intermediateUpdate=\"true\", which only continuous inputs, outputs and local variables can have"
    )]
    IntermediateUpdate {
        /// Name of the variable.
        variable: String,
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
}
