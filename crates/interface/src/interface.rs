//! The interface of one FMU, read from its model description, and that of both.

use fmi_schema::{
    fmi3::{
        Causality, Float64Type, Fmi3ModelDescription, Initial, TypeDefinition, Variability,
        Variable as Declared,
    },
    traits::FmiModelDescription,
};

use crate::{
    agreement,
    error::{DefinitionProblem, InterfaceError, InterfaceProblem},
    frame::{Expanded, Filling, Frames},
    scope::Joints,
    structure, units,
    variable::{Role, Variable},
};

/// Interface of one FMU, checked.
#[derive(Debug)]
pub struct Interface {
    /// File that it was read from, such as `lap.xml`.
    pub file: String,
    /// Name of the library, without its extension.
    pub model_identifier: String,
    /// Variables in the order of their value references.
    pub variables: Vec<Variable>,
    /// Continuous states, in the order of their derivatives in the model structure.
    pub continuous_states: Vec<ContinuousState>,
    /// Value references of the event indicators, in the order of the model structure.
    pub event_indicators: Vec<u32>,
    /// Names of the log categories, in the order of the file.
    pub log_categories: Vec<String>,
    pub(crate) description: Fmi3ModelDescription,
}

impl Interface {
    /// Reads and checks one model description.
    ///
    /// # Errors
    ///
    /// [`InterfaceError::Malformed`] if `xml` is no FMI 3.0 model description, [`InterfaceError::Inconsistent`] with
    /// the first [`InterfaceProblem`] found in it.
    pub fn from_xml(file: &str, xml: &str) -> Result<Self, InterfaceError> {
        let description =
            Fmi3ModelDescription::deserialize(xml).map_err(|source| InterfaceError::Malformed {
                file: file.to_owned(),
                source,
            })?;
        Self::checked(file, description).map_err(|problem| InterfaceError::Inconsistent {
            file: file.to_owned(),
            problem,
        })
    }

    /// Variable of this name.
    #[must_use]
    pub fn variable(&self, name: &str) -> Option<&Variable> {
        self.variables.iter().find(|variable| variable.name == name)
    }

    /// Checks that this agrees with `other` in all that they share.
    ///
    /// # Errors
    ///
    /// [`InterfaceError::Inconsistent`], naming the file of this one.
    pub fn check_against(&self, other: &Self) -> Result<(), InterfaceError> {
        agreement::check(self, other).map_err(|problem| InterfaceError::Inconsistent {
            file: self.file.clone(),
            problem,
        })
    }

    fn checked(file: &str, description: Fmi3ModelDescription) -> Result<Self, InterfaceProblem> {
        let model_identifier = check_header(&description)?;
        units::check_units(&description)?;
        let types = float64_types(&description);
        units::check_types(&types, &description)?;
        let log_categories = log_categories(&description)?;
        let mut variables = description
            .model_variables
            .variables
            .iter()
            .map(|declared| match declared {
                Declared::Float64(declared) => Variable::new(declared, &types),
                other => Err(DefinitionProblem::NotFloat64 {
                    variable: name_of(other),
                }),
            })
            .collect::<Result<Vec<_>, _>>()?;
        check_uniqueness(&variables)?;
        tell_inner_states(&mut variables);
        check_indicators(&variables, &description)?;
        check_independent(&variables)?;
        variables.sort_by_key(|variable| variable.reference);
        units::check_derivatives(&variables, &description)?;
        structure::check(&description.model_structure, &variables)?;
        let continuous_states =
            structure::continuous_states(&description.model_structure, &variables)?;
        Ok(Self {
            file: file.to_owned(),
            model_identifier,
            variables,
            continuous_states,
            event_indicators: description
                .model_structure
                .event_indicators()
                .map(|indicator| indicator.value_reference)
                .collect(),
            log_categories,
            description,
        })
    }
}

/// A continuous state of Model Exchange.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContinuousState {
    /// Value reference of the state.
    pub reference: u32,
    /// Value reference of its derivative.
    pub derivative: u32,
    /// Typical magnitude of the state, in its unit.
    pub nominal: f64,
}

/// Interfaces of both FMUs, checked against each other.
#[derive(Debug)]
pub struct Interfaces {
    /// The joint alone, `element.xml`.
    pub element: Interface,
    /// Two bodies and the joint between them, `lap.xml`.
    pub lap: Interface,
    /// Where the variables of both come from.
    pub(crate) expanded: [Expanded; 2],
    pub(crate) dof_count: usize,
    /// Names of the laws that remember the motion, with the kind of joints that has each.
    pub(crate) memory_laws: Vec<(String, Joints)>,
}

impl Interfaces {
    /// The interfaces with the project's own frames, DOFs and laws.
    ///
    /// ```
    /// use bolted_joint_interface::{Interfaces, Role};
    ///
    /// let interfaces = Interfaces::present()?;
    /// let load = interfaces.element.variable("a.F").expect("the element's load on side a");
    /// assert_eq!(load.role, Role::Output);
    /// # Ok::<(), bolted_joint_interface::InterfaceError>(())
    /// ```
    ///
    /// # Errors
    ///
    /// As [`Interfaces::new`].
    pub fn present() -> Result<Self, InterfaceError> {
        Self::new(&Frames::PRESENT, &Filling::PRESENT)
    }

    /// Makes both model descriptions and checks them.
    ///
    /// # Errors
    ///
    /// [`InterfaceError`] for the first that is inconsistent, or where the two disagree.
    pub fn new(frames: &Frames<'_>, filling: &Filling<'_>) -> Result<Self, InterfaceError> {
        let expanded = Expanded::new(frames, filling)?;
        let [element, lap] = &expanded;
        let element = Interface::from_xml(element.file, &element.xml)?;
        let lap = Interface::from_xml(lap.file, &lap.xml)?;
        lap.check_against(&element)?;
        Ok(Self {
            element,
            lap,
            expanded,
            dof_count: filling.dofs.len(),
            memory_laws: Joints::of_memory_laws(filling.laws),
        })
    }

    /// Number of value references: one more than the largest.
    #[must_use]
    pub fn reference_count(&self) -> usize {
        [&self.element, &self.lap]
            .iter()
            .flat_map(|interface| &interface.variables)
            .map(|variable| variable.reference as usize + 1)
            .max()
            .unwrap_or(0)
    }

    /// Value references of the inputs of either FMU, ascending.
    #[must_use]
    pub fn input_references(&self) -> Vec<u32> {
        let mut references: Vec<u32> = [&self.element, &self.lap]
            .iter()
            .flat_map(|interface| &interface.variables)
            .filter(|variable| variable.role == Role::Input)
            .map(|variable| variable.reference)
            .collect();
        references.sort_unstable();
        references.dedup();
        references
    }
}

fn check_header(description: &Fmi3ModelDescription) -> Result<String, InterfaceProblem> {
    if description.fmi_version != "3.0" {
        return Err(InterfaceProblem::Version {
            found: description.fmi_version.clone(),
        });
    }
    let identifier = description
        .co_simulation
        .as_ref()
        .map(|co_simulation| co_simulation.model_identifier.clone())
        .ok_or(InterfaceProblem::NoCoSimulation)?;
    let of_model_exchange = description
        .model_exchange
        .as_ref()
        .map(|model_exchange| &model_exchange.model_identifier)
        .ok_or(InterfaceProblem::NoModelExchange)?;
    if *of_model_exchange != identifier {
        return Err(InterfaceProblem::TwoModelIdentifiers {
            model_exchange: of_model_exchange.clone(),
            co_simulation: identifier,
        });
    }
    let is_c_identifier = identifier.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_')
        && identifier
            .chars()
            .all(|c| c.is_ascii_alphanumeric() || c == '_');
    if is_c_identifier {
        Ok(identifier)
    } else {
        Err(InterfaceProblem::ModelIdentifier { found: identifier })
    }
}

pub(crate) fn float64_types(description: &Fmi3ModelDescription) -> Vec<&Float64Type> {
    description
        .type_definitions
        .iter()
        .flat_map(|types| &types.type_definitions)
        .filter_map(|definition| match definition {
            TypeDefinition::Float64(float64) => Some(float64),
            _ => None,
        })
        .collect()
}

fn log_categories(description: &Fmi3ModelDescription) -> Result<Vec<String>, InterfaceProblem> {
    let lists = description.log_categories.iter();
    let categories = lists.flat_map(|list| &list.categories);
    let names: Vec<String> = categories.map(|category| category.name.clone()).collect();
    units::check_names("<LogCategories>", names.iter())?;
    Ok(names)
}

fn name_of(declared: &Declared) -> String {
    use fmi_schema::fmi3::AbstractVariableTrait as _;
    match declared {
        Declared::Int8(variable) => variable.name(),
        Declared::UInt8(variable) => variable.name(),
        Declared::Int16(variable) => variable.name(),
        Declared::UInt16(variable) => variable.name(),
        Declared::Int32(variable) => variable.name(),
        Declared::UInt32(variable) => variable.name(),
        Declared::Int64(variable) => variable.name(),
        Declared::UInt64(variable) => variable.name(),
        Declared::Float32(variable) => variable.name(),
        Declared::Float64(variable) => variable.name(),
        Declared::Boolean(variable) => variable.name(),
        Declared::String(variable) => variable.name(),
        Declared::Binary(variable) => variable.name(),
        Declared::Clock(variable) => variable.name(),
    }
    .to_owned()
}

/// Outputs that are calculated at first and have a local variable as their derivative are states.
fn tell_inner_states(variables: &mut [Variable]) {
    let states: Vec<u32> = variables
        .iter()
        .filter(|variable| variable.role == Role::Derivative)
        .filter_map(|variable| variable.derivative_of)
        .collect();
    for variable in variables {
        if variable.role == Role::Output && states.contains(&variable.reference) {
            variable.role = Role::InnerState;
        }
    }
}

/// A calculated local variable that is no derivative has to be an event indicator.
fn check_indicators(
    variables: &[Variable],
    description: &Fmi3ModelDescription,
) -> Result<(), DefinitionProblem> {
    let is_listed = |variable: &&Variable| {
        let mut listed = description.model_structure.event_indicators();
        listed.any(|indicator| indicator.value_reference == variable.reference)
    };
    let mut locals = variables.iter();
    let stray = locals.find(|local| local.role == Role::Indicator && !is_listed(local));
    match stray {
        Some(local) => Err(DefinitionProblem::NoRole {
            variable: local.name.clone(),
            causality: Causality::Local,
            variability: Variability::Continuous,
            initial: Some(Initial::Calculated),
        }),
        None => Ok(()),
    }
}

fn check_uniqueness(variables: &[Variable]) -> Result<(), DefinitionProblem> {
    for (index, second) in variables.iter().enumerate() {
        for first in &variables[..index] {
            if first.name == second.name {
                let variable = second.name.clone();
                return Err(DefinitionProblem::DuplicateName { variable });
            }
            if first.reference == second.reference {
                return Err(DefinitionProblem::DuplicateReference {
                    reference: second.reference,
                    first: first.name.clone(),
                    second: second.name.clone(),
                });
            }
        }
    }
    Ok(())
}

fn check_independent(variables: &[Variable]) -> Result<(), DefinitionProblem> {
    let found: Vec<(String, u32)> = variables
        .iter()
        .filter(|variable| variable.role == Role::Independent)
        .map(|variable| (variable.name.clone(), variable.reference))
        .collect();
    match found.as_slice() {
        [(name, 0)] if name == "time" => Ok(()),
        _ => Err(DefinitionProblem::Independent { found }),
    }
}
