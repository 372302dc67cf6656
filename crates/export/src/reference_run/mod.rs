//! The reference run in an FMU: inputs, and the outputs that they lead to, with which any importer can check itself.
//!
//! The inputs are steps that last several communication steps. An importer that holds inputs and one that interpolates
//! them then integrate the very same problem, and what they get can be compared to more than plotting accuracy.

mod element;
mod files;
mod lap;
mod stimulus;

use bolted_joint_dynamics::{Beyond, JointLaw, JointOverPreload};
use bolted_joint_interface::{Interface as Declared, Role};

use super::archive::File;
use super::fmu::LapFacts;
use super::{ExportError, Interface};
use bolted_joint_joint::{DofSet, JointFile, LawError};

/// A run from rest: what goes in, what comes out.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct ReferenceRun {
    /// Communication step, s.
    step_s: f64,
    /// Number of communication steps.
    steps: usize,
    inputs: Table,
    outputs: Table,
    /// By how much each output of the FMU may differ, as a fraction of its largest magnitude in the run.
    tolerance: f64,
}

/// Values over time.
#[derive(Debug, Clone, PartialEq)]
struct Table {
    /// Names of the variables.
    names: Vec<String>,
    /// Time, s, and the variables' values in SI.
    rows: Vec<(f64, Vec<f64>)>,
}

impl ReferenceRun {
    /// Of the joint in `file`, over the preload of `over_preload` where that is given; `None` if its outputs do not stay finite.
    pub(super) fn new(
        file: &JointFile,
        over_preload: Option<&JointFile>,
        declared: &Declared,
        interface: Interface,
        facts: Option<&LapFacts>,
        step_of_element_s: Option<f64>,
    ) -> Result<Option<Self>, ExportError> {
        let names = Names::of(declared);
        Ok(match (interface, file.joint.dofs, facts) {
            (Interface::Lap, DofSet::Translation, Some(facts)) => lap::run(
                &file.lap::<1>()?,
                &Laws::of(file, over_preload)?,
                facts,
                names,
            ),
            (Interface::Lap, DofSet::TranslationRotation, Some(facts)) => lap::run(
                &file.lap::<2>()?,
                &Laws::of(file, over_preload)?,
                facts,
                names,
            ),
            (Interface::Lap, _, None) => None,
            (Interface::Element, DofSet::Translation, _) => Some(element::run(
                &Laws::<1>::of(file, over_preload)?,
                step_of_element_s,
                names,
            )),
            (Interface::Element, DofSet::TranslationRotation, _) => Some(element::run(
                &Laws::<2>::of(file, over_preload)?,
                step_of_element_s,
                names,
            )),
        })
    }

    /// The files that carry it.
    pub(super) fn files(&self, model_name: &str) -> Vec<File> {
        files::files(self, model_name)
    }

    /// By how much each output may differ, as a fraction of its largest magnitude.
    pub(super) fn tolerance(&self) -> f64 {
        self.tolerance
    }

    fn stop_s(&self) -> f64 {
        self.steps as f64 * self.step_s
    }
}

/// The joint's law at each level of the run.
enum Laws<const D: usize> {
    /// One law for all.
    Constant(JointLaw<D>),
    /// The law at the preload of the level.
    Table {
        nominal: JointLaw<D>,
        table: JointOverPreload<D>,
    },
}

impl<const D: usize> Laws<D> {
    fn of(file: &JointFile, over_preload: Option<&JointFile>) -> Result<Self, LawError> {
        let nominal = file.joint.law()?;
        match over_preload {
            None => Ok(Self::Constant(nominal)),
            Some(file) => Ok(Self::Table {
                nominal,
                table: file.joint.law_over_preload(Beyond::Refused)?,
            }),
        }
    }

    /// The law whose cubic term sets how far the joint is opened.
    fn nominal(&self) -> &JointLaw<D> {
        match self {
            Self::Constant(nominal) | Self::Table { nominal, .. } => nominal,
        }
    }

    /// Preload of a level, N·m; zero where the joint does not depend on it.
    fn preload_n_m(&self, level: usize) -> f64 {
        match self {
            Self::Constant(_) => 0.0,
            Self::Table { table, .. } => {
                let [first, last] = table.range_n_m();
                let (share, _) = stimulus::shape(1, true, (level + 1) as f64);
                stimulus::rounded(0.5 * (first + last) + 0.45 * share * (last - first))
            }
        }
    }

    /// Law of a level.
    fn at(&self, level: usize) -> JointLaw<D> {
        match self {
            Self::Constant(law) => *law,
            Self::Table { table, .. } => table.law(self.preload_n_m(level)),
        }
    }
}

/// Names of inputs and outputs in the order of the model description.
struct Names {
    inputs: Vec<String>,
    outputs: Vec<String>,
}

impl Names {
    fn of(declared: &Declared) -> Self {
        let with = |roles: &[Role]| {
            let variables = declared.variables.iter();
            variables
                .filter(|variable| roles.contains(&variable.role))
                .map(|variable| variable.name.clone())
                .collect()
        };
        Self {
            inputs: with(&[Role::Input]),
            outputs: with(&[Role::State, Role::Output]),
        }
    }
}

/// A table whose rows have one entry for each name.
fn table(names: Vec<String>, rows: impl Iterator<Item = (f64, impl Fn(&str) -> f64)>) -> Table {
    let rows = rows
        .map(|(time_s, value)| (time_s, names.iter().map(|name| value(name)).collect()))
        .collect();
    Table { names, rows }
}

/// The entry that `name` stands for, such as `a.theta`, of quantities by DOF; zero for what is none of them.
fn entry<const D: usize>(
    name: &str,
    side: &str,
    quantities: [(&str, &str, &[f64; D]); 2],
) -> Option<f64> {
    let quantity = name.strip_prefix(side)?.strip_prefix('.')?;
    quantities
        .iter()
        .find_map(|(translational, rotational, values)| {
            let dof = [translational, rotational]
                .iter()
                .position(|candidate| **candidate == quantity)?;
            values.get(dof).copied()
        })
}
