//! Units and types: every number that leaves the FMU is in a coherent SI unit that the file defines.

use std::collections::HashSet;

use fmi_schema::fmi3::{BaseUnit, Float64Type, Fmi3ModelDescription, Fmi3Unit};

use crate::{
    error::{DefinitionProblem, InterfaceProblem},
    variable::{Role, Variable},
};

/// Checks that units are defined once, by SI exponents alone, and that their display units are of use.
pub(crate) fn check_units(description: &Fmi3ModelDescription) -> Result<(), InterfaceProblem> {
    let units = units(description);
    check_names("<UnitDefinitions>", units.iter().map(|unit| &unit.name))?;
    for definition in units {
        let unit = definition.name.clone();
        let Some(base) = &definition.base_unit else {
            return Err(DefinitionProblem::NoBaseUnit { unit }.into());
        };
        if base.factor.is_some_and(|factor| factor != 1.0)
            || base.offset.is_some_and(|offset| offset != 0.0)
        {
            return Err(DefinitionProblem::NotCoherent { unit }.into());
        }
        let displays = &definition.display_unit;
        check_names("<Unit>", displays.iter().map(|display| &display.name))?;
        for display in displays {
            let factor = display.factor.unwrap_or(1.0);
            if !(factor.is_finite() && factor > 0.0) {
                let display_unit = display.name.clone();
                return Err(DefinitionProblem::DisplayFactor {
                    unit,
                    display_unit,
                    factor,
                }
                .into());
            }
        }
    }
    Ok(())
}

/// Refuses a name that a list defines twice.
pub(crate) fn check_names<'a>(
    list: &'static str,
    names: impl Iterator<Item = &'a String>,
) -> Result<(), InterfaceProblem> {
    let mut earlier = HashSet::new();
    match names.into_iter().find(|name| !earlier.insert(*name)) {
        None => Ok(()),
        Some(name) => {
            let name = name.clone();
            Err(InterfaceProblem::DuplicateDefinition { list, name })
        }
    }
}

/// Checks that types are defined once, with a defined unit, a useful nominal value and a possible range.
pub(crate) fn check_types(
    types: &[&Float64Type],
    description: &Fmi3ModelDescription,
) -> Result<(), InterfaceProblem> {
    check_names("<TypeDefinitions>", types.iter().map(|own| &own.name))?;
    for definition in types {
        check_type(definition, units(description))?;
    }
    Ok(())
}

fn check_type(definition: &Float64Type, units: &[Fmi3Unit]) -> Result<(), DefinitionProblem> {
    let declared_type = definition.name.clone();
    let Some(unit) = definition.unit.clone() else {
        return Err(DefinitionProblem::NoUnit { declared_type });
    };
    let Some(defined) = units.iter().find(|defined| defined.name == unit) else {
        return Err(DefinitionProblem::UndefinedUnit {
            declared_type,
            unit,
        });
    };
    if let Some(display_unit) = definition.display_unit.clone()
        && !(defined.display_unit.iter()).any(|display| display.name == display_unit)
    {
        return Err(DefinitionProblem::UndefinedDisplayUnit {
            declared_type,
            unit,
            display_unit,
        });
    }
    if let Some(nominal) = definition.nominal
        && !(nominal.is_finite() && nominal > 0.0)
    {
        return Err(DefinitionProblem::Nominal {
            declared_type,
            nominal,
        });
    }
    match (definition.min, definition.max) {
        (Some(min), Some(max)) if min.is_nan() || max.is_nan() || min > max => {
            Err(DefinitionProblem::Range {
                declared_type,
                min,
                max,
            })
        }
        _ => Ok(()),
    }
}

/// Checks that a `derivative` attribute points at a variable, and that the unit is that variable's unit per second.
pub(crate) fn check_derivatives(
    variables: &[Variable],
    description: &Fmi3ModelDescription,
) -> Result<(), DefinitionProblem> {
    let units = units(description);
    let exponents = |name: &str| {
        let unit = units.iter().find(|unit| unit.name == name)?;
        unit.base_unit.as_ref().map(exponents)
    };
    for derivative in variables {
        let Some(reference) = derivative.derivative_of else {
            continue;
        };
        let is_it = |candidate: &&Variable| {
            candidate.reference == reference
                && candidate.name != derivative.name
                && !matches!(
                    candidate.role,
                    Role::Independent | Role::Parameter | Role::CalculatedParameter
                )
        };
        let variable = derivative.name.clone();
        let Some(of) = variables.iter().find(is_it) else {
            return Err(DefinitionProblem::UndefinedDerivative {
                variable,
                reference,
            });
        };
        let expected = exponents(&of.unit).map(|mut exponents| {
            exponents[SECOND] -= 1;
            exponents
        });
        if exponents(&derivative.unit) != expected {
            return Err(DefinitionProblem::DerivativeUnit {
                variable,
                unit: derivative.unit.clone(),
                of: of.name.clone(),
                of_unit: of.unit.clone(),
            });
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
