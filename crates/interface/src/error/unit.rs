//! What can be wrong with units and types of a model description.

/// What is wrong with a unit, a type or the unit of a derivative.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum UnitProblem {
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
