//! What is calculated of an assembly, for any kind of number.

use bolted_joint_dynamics::{
    DOF_AT_REST, DofMemory, JointLaw, Number, SPACE_COUNT,
    assembly::{AssemblyMotion, Matrix},
    law::INNER_PLACES,
};

use super::AssemblyLayout;
use crate::assembly_file::AssemblyFile;

/// What laws remember follows from there.
#[derive(Clone, Copy, Debug)]
pub(super) enum From {
    /// The simulation begins, and they have come straight to where it does.
    Start,
    /// Their inner states are among the variables.
    Variables,
}

/// Writes what is calculated of an assembly among what the start-value file lists.
#[derive(Clone, Copy)]
pub(super) struct Calculated<'a, N = f64> {
    pub(super) file: &'a AssemblyFile,
    pub(super) layout: &'a AssemblyLayout,
    /// The laws of the joints over the preload at present.
    pub(super) laws: &'a [JointLaw<SPACE_COUNT, N>],
}

impl<N: Number> Calculated<'_, N> {
    /// Motions, loads in the joints, and what these remember.
    pub(super) fn write<M: Number + Into<N>>(&self, listed: &mut [N], memory: &[DofMemory<M>]) {
        let layout = self.layout;
        let (states, calculated) = listed.split_at_mut(layout.motions.start);
        let motion = self.motion(states);
        let (motions, rest) = calculated.split_at_mut(layout.motions.len());
        let joint_loads = &mut rest[..layout.joint_loads.len()];
        for (own, row) in motions.chunks_exact_mut(2).zip(rows(&self.file.motions)) {
            own[0] = product(row, motion.coordinates);
            own[1] = product(row, motion.rates);
        }
        self.file.assembly.joint_loads(motion, memory, joint_loads);
        self.write_remembered(listed, memory);
    }

    /// What the joints remember.
    pub(super) fn write_remembered<M: Number + Into<N>>(
        &self,
        listed: &mut [N],
        memory: &[DofMemory<M>],
    ) {
        let shown = &mut listed[self.layout.memory.clone()];
        for (own, shown) in shown.iter_mut().zip(&self.layout.remembered) {
            *own = memory[shown.dof][shown.place].into();
        }
    }

    /// Energies, powers and accelerations, which follow from these.
    pub(super) fn write_apart<M: Number + Into<N>>(
        &self,
        listed: &mut [N],
        memory: &[DofMemory<M>],
        first_energy: N,
    ) {
        let layout = self.layout;
        let (before, apart) = listed.split_at_mut(layout.stored);
        let motion = self.motion(before);
        let loads = &before[layout.loads.clone()];
        let joint_loads = &before[layout.joint_loads.clone()];
        let assembly = &self.file.assembly;
        let [energy, supplied, dissipated, rest @ ..] = apart else {
            return;
        };
        *energy = assembly.stored_energy(motion, memory);
        *supplied = assembly.supplied_power(motion.rates, loads);
        *dissipated = assembly.dissipated_power(motion, memory);
        let (preload, rest) = rest.split_at_mut(layout.preload_energy.len());
        if let [preload] = preload {
            // E − E₀ − supplied + dissipated
            let [supplied, dissipated] = [0, 1].map(|which| before[layout.energies.start + which]);
            *preload = *energy - first_energy - supplied + dissipated;
        }
        let (accelerations, rest) = rest.split_at_mut(layout.accelerations.len());
        assembly.accelerations(motion, loads, joint_loads, accelerations);
        let (inner_rates, _) = rest.split_at_mut(layout.inner_rates.len());
        let mut shown = inner_rates.iter_mut().zip(&layout.inner_states).peekable();
        let mut dof = 0;
        assembly.each_law(motion, |laws, _, rate| {
            if laws.have_inner() {
                let rates = laws.inner_rates(&memory[dof].map(Into::into), rate);
                while let Some((own, shown)) = shown.next_if(|(_, shown)| shown.dof == dof) {
                    let place = INNER_PLACES.iter().position(|&place| place == shown.place);
                    *own = place.map_or(N::ZERO, |place| rates[place]);
                }
            }
            dof += 1;
        });
    }

    /// Writes the inner states where they follow from the start values.
    pub(super) fn write_inner(&self, listed: &mut [N], memory: &[DofMemory<N>]) {
        let inner = &mut listed[self.layout.inner.clone()];
        for (own, shown) in inner.iter_mut().zip(&self.layout.inner_states) {
            *own = memory[shown.dof][shown.place];
        }
    }

    /// What laws remember where the importer integrates their inner states, or where they begin with the simulation; from
    /// `committed`.
    pub(super) fn memory(
        &self,
        listed: &[N],
        committed: &[DofMemory],
        from: From,
    ) -> Vec<DofMemory<N>> {
        let layout = self.layout;
        let mut memory: Vec<DofMemory<N>> = match from {
            From::Start => vec![DOF_AT_REST.map(N::from); committed.len()],
            From::Variables => committed.iter().map(|own| own.map(N::from)).collect(),
        };
        if let From::Variables = from {
            for (&state, shown) in listed[layout.inner.clone()]
                .iter()
                .zip(&layout.inner_states)
            {
                memory[shown.dof][shown.place] = state;
            }
        }
        let mut all = memory.iter_mut();
        self.file
            .assembly
            .each_law(self.motion(listed), |laws, r, rate| {
                let Some(own) = all.next() else { return };
                match from {
                    From::Variables => laws.settle(own, r, rate),
                    From::Start => {
                        laws.commit(own, r, rate);
                        if !own.iter().all(|number| number.is_finite()) {
                            *own = DOF_AT_REST.map(N::from);
                        }
                    }
                }
            });
        memory
    }

    pub(super) fn motion<'n>(&'n self, states: &'n [N]) -> AssemblyMotion<'n, N> {
        AssemblyMotion {
            coordinates: &states[self.layout.coordinates.clone()],
            rates: &states[self.layout.rates.clone()],
            laws: self.laws,
        }
    }
}

fn rows(matrix: &Matrix) -> impl Iterator<Item = &[f64]> {
    (0..matrix.rows()).map(|row| matrix.row(row))
}

fn product<N: Number>(row: &[f64], numbers: &[N]) -> N {
    let pairs = row.iter().zip(numbers);
    pairs.fold(N::ZERO, |sum, (&own, &number)| sum + N::from(own) * number)
}
