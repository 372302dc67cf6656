//! Units and types: every number that leaves the FMU is in a coherent SI unit that the file defines.

use fmi_schema::fmi3::{BaseUnit, Float64Type, Fmi3ModelDescription, Fmi3Unit};

use crate::{
    error::{DefinitionProblem, InterfaceProblem},
    variable::Variable,
};

/// Checks that units are defined once, by SI exponents alone, and that their display units are of use.
pub(crate) fn check_units(description: &Fmi3ModelDescription) -> Result<(), InterfaceProblem> {
    let units = units(description);
    for (index, unit) in units.iter().enumerate() {
        if units[..index]
            .iter()
            .any(|earlier| earlier.name == unit.name)
        {
            return Err(InterfaceProblem::DuplicateDefinition {
                list: "<UnitDefinitions>",
                name: unit.name.clone(),
            });
        }
        let base = unit.base_unit.as_ref().ok_or_else(|| {
            InterfaceProblem::Definition(DefinitionProblem::NoBaseUnit {
                unit: unit.name.clone(),
            })
        })?;
        if base.factor.is_some_and(|factor| factor != 1.0)
            || base.offset.is_some_and(|offset| offset != 0.0)
        {
            return Err(InterfaceProblem::Definition(
                DefinitionProblem::NotCoherent {
                    unit: unit.name.clone(),
                },
            ));
        }
        for (index, display) in unit.display_unit.iter().enumerate() {
            if unit.display_unit[..index]
                .iter()
                .any(|earlier| earlier.name == display.name)
            {
                return Err(InterfaceProblem::DuplicateDefinition {
                    list: "<Unit>",
                    name: display.name.clone(),
                });
            }
            let factor = display.factor.unwrap_or(1.0);
            if !(factor.is_finite() && factor > 0.0) {
                return Err(InterfaceProblem::Definition(
                    DefinitionProblem::DisplayFactor {
                        unit: unit.name.clone(),
                        display_unit: display.name.clone(),
                        factor,
                    },
                ));
            }
        }
    }
    Ok(())
}

/// Checks that types are defined once, with a defined unit, a useful nominal value and a possible range.
pub(crate) fn check_types(
    types: &[&Float64Type],
    description: &Fmi3ModelDescription,
) -> Result<(), InterfaceProblem> {
    let units = units(description);
    for (index, declared_type) in types.iter().enumerate() {
        let name = || declared_type.name.clone();
        if types[..index]
            .iter()
            .any(|earlier| earlier.name == declared_type.name)
        {
            return Err(InterfaceProblem::DuplicateDefinition {
                list: "<TypeDefinitions>",
                name: name(),
            });
        }
        let unit_name = declared_type.unit.clone().ok_or_else(|| {
            InterfaceProblem::Definition(DefinitionProblem::NoUnit {
                declared_type: name(),
            })
        })?;
        let unit = units
            .iter()
            .find(|unit| unit.name == unit_name)
            .ok_or_else(|| {
                InterfaceProblem::Definition(DefinitionProblem::UndefinedUnit {
                    declared_type: name(),
                    unit: unit_name.clone(),
                })
            })?;
        if let Some(display_unit) = &declared_type.display_unit
            && !unit
                .display_unit
                .iter()
                .any(|defined| defined.name == *display_unit)
        {
            return Err(InterfaceProblem::Definition(
                DefinitionProblem::UndefinedDisplayUnit {
                    declared_type: name(),
                    unit: unit_name,
                    display_unit: display_unit.clone(),
                },
            ));
        }
        if let Some(nominal) = declared_type.nominal
            && !(nominal.is_finite() && nominal > 0.0)
        {
            return Err(InterfaceProblem::Definition(DefinitionProblem::Nominal {
                declared_type: name(),
                nominal,
            }));
        }
        if let (Some(min), Some(max)) = (declared_type.min, declared_type.max)
            && (min.is_nan() || max.is_nan() || min > max)
        {
            return Err(InterfaceProblem::Definition(DefinitionProblem::Range {
                declared_type: name(),
                min,
                max,
            }));
        }
    }
    Ok(())
}

/// Checks that a `derivative` attribute points at a variable, and that the unit is that variable's unit per second.
pub(crate) fn check_derivatives(
    variables: &[Variable],
    description: &Fmi3ModelDescription,
) -> Result<(), InterfaceProblem> {
    use crate::variable::Role;
    let units = units(description);
    let exponents = |name: &str| {
        units
            .iter()
            .find(|unit| unit.name == name)
            .and_then(|unit| unit.base_unit.as_ref())
            .map(exponents)
    };
    for variable in variables {
        let Some(reference) = variable.derivative_of else {
            continue;
        };
        let of = variables
            .iter()
            .find(|candidate| {
                candidate.reference == reference
                    && candidate.name != variable.name
                    && !matches!(
                        candidate.role,
                        Role::Independent | Role::Parameter | Role::CalculatedParameter
                    )
            })
            .ok_or_else(|| {
                InterfaceProblem::Definition(DefinitionProblem::UndefinedDerivative {
                    variable: variable.name.clone(),
                    reference,
                })
            })?;
        let expected = exponents(&of.unit).map(|mut exponents| {
            exponents[SECOND] -= 1;
            exponents
        });
        if exponents(&variable.unit) != expected {
            return Err(InterfaceProblem::Definition(
                DefinitionProblem::DerivativeUnit {
                    variable: variable.name.clone(),
                    unit: variable.unit.clone(),
                    of: of.name.clone(),
                    of_unit: of.unit.clone(),
                },
            ));
        }
    }
    Ok(())
}

/// Position of the second among the exponents.
const SECOND: usize = 2;

/// Exponents of kg, m, s, A, K, mol, cd, rad.
fn exponents(base: &BaseUnit) -> [i32; 8] {
    [
        base.kg, base.m, base.s, base.a, base.k, base.mol, base.cd, base.rad,
    ]
    .map(Option::unwrap_or_default)
}

pub(crate) fn units(description: &Fmi3ModelDescription) -> &[Fmi3Unit] {
    description
        .unit_definitions
        .as_ref()
        .map_or(&[], |definitions| definitions.units.as_slice())
}
