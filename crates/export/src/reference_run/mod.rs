//! The reference run in an FMU: inputs, and the outputs that they lead to, with which any importer can check itself.
//!
//! The inputs are steps that last several communication steps. An importer that holds inputs and one that interpolates
//! them then integrate the very same problem, and what they get can be compared to more than plotting accuracy.

mod element;
mod files;
mod lap;
mod step_of_error;
pub(super) mod stimulus;

use bolted_joint_dynamics::{
    Beyond, Dof, JointLaw, JointMemory, JointOverPreload, Motion,
    law::remembered as remembered_by_laws, with_dofs,
};
use bolted_joint_interface::{Interface as Declared, Role};

pub(super) use step_of_error::step_of_error;

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

/// Times, s, each with values.
pub(super) type Rows = Vec<(f64, Vec<f64>)>;

/// Values over time.
#[derive(Debug, Clone, PartialEq)]
struct Table {
    /// Names of the variables.
    names: Vec<String>,
    /// Time, s, and the variables' values in SI.
    rows: Rows,
}

/// Part of the largest energy of a run below which another one is what rounding leaves of none.
const ROUNDING_OF_ENERGY: f64 = 1e-13;

impl Table {
    /// Which energies are rounding: a run is no reference for these.
    fn of_rounding(&self) -> Vec<usize> {
        let largest = |column: usize| {
            let values = self.rows.iter().map(|(_, row)| row[column].abs());
            values.fold(0.0, f64::max)
        };
        let names = self.names.iter().enumerate();
        let energies = names.filter(|(_, name)| name.starts_with("energy."));
        let energies: Vec<(usize, f64)> = energies.map(|(i, _)| (i, largest(i))).collect();
        let most = energies
            .iter()
            .fold(0.0, |most: f64, (_, own)| most.max(*own));
        let is_rounding = |own: f64| own > 0.0 && own < ROUNDING_OF_ENERGY * most;
        let noise = energies.into_iter().filter(|(_, own)| is_rounding(*own));
        noise.map(|(column, _)| column).collect()
    }

    fn leave_out(&mut self, columns: &[usize]) {
        // from the last one, so that the others keep their places
        for &column in columns.iter().rev() {
            self.names.remove(column);
            for (_, row) in &mut self.rows {
                row.remove(column);
            }
        }
    }
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
        let names = Names::of(declared, file.joint.dofs);
        with_dofs!(file.joint.dofs.size(), D => {
            let laws = Laws::<D>::of(file, over_preload)?;
            match (interface, facts) {
                (Interface::Lap, Some(facts)) => {
                    lap::run(&file.lap::<D>()?, &laws, facts, names)
                }
                (Interface::Lap, None) => Ok(None),
                (Interface::Element, _) => {
                    element::run(&laws, step_of_element_s, names).map(Some)
                }
            }
        })
    }

    /// A run of this many steps with inputs that are held, and outputs at communication points, both as rows with the time.
    pub(super) fn of_rows(
        step_s: f64,
        steps: usize,
        inputs: (Vec<String>, Rows),
        outputs: (Vec<String>, Rows),
        tolerance: f64,
    ) -> Self {
        let table = |(names, rows)| Table { names, rows };
        Self {
            step_s,
            steps,
            inputs: table(inputs),
            outputs: table(outputs),
            tolerance,
        }
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
    /// The joint's DOFs.
    dofs: DofSet,
}

impl Names {
    fn of(declared: &Declared, dofs: DofSet) -> Self {
        let with = |roles: &[Role]| {
            let variables = declared.variables.iter();
            variables
                .filter(|variable| roles.contains(&variable.role))
                .map(|variable| variable.name.clone())
                .collect()
        };
        Self {
            inputs: with(&[Role::Input]),
            outputs: with(&[Role::State, Role::InnerState, Role::Output]),
            dofs,
        }
    }
}

/// A table whose rows have one entry for each name.
///
/// # Errors
///
/// [`ExportError::NotComputed`] for the first name that has no value.
fn table(
    names: Vec<String>,
    rows: impl Iterator<Item = (f64, impl Fn(&str) -> Option<f64>)>,
) -> Result<Table, ExportError> {
    let rows = rows
        .map(|(time_s, value)| {
            let entry = |name: &String| {
                value(name).ok_or_else(|| ExportError::NotComputed {
                    variable: name.clone(),
                })
            };
            Ok((time_s, names.iter().map(entry).collect::<Result<_, _>>()?))
        })
        .collect::<Result<_, ExportError>>()?;
    Ok(Table { names, rows })
}

/// Name of a quantity of a DOF.
type NameOf = fn(&Dof) -> &'static str;

const DISPLACEMENT: NameOf = |dof| dof.name;
const RATE: NameOf = |dof| dof.rate;
const LOAD: NameOf = |dof| dof.load;

/// What the joint remembers under `name`, or `None` if it is nothing of that.
fn remembered<const D: usize>(name: &str, dofs: DofSet, memory: &JointMemory<D>) -> Option<f64> {
    dofs.rows().zip(memory).find_map(|(dof, own)| {
        let (place, _, _) = remembered_by_laws()
            .find(|(_, law, number)| name == law.variable(number.symbol, dof.name))?;
        own.get(place).copied()
    })
}

/// The entry of a side's motion that `name` stands for, or `None` if it is none of them.
fn of_motions<const D: usize>(name: &str, dofs: DofSet, sides: [&Motion<D>; 2]) -> Option<f64> {
    ["a", "b"]
        .into_iter()
        .zip(sides)
        .find_map(|(side, motion)| {
            let quantities: [(_, &[f64]); 2] = [
                (DISPLACEMENT, &motion.displacement),
                (RATE, &motion.velocity),
            ];
            entry(name, side, dofs, &quantities)
        })
}

/// The entry that `name` stands for, such as `a.theta`, of quantities by DOF, or `None` if it is none of them.
fn entry(name: &str, side: &str, dofs: DofSet, quantities: &[(NameOf, &[f64])]) -> Option<f64> {
    let quantity = name.strip_prefix(side)?.strip_prefix('.')?;
    quantities.iter().find_map(|(name_of, values)| {
        let place = dofs.rows().position(|dof| name_of(dof) == quantity)?;
        values.get(place).copied()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn energies_that_are_rounding_are_left_out_and_nothing_else() {
        let names = [
            "a.y",
            "energy.stored",
            "energy.preload",
            "energy.dissipated",
        ];
        let mut table = Table {
            names: names.map(str::to_owned).to_vec(),
            rows: vec![(0.0, vec![0.0; 4]), (1.0, vec![1e-20, 2e-3, 2e-24, 0.0])],
        };
        let noise = table.of_rounding();
        assert_eq!(noise, [2]);
        table.leave_out(&noise);
        // a small motion is one, and an energy of zero is exact
        assert_eq!(table.names, ["a.y", "energy.stored", "energy.dissipated"]);
        assert_eq!(table.rows[1].1, [1e-20, 2e-3, 0.0]);
    }
}
