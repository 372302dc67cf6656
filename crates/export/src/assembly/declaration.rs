//! The list of an assembly's variables as a model description declares them.

use std::collections::BTreeSet;

use fmi_schema::fmi3::{
    Causality, DependenciesKind, Float64Type, Fmi3ModelDescription, Fmi3Unknown, FmiFloat64,
    Initial, TypeDefinition, Variability, VariableDependency,
};
use fmi_schema::utils::AttrList;

use super::super::description::floats;
use super::super::start_file::FIRST_LISTED;
use super::variables::{List, Listed, Role, TypeOf};

/// Value reference of the variable at a place.
pub(super) fn reference(place: usize) -> u32 {
    FIRST_LISTED + place as u32
}

/// The variables, with the types of the frame in `tree`.
pub(super) fn variables(list: &List, tree: &Fmi3ModelDescription) -> Vec<FmiFloat64> {
    let all = list.variables.iter().enumerate();
    all.map(|(place, own)| variable(place, own, tree)).collect()
}

fn variable(place: usize, own: &Listed, tree: &Fmi3ModelDescription) -> FmiFloat64 {
    let of_lap = |name: &str| floats(tree).find(|other| other.name == name);
    let (declared_type, description) = match &own.declared_type {
        TypeOf::Named(name) => (Some((*name).to_owned()), own.description.clone()),
        TypeOf::OfMagnitude(name, exponent) => {
            (Some(of_magnitude(name, *exponent)), own.description.clone())
        }
        TypeOf::OfLap(name) => match of_lap(name) {
            Some(other) if own.role == Role::Limited => {
                (other.declared_type.clone(), own.description.clone())
            }
            Some(other) => {
                let told = other.description.clone().unwrap_or_default();
                (
                    other.declared_type.clone(),
                    format!("{}: {told}", own.description),
                )
            }
            None => (None, own.description.clone()),
        },
    };
    let (causality, initial) = match own.role {
        Role::Input | Role::Limited => (Causality::Input, None),
        Role::State if own.is_output => (Causality::Output, Some(Initial::Exact)),
        Role::State => (Causality::Local, Some(Initial::Exact)),
        Role::Inner | Role::Output => (Causality::Output, Some(Initial::Calculated)),
        Role::Derivative | Role::Indicator => (Causality::Local, Some(Initial::Calculated)),
    };
    FmiFloat64 {
        name: own.name.clone(),
        value_reference: reference(place),
        description: Some(description),
        causality: Some(causality),
        variability: Some(Variability::Continuous),
        initial,
        intermediate_update: (own.role != Role::Indicator).then_some(true),
        declared_type,
        derivative: own.derivative_of.map(reference),
        start: matches!(own.role, Role::Input | Role::Limited | Role::State)
            .then(|| AttrList(vec![own.start])),
        ..FmiFloat64::default()
    }
}

/// Name of a type with a typical magnitude of its own.
fn of_magnitude(name: &str, exponent: i32) -> String {
    format!("{name}About1e{exponent}")
}

/// The types that the frame does not have, each made of one that it has.
pub(super) fn types(list: &List, tree: &Fmi3ModelDescription) -> Vec<Float64Type> {
    let wanted: BTreeSet<(&str, i32)> = list
        .variables
        .iter()
        .filter_map(|own| match own.declared_type {
            TypeOf::OfMagnitude(name, exponent) => Some((name, exponent)),
            TypeOf::Named(_) | TypeOf::OfLap(_) => None,
        })
        .collect();
    let definitions = tree
        .type_definitions
        .iter()
        .flat_map(|all| &all.type_definitions);
    let known: Vec<&Float64Type> = definitions
        .filter_map(|definition| match definition {
            TypeDefinition::Float64(own) => Some(own),
            _ => None,
        })
        .collect();
    wanted
        .into_iter()
        .filter_map(|(name, exponent)| {
            let own = known.iter().find(|own| own.name == name)?;
            Some(Float64Type {
                name: of_magnitude(name, exponent),
                quantity: own.quantity.clone(),
                unit: own.unit.clone(),
                display_unit: own.display_unit.clone(),
                nominal: Some(10.0_f64.powi(exponent)),
                ..Float64Type::default()
            })
        })
        .collect()
}

/// The model structure.
pub(super) fn unknowns(list: &List) -> Vec<VariableDependency> {
    let mut all = Vec::new();
    let variables = || list.variables.iter().enumerate();
    for (place, own) in variables().filter(|(_, own)| own.is_output) {
        let on = match own.role {
            // an output that is a state depends on itself
            Role::State | Role::Inner => vec![place],
            _ => own.on.clone(),
        };
        all.push(VariableDependency::Output(unknown(place, &on)));
    }
    for [_, place] in list.states() {
        let on = &list.variables[place].on;
        all.push(VariableDependency::ContinuousStateDerivative(unknown(
            place, on,
        )));
    }
    let initial = |own: &Listed| matches!(own.role, Role::Output | Role::Inner | Role::Derivative);
    for (place, own) in variables().filter(|(_, own)| initial(own)) {
        let on = &own.initially_on;
        all.push(VariableDependency::InitialUnknown(unknown(place, on)));
    }
    for (place, own) in variables().filter(|(_, own)| own.role == Role::Indicator) {
        all.push(VariableDependency::EventIndicator(unknown(place, &own.on)));
    }
    all
}

fn unknown(place: usize, on: &[usize]) -> Fmi3Unknown {
    Fmi3Unknown {
        annotations: None,
        value_reference: reference(place),
        dependencies: Some(AttrList(on.iter().map(|&own| reference(own)).collect())),
        dependencies_kind: Some(AttrList(
            on.iter().map(|_| DependenciesKind::Dependent).collect(),
        )),
    }
}
