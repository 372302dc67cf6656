//! The model structure: which unknowns there are, and what each depends on.

use fmi_schema::fmi3::{DependenciesKind, Fmi3Unknown, ModelStructure};

use crate::{
    error::InterfaceProblem,
    interface::ContinuousState,
    variable::{Role, Variable},
};

/// Checks that outputs and initial unknowns are complete and that their dependencies are knowns.
pub(crate) fn check(
    structure: &ModelStructure,
    variables: &[Variable],
) -> Result<(), InterfaceProblem> {
    let list = |element, entries| List {
        element,
        entries,
        variables,
    };
    // Outputs: every output, each once
    let outputs = list("Output", structure.outputs().collect());
    outputs.check_entries(|variable| variable.is_output)?;
    outputs.check_dependencies()?;
    // Initial unknowns: every output and every derivative that is not given exactly, and every calculated parameter
    let initial = list("InitialUnknown", structure.initial_unknowns().collect());
    initial.check_entries(|variable| {
        matches!(
            variable.role,
            Role::Output | Role::InnerState | Role::Derivative | Role::CalculatedParameter
        )
    })?;
    initial.check_dependencies()?;
    initial.check_initial_kinds()?;
    // State derivatives: that of every state, each once
    let entries = structure.continuous_state_derivatives().collect();
    let derivatives = list("ContinuousStateDerivative", entries);
    derivatives.check_entries(|variable| state_of(variable, variables).is_some())?;
    derivatives.check_dependencies()?;
    // Event indicators: every one, each once
    let indicators = list("EventIndicator", structure.event_indicators().collect());
    indicators.check_entries(|variable| variable.role == Role::Indicator)?;
    indicators.check_dependencies()
}

/// The continuous states, in the order of their derivatives.
pub(crate) fn continuous_states(
    structure: &ModelStructure,
    variables: &[Variable],
) -> Result<Vec<ContinuousState>, InterfaceProblem> {
    let mut states = Vec::new();
    for entry in structure.continuous_state_derivatives() {
        let derivative = variables
            .iter()
            .find(|variable| variable.reference == entry.value_reference);
        if let Some(state) = derivative.and_then(|derivative| state_of(derivative, variables)) {
            states.push(ContinuousState {
                reference: state.reference,
                derivative: entry.value_reference,
                nominal: state.nominal,
            });
        }
    }
    let is_listed = |variable: &Variable| {
        states
            .iter()
            .any(|state| state.reference == variable.reference)
    };
    match variables
        .iter()
        .find(|variable| is_state(variable) && !is_listed(variable))
    {
        Some(state) => Err(InterfaceProblem::NoDerivative {
            variable: state.name.clone(),
        }),
        None => Ok(states),
    }
}

/// The continuous state that `variable` is the derivative of.
fn state_of<'a>(variable: &Variable, variables: &'a [Variable]) -> Option<&'a Variable> {
    let reference = variable.derivative_of?;
    variables
        .iter()
        .find(|candidate| candidate.reference == reference && is_state(candidate))
}

fn is_state(variable: &Variable) -> bool {
    matches!(variable.role, Role::State | Role::InnerState)
}

/// Whether outputs and derivatives may depend on the variable.
fn is_known(variable: &Variable) -> bool {
    matches!(
        variable.role,
        Role::Input | Role::State | Role::InnerState | Role::Parameter | Role::Independent
    )
}

/// One kind of unknown in the model structure.
struct List<'a> {
    element: &'static str,
    entries: Vec<&'a Fmi3Unknown>,
    variables: &'a [Variable],
}

impl List<'_> {
    fn variable(&self, reference: u32) -> Result<&Variable, InterfaceProblem> {
        self.variables
            .iter()
            .find(|variable| variable.reference == reference)
            .ok_or(InterfaceProblem::UndefinedReference {
                element: self.element,
                reference,
            })
    }

    fn check_entries(&self, belongs: impl Fn(&Variable) -> bool) -> Result<(), InterfaceProblem> {
        for (index, entry) in self.entries.iter().enumerate() {
            let found = self.variable(entry.value_reference)?;
            let (element, variable) = (self.element, found.name.clone());
            let mut earlier = self.entries[..index].iter();
            if earlier.any(|earlier| earlier.value_reference == entry.value_reference) {
                return Err(InterfaceProblem::DuplicateUnknown { element, variable });
            }
            if !belongs(found) {
                return Err(InterfaceProblem::UnexpectedUnknown { element, variable });
            }
        }
        let missing = self.variables.iter().find(|variable| {
            belongs(variable)
                && !self
                    .entries
                    .iter()
                    .any(|entry| entry.value_reference == variable.reference)
        });
        match missing {
            Some(variable) => Err(InterfaceProblem::MissingUnknown {
                element: self.element,
                variable: variable.name.clone(),
            }),
            None => Ok(()),
        }
    }

    fn check_dependencies(&self) -> Result<(), InterfaceProblem> {
        for entry in &self.entries {
            let variable = self.variable(entry.value_reference)?.name.clone();
            let element = self.element;
            let Some(dependencies) = entry.dependencies.as_deref() else {
                return Err(InterfaceProblem::NoDependencies { element, variable });
            };
            for (index, &reference) in dependencies.iter().enumerate() {
                let known = self.variable(reference)?;
                let dependency = known.name.clone();
                if !is_known(known) {
                    return Err(InterfaceProblem::NotKnown {
                        element,
                        variable,
                        dependency,
                    });
                }
                if dependencies[..index].contains(&reference) {
                    return Err(InterfaceProblem::DuplicateDependency {
                        element,
                        variable,
                        dependency,
                    });
                }
            }
            let kinds = entry
                .dependencies_kind
                .as_deref()
                .map_or(dependencies.len(), <[_]>::len);
            if kinds != dependencies.len() {
                return Err(InterfaceProblem::KindCount {
                    element,
                    variable,
                    dependencies: dependencies.len(),
                    kinds,
                });
            }
        }
        Ok(())
    }

    fn check_initial_kinds(&self) -> Result<(), InterfaceProblem> {
        for entry in &self.entries {
            let kinds = entry.dependencies_kind.as_deref().unwrap_or_default();
            if kinds.iter().any(|kind| {
                !matches!(
                    kind,
                    DependenciesKind::Dependent | DependenciesKind::Constant
                )
            }) {
                let variable = self.variable(entry.value_reference)?.name.clone();
                return Err(InterfaceProblem::InitialKind { variable });
            }
        }
        Ok(())
    }
}
