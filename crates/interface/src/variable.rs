//! One declared variable, with what its type and unit say about it.

use fmi_schema::fmi3::{Causality, Float64Type, FmiFloat64, Initial, Variability};

use crate::{
    combination::{effective_initial, is_allowed},
    error::DefinitionProblem,
};

/// What a variable is to the library.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// Time.
    Independent,
    /// Tunable parameter.
    Parameter,
    /// Continuous input.
    Input,
    /// What has an initial value that is known exactly: a continuous state, exposed as an output or as a local variable.
    State,
    /// Output whose initial value is calculated, and that is a continuous state.
    InnerState,
    /// Output that is calculated.
    Output,
    /// Local variable whose sign tells of events.
    Indicator,
    /// Local variable that is calculated, as the derivative of a continuous state.
    Derivative,
    /// Tunable parameter that is calculated from others.
    CalculatedParameter,
}

/// A variable of an FMU, checked.
#[derive(Clone, Debug, PartialEq)]
pub struct Variable {
    /// Structured name, such as `joint.k_yy`.
    pub name: String,
    /// Value reference.
    pub reference: u32,
    /// What it is to the library.
    pub role: Role,
    /// Start value in `unit`; `None` for what is calculated.
    pub start: Option<f64>,
    /// Coherent SI unit.
    pub unit: String,
    /// Typical magnitude in `unit`, 1 where the type gives none.
    pub nominal: f64,
    /// Value reference of the variable that this one is the time derivative of.
    pub derivative_of: Option<u32>,
    /// Whether it is an output.
    pub is_output: bool,
    /// Whether it can be accessed in Intermediate Update Mode.
    pub intermediate_update: bool,
    /// One line for people.
    pub description: String,
}

impl Variable {
    /// Checks one `<Float64>` on its own, against its type.
    pub(crate) fn new(
        declared: &FmiFloat64,
        types: &[&Float64Type],
    ) -> Result<Self, DefinitionProblem> {
        let variable = declared.name.clone();
        if !is_structured(&variable) {
            return Err(DefinitionProblem::IllegalName { variable });
        }
        if !declared.dimensions.is_empty() {
            return Err(DefinitionProblem::NotScalar { variable });
        }
        let description = declared.description.clone();
        let Some(description) = description.filter(|text| !text.trim().is_empty()) else {
            return Err(DefinitionProblem::NoDescription { variable });
        };
        let Some(declared_type) = declared.declared_type.clone() else {
            return Err(DefinitionProblem::NoType { variable });
        };
        let mut types = types.iter();
        let Some(declared_type) = types.find(|candidate| candidate.name == declared_type) else {
            return Err(DefinitionProblem::UndefinedType {
                variable,
                declared_type,
            });
        };
        let role = role(declared)?;
        let start = start(declared, declared_type, role)?;
        Ok(Self {
            name: variable,
            reference: declared.value_reference,
            role,
            start,
            unit: declared_type.unit.clone().unwrap_or_default(),
            nominal: declared_type.nominal.unwrap_or(1.0),
            is_output: declared.causality == Some(Causality::Output),
            derivative_of: declared.derivative,
            intermediate_update: intermediate_update(declared, role)?,
            description,
        })
    }
}

/// Whether the name is `word(.word)*`, the part of FMI's structured naming convention that this project uses.
fn is_structured(name: &str) -> bool {
    name.split('.').all(|word| {
        word.chars().all(|c| c.is_ascii_alphanumeric() || c == '_')
            && word.starts_with(|c: char| !c.is_ascii_digit())
    })
}

fn role(declared: &FmiFloat64) -> Result<Role, DefinitionProblem> {
    let variable = declared.name.clone();
    let causality = declared.causality.unwrap_or_default();
    let variability = declared
        .variability
        .unwrap_or(default_variability(causality));
    if !is_allowed(causality, variability) {
        return Err(DefinitionProblem::Combination {
            variable,
            causality,
            variability,
        });
    }
    let initial = match effective_initial(causality, variability, declared.initial) {
        Ok(initial) => initial,
        Err(initial) => {
            return Err(DefinitionProblem::ForbiddenInitial {
                variable,
                initial,
                causality,
                variability,
            });
        }
    };
    match (causality, variability, initial) {
        (Causality::Independent, ..) => Ok(Role::Independent),
        (Causality::Parameter, Variability::Tunable, _) => Ok(Role::Parameter),
        (Causality::CalculatedParameter, Variability::Tunable, Some(Initial::Calculated)) => {
            Ok(Role::CalculatedParameter)
        }
        (Causality::Input, Variability::Continuous, _) => Ok(Role::Input),
        (Causality::Output | Causality::Local, Variability::Continuous, Some(Initial::Exact)) => {
            Ok(Role::State)
        }
        (Causality::Output, Variability::Continuous, Some(Initial::Calculated)) => Ok(Role::Output),
        (Causality::Local, Variability::Continuous, Some(Initial::Calculated))
            if declared.derivative.is_some() =>
        {
            Ok(Role::Derivative)
        }
        (Causality::Local, Variability::Continuous, Some(Initial::Calculated)) => {
            Ok(Role::Indicator)
        }
        // legal in FMI, but nothing that the library implements
        _ => Err(DefinitionProblem::NoRole {
            variable,
            causality,
            variability,
            initial,
        }),
    }
}

/// FMI 3.0, 2.4.7.4: parameters are fixed unless they say otherwise, Float64 of any other causality is continuous.
fn default_variability(causality: Causality) -> Variability {
    match causality {
        Causality::Parameter | Causality::CalculatedParameter | Causality::StructuralParameter => {
            Variability::Fixed
        }
        _ => Variability::Continuous,
    }
}

/// FMI 3.0, 2.4.7: only continuous-time variables can have `intermediateUpdate`. Parameters are tunable here, and the
/// time is told by the callback itself.
fn intermediate_update(declared: &FmiFloat64, role: Role) -> Result<bool, DefinitionProblem> {
    let found = declared.intermediate_update.unwrap_or(false);
    match role {
        Role::Independent | Role::Parameter | Role::CalculatedParameter if found => {
            Err(DefinitionProblem::IntermediateUpdate {
                variable: declared.name.clone(),
            })
        }
        _ => Ok(found),
    }
}

fn start(
    declared: &FmiFloat64,
    declared_type: &Float64Type,
    role: Role,
) -> Result<Option<f64>, DefinitionProblem> {
    let variable = declared.name.clone();
    let needed = matches!(role, Role::Input | Role::Parameter | Role::State);
    let Some(found) = declared.start.as_deref() else {
        return if needed {
            Err(DefinitionProblem::NoStart { variable })
        } else {
            Ok(None)
        };
    };
    if !needed {
        return Err(DefinitionProblem::UnwantedStart { variable });
    }
    let start = match *found {
        [start] if start.is_finite() => start,
        _ => {
            let found = found.to_vec();
            return Err(DefinitionProblem::IllegalStart { variable, found });
        }
    };
    // a variable may narrow its type's range
    let min = declared
        .min
        .or(declared_type.min)
        .unwrap_or(f64::NEG_INFINITY);
    let max = declared.max.or(declared_type.max).unwrap_or(f64::INFINITY);
    if !(min..=max).contains(&start) {
        return Err(DefinitionProblem::StartOutOfRange {
            variable,
            start,
            min,
            max,
        });
    }
    Ok(Some(start))
}
