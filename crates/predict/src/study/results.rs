//! The numbers of a joint that draws give intervals of, by name.

use super::model::{Drawn, State};
use super::prediction::Prediction;
use super::slip::{Slip, sum_names};
use crate::patch::DOFS;
use bolted_joint_dynamics::{
    Dof,
    law::{DAMPING, Parameter, STIFFNESS},
};
use bolted_joint_joint::DofSet;

/// Names of the unknowns of a joint's stiffness, and of its damping, with the place of each in its matrix.
pub(super) fn unknowns(dofs: DofSet) -> Vec<(String, bool, [usize; 2])> {
    let name = |symbol, [i, j]: [usize; 2]| {
        let (row, column) = (dofs.row(i).name, dofs.row(j).name);
        format!("{symbol}_{row}{column}")
    };
    let of = |row: &'static Parameter, is_stiffness| {
        let entries = dofs.entries();
        entries.map(move |place| (name(row.symbol, place), is_stiffness, place))
    };
    of(STIFFNESS, true).chain(of(DAMPING, false)).collect()
}

/// Name of a result at a torque of the table.
pub(super) fn at(name: &str, torque_n_m: Option<f64>) -> String {
    match torque_n_m {
        Some(torque) => format!("{name}@{torque}"),
        None => name.to_owned(),
    }
}

/// Names of all results at a torque, in the order of [`values`].
pub(super) fn names(
    dofs: DofSet,
    slipping: &[&'static Dof],
    torque_n_m: Option<f64>,
) -> Vec<String> {
    let part = unknowns(dofs)
        .into_iter()
        .map(|(name, ..)| at(&name, torque_n_m));
    let diagonal = DOFS
        .iter()
        .map(|dof| at(&format!("K_{dof}{dof}"), torque_n_m));
    let loss = ["eta_n", "eta_t"].map(|name| at(name, torque_n_m));
    let slips = slipping.iter().flat_map(|dof| sum_names(dof));
    let slips = slips.map(|name| at(&name, torque_n_m));
    part.chain(diagonal).chain(loss).chain(slips).collect()
}

/// The results themselves.
pub(super) fn values(dofs: DofSet, drawn: &Drawn) -> Vec<f64> {
    let Drawn {
        interface,
        part,
        slips,
    } = drawn;
    let of_part = unknowns(dofs).into_iter().map(|(_, is_stiffness, [i, j])| {
        let matrix = match is_stiffness {
            true => &part.stiffness,
            false => &part.damping,
        };
        matrix[i][j]
    });
    let diagonal = (0..6).map(|i| interface.stiffness[i][i]);
    let loss = [
        interface.normal_loss_factor(),
        interface.tangential_loss_factor(),
    ];
    let slips = slips
        .iter()
        .flat_map(|sums| [sums.slip_force, sums.stiffness]);
    of_part.chain(diagonal).chain(loss).chain(slips).collect()
}

/// A number of the joint file.
#[derive(Debug, Clone, PartialEq)]
pub struct Unknown {
    /// Its name, such as `k_yy`.
    pub name: String,
    /// Its value.
    pub value: f64,
    /// Its unit.
    pub unit: String,
}

impl Prediction<'_> {
    /// The numbers of the joint file at one of the states; in space without those that are zero whatever the inputs are.
    #[must_use]
    pub fn unknowns(&self, state: &State) -> Vec<Unknown> {
        let dofs = self.study.motions.dofs();
        let valued = unknowns(dofs)
            .into_iter()
            .filter(|(name, is_stiffness, place)| {
                !dofs.is_in_space() || !self.is_nothing(name, *is_stiffness, *place)
            })
            .map(|(name, is_stiffness, place)| {
                let (matrix, row) = match is_stiffness {
                    true => (&state.part.stiffness, STIFFNESS),
                    false => (&state.part.damping, DAMPING),
                };
                Unknown {
                    name,
                    value: matrix[place[0]][place[1]],
                    unit: dofs.unit(row.unit, place),
                }
            });
        valued
            .chain(state.slips.iter().flat_map(Slip::unknowns))
            .collect()
    }

    /// Whether an entry of the matrices is zero at every torque and in every draw, by the symmetry of the interface.
    fn is_nothing(&self, name: &str, is_stiffness: bool, [row, column]: [usize; 2]) -> bool {
        self.states.iter().all(|state| {
            let matrix = match is_stiffness {
                true => &state.part.stiffness,
                false => &state.part.damping,
            };
            let scatter = self.estimate(name, state.torque_n_m);
            let scatters = scatter.is_some_and(|estimate| estimate.standard_deviation != 0.0);
            matrix[row][column] == 0.0 && !scatters
        })
    }

    /// Inputs that account for `at_least` this share of the scatter of a result, the largest first.
    #[must_use]
    pub fn main_inputs(
        &self,
        name: &str,
        torque_n_m: Option<f64>,
        at_least: f64,
    ) -> Vec<(&str, f64)> {
        let (Some(outcome), Some(estimate)) = (&self.outcome, self.estimate(name, torque_n_m))
        else {
            return Vec::new();
        };
        let inputs = outcome.inputs.iter().map(String::as_str);
        let pairs = inputs.zip(estimate.shares.iter().copied());
        let mut named: Vec<(&str, f64)> = pairs.filter(|(_, share)| *share >= at_least).collect();
        named.sort_by(|(_, a), (_, b)| b.total_cmp(a));
        named
    }
}
