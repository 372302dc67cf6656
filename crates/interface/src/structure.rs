//! The model structure: which unknowns there are, and what each depends on.

use fmi_schema::fmi3::{DependenciesKind, Fmi3Unknown, ModelStructure};

use crate::{
    error::Problem,
    variable::{Role, Variable},
};

/// Checks that outputs and initial unknowns are complete and that their dependencies are knowns.
pub(crate) fn check(structure: &ModelStructure, variables: &[Variable]) -> Result<(), Problem> {
    // Outputs: every output, each once
    let outputs = List {
        element: "Output",
        entries: structure.outputs().collect(),
        variables,
    };
    outputs.check_entries(|variable| matches!(variable.role, Role::Output | Role::State))?;
    outputs.check_dependencies(|known| {
        matches!(
            known.role,
            Role::Input | Role::Parameter | Role::Independent
        )
    })?;
    // Initial unknowns: every output that is not given exactly
    let initial = List {
        element: "InitialUnknown",
        entries: structure.initial_unknowns().collect(),
        variables,
    };
    initial.check_entries(|variable| variable.role == Role::Output)?;
    initial.check_dependencies(|known| known.role != Role::Output)?;
    initial.check_initial_kinds()?;
    // State derivatives: whatever is listed says of which state it is the derivative
    let derivatives = List {
        element: "ContinuousStateDerivative",
        entries: structure.continuous_state_derivatives().collect(),
        variables,
    };
    for entry in &derivatives.entries {
        let variable = derivatives.variable(entry.value_reference)?;
        if variable.derivative_of.is_none() {
            return Err(Problem::UnexpectedUnknown {
                element: derivatives.element,
                variable: variable.name.clone(),
            });
        }
    }
    Ok(())
}

/// One kind of unknown in the model structure.
struct List<'a> {
    element: &'static str,
    entries: Vec<&'a Fmi3Unknown>,
    variables: &'a [Variable],
}

impl List<'_> {
    fn variable(&self, reference: u32) -> Result<&Variable, Problem> {
        self.variables
            .iter()
            .find(|variable| variable.reference == reference)
            .ok_or(Problem::UndefinedReference {
                element: self.element,
                reference,
            })
    }

    fn check_entries(&self, belongs: impl Fn(&Variable) -> bool) -> Result<(), Problem> {
        for (index, entry) in self.entries.iter().enumerate() {
            let variable = self.variable(entry.value_reference)?;
            let problem_here = || (self.element, variable.name.clone());
            if self.entries[..index]
                .iter()
                .any(|earlier| earlier.value_reference == entry.value_reference)
            {
                let (element, variable) = problem_here();
                return Err(Problem::DuplicateUnknown { element, variable });
            }
            if !belongs(variable) {
                let (element, variable) = problem_here();
                return Err(Problem::UnexpectedUnknown { element, variable });
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
            Some(variable) => Err(Problem::MissingUnknown {
                element: self.element,
                variable: variable.name.clone(),
            }),
            None => Ok(()),
        }
    }

    fn check_dependencies(&self, is_known: impl Fn(&Variable) -> bool) -> Result<(), Problem> {
        for entry in &self.entries {
            let variable = self.variable(entry.value_reference)?.name.clone();
            let element = self.element;
            let Some(dependencies) = entry.dependencies.as_deref() else {
                return Err(Problem::NoDependencies { element, variable });
            };
            for (index, &reference) in dependencies.iter().enumerate() {
                let known = self.variable(reference)?;
                let dependency = known.name.clone();
                if !is_known(known) {
                    return Err(Problem::NotKnown {
                        element,
                        variable,
                        dependency,
                    });
                }
                if dependencies[..index].contains(&reference) {
                    return Err(Problem::DuplicateDependency {
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
                return Err(Problem::KindCount {
                    element,
                    variable,
                    dependencies: dependencies.len(),
                    kinds,
                });
            }
        }
        Ok(())
    }

    fn check_initial_kinds(&self) -> Result<(), Problem> {
        for entry in &self.entries {
            let kinds = entry.dependencies_kind.as_deref().unwrap_or_default();
            if kinds.iter().any(|kind| {
                !matches!(
                    kind,
                    DependenciesKind::Dependent | DependenciesKind::Constant
                )
            }) {
                let variable = self.variable(entry.value_reference)?.name.clone();
                return Err(Problem::InitialKind { variable });
            }
        }
        Ok(())
    }
}
