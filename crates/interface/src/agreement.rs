//! What the two model descriptions must have in common: one library stands behind both.

use crate::{
    error::InterfaceProblem,
    interface::{Interface, float64_types},
    units::units,
};

/// Checks that `this` agrees with `other` in value references, types, units, log categories and library name.
pub(crate) fn check(this: &Interface, other: &Interface) -> Result<(), InterfaceProblem> {
    check_references(this, other)?;
    let differs = |what, name: &str| InterfaceProblem::DefinitionDiffers {
        what,
        name: name.to_owned(),
        other: other.file.clone(),
    };
    if this.model_identifier != other.model_identifier {
        return Err(differs("modelIdentifier", &this.model_identifier));
    }
    if this.log_categories != other.log_categories {
        return Err(differs(
            "list of log categories",
            &this.log_categories.join(" "),
        ));
    }
    let others = units(&other.description);
    for unit in units(&this.description) {
        if others
            .iter()
            .any(|counterpart| counterpart.name == unit.name && counterpart != unit)
        {
            return Err(differs("unit", &unit.name));
        }
    }
    let others = float64_types(&other.description);
    for declared_type in float64_types(&this.description) {
        if others.iter().any(|counterpart| {
            counterpart.name == declared_type.name && *counterpart != declared_type
        }) {
            return Err(differs("type", &declared_type.name));
        }
    }
    for variable in &this.variables {
        let counterpart = other.variable(&variable.name);
        if counterpart.is_some_and(|counterpart| counterpart.unit != variable.unit) {
            return Err(differs("unit of variable", &variable.name));
        }
    }
    Ok(())
}

fn check_references(this: &Interface, other: &Interface) -> Result<(), InterfaceProblem> {
    for variable in &this.variables {
        if let Some(counterpart) = other.variable(&variable.name)
            && counterpart.reference != variable.reference
        {
            return Err(InterfaceProblem::ReferenceDiffers {
                variable: variable.name.clone(),
                reference: variable.reference,
                other: other.file.clone(),
                other_reference: counterpart.reference,
            });
        }
        if let Some(counterpart) = other.variables.iter().find(|counterpart| {
            counterpart.reference == variable.reference && counterpart.name != variable.name
        }) {
            return Err(InterfaceProblem::ReferenceReused {
                reference: variable.reference,
                variable: variable.name.clone(),
                other: other.file.clone(),
                other_variable: counterpart.name.clone(),
            });
        }
    }
    let used = |reference: u32| {
        [this, other]
            .iter()
            .flat_map(|interface| &interface.variables)
            .any(|variable| variable.reference == reference)
    };
    let largest = [this, other]
        .iter()
        .flat_map(|interface| &interface.variables)
        .map(|variable| variable.reference)
        .max()
        .unwrap_or(0);
    match (0..=largest).find(|&reference| !used(reference)) {
        Some(reference) => Err(InterfaceProblem::Gap { reference }),
        None => Ok(()),
    }
}
