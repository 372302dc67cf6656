//! What is calculated of an assembly, for any kind of number.

use bolted_joint_dynamics::{
    DofMemory, Number,
    assembly::{AssemblyMotion, Matrix},
};

use super::AssemblyLayout;
use crate::assembly_file::AssemblyFile;

/// Writes what is calculated of an assembly among what the start-value file lists.
#[derive(Clone, Copy)]
pub(super) struct Calculated<'a> {
    pub(super) file: &'a AssemblyFile,
    pub(super) layout: &'a AssemblyLayout,
}

impl Calculated<'_> {
    /// Motions, loads in the joints, and what these remember.
    pub(super) fn write<N: Number, M: Number + Into<N>>(
        &self,
        listed: &mut [N],
        memory: &[DofMemory<M>],
    ) {
        let layout = self.layout;
        let (states, calculated) = listed.split_at_mut(layout.motions.start);
        let motion = self.motion(states);
        let (motions, rest) = calculated.split_at_mut(layout.motions.len());
        let (joint_loads, rest) = rest.split_at_mut(layout.joint_loads.len());
        for (own, row) in motions.chunks_exact_mut(2).zip(rows(&self.file.motions)) {
            own[0] = product(row, motion.coordinates);
            own[1] = product(row, motion.rates);
        }
        self.file.assembly.joint_loads(motion, memory, joint_loads);
        for (own, shown) in rest.iter_mut().zip(&layout.remembered) {
            *own = memory[shown.dof][shown.place].into();
        }
    }

    /// Energies, powers and accelerations, which follow from these.
    pub(super) fn write_apart<N: Number, M: Number + Into<N>>(
        &self,
        listed: &mut [N],
        memory: &[DofMemory<M>],
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
        let accelerations = &mut rest[..layout.accelerations.len()];
        assembly.accelerations(motion, loads, joint_loads, accelerations);
    }

    fn motion<'n, N>(&self, states: &'n [N]) -> AssemblyMotion<'n, N> {
        AssemblyMotion {
            coordinates: &states[self.layout.coordinates.clone()],
            rates: &states[self.layout.rates.clone()],
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
