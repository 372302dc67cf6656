//! Where the quantities of an assembly stand among the variables that the start-value file lists.

use std::ops::Range;

use bolted_joint_dynamics::{
    DofLaws,
    law::{INNER_PLACES, remembered},
};

use crate::{assembly_file::AssemblyFile, interface::Role};

/// A number that the laws on a DOF remember and that is a variable.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Shown {
    /// The DOF, among those that have laws.
    pub(super) dof: usize,
    /// Its place in what is remembered there.
    pub(super) place: usize,
}

/// Places of the quantities among what is listed, which has them in this order.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct AssemblyLayout {
    pub(super) loads: Range<usize>,
    /// Preloads of the joints over the preload.
    pub(crate) preloads: Range<usize>,
    pub(super) coordinates: Range<usize>,
    pub(super) rates: Range<usize>,
    /// Work of the loads, and heat.
    pub(super) energies: Range<usize>,
    /// Inner states of laws.
    pub(super) inner: Range<usize>,
    /// Displacement and rate of each motion, one after the other.
    pub(super) motions: Range<usize>,
    pub(super) joint_loads: Range<usize>,
    /// What laws remember beside inner states.
    pub(super) memory: Range<usize>,
    /// Energy that is stored.
    pub(super) stored: usize,
    /// Powers of loads and of heat.
    pub(super) powers: Range<usize>,
    /// Energy that springs have taken up because the preload changed; of an assembly with joints over the preload.
    pub(super) preload_energy: Range<usize>,
    pub(super) accelerations: Range<usize>,
    /// Rates of the inner states.
    pub(super) inner_rates: Range<usize>,
    /// Event indicators of the DOFs that turn: of turns, then of corners ahead.
    pub(super) turning: Range<usize>,
    pub(super) ahead: Range<usize>,
    /// Where each of the inner states and of the other remembered numbers comes from.
    pub(super) inner_states: Vec<Shown>,
    pub(super) remembered: Vec<Shown>,
    /// The DOFs that turn, among those that have laws.
    pub(super) that_turn: Vec<usize>,
}

impl AssemblyLayout {
    pub(crate) fn of(file: &AssemblyFile) -> Self {
        let assembly = &file.assembly;
        let laws = || assembly.laws().enumerate();
        let preloads = assembly.over_preload().count();
        let shown: Vec<Shown> = laws()
            .flat_map(|(dof, laws)| shown_of(laws).map(move |place| Shown { dof, place }))
            .collect();
        let is_inner = |shown: &Shown| INNER_PLACES.contains(&shown.place);
        let (inner_states, remembered): (Vec<_>, Vec<_>) = shown.into_iter().partition(is_inner);
        let that_turn: Vec<usize> = laws()
            .filter(|(_, laws)| laws.present().any(|law| law.commits()))
            .map(|(dof, _)| dof)
            .collect();
        let mut end = 0;
        let mut next = |count: usize| {
            let start = end;
            end += count;
            start..end
        };
        let (size, dofs) = (
            assembly.size(),
            assembly.joints.iter().map(|joint| joint.laws.len()).sum(),
        );
        Self {
            loads: next(assembly.loads.columns()),
            preloads: next(preloads),
            coordinates: next(size),
            rates: next(size),
            energies: next(2),
            inner: next(inner_states.len()),
            motions: next(2 * file.motions.rows()),
            joint_loads: next(dofs),
            memory: next(remembered.len()),
            stored: next(1).start,
            powers: next(2),
            preload_energy: next(usize::from(preloads > 0)),
            accelerations: next(size),
            inner_rates: next(inner_states.len()),
            turning: next(that_turn.len()),
            ahead: next(that_turn.len()),
            inner_states,
            remembered,
            that_turn,
        }
    }

    /// Whether a list of variables of these roles, of which those from `apart` on are calculated apart, is one of this layout.
    pub(crate) fn agrees(&self, roles: &[Role], apart: usize) -> bool {
        let parts = [
            (&self.loads, Role::Input),
            (&self.preloads, Role::LimitedInput),
            (&self.coordinates, Role::State),
            (&self.rates, Role::State),
            (&self.energies, Role::State),
            (&self.inner, Role::InnerState),
            (&self.motions, Role::Output),
            (&self.joint_loads, Role::Output),
            (&self.memory, Role::Output),
            (&(self.stored..self.preload_energy.end), Role::Output),
            (&self.accelerations, Role::Derivative),
            (&self.inner_rates, Role::Derivative),
            (&self.turning, Role::Indicator),
            (&self.ahead, Role::Indicator),
        ];
        let are = |(places, role): &(&Range<usize>, Role)| {
            let own = roles.get(Range::clone(places));
            own.is_some_and(|own| own.iter().all(|own| own == role))
        };
        roles.len() == self.ahead.end && apart == self.stored && parts.iter().all(are)
    }
}

/// Places of what the laws on a DOF remember and that are variables.
fn shown_of(laws: &DofLaws) -> impl Iterator<Item = usize> {
    let present: Vec<String> = laws.present().map(|law| law.numbered_name()).collect();
    let all = remembered();
    all.filter(move |(_, law, _)| present.contains(&law.numbered_name()))
        .map(|(place, _, _)| place)
}
