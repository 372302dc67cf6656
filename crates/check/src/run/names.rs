//! Names and value references of the variables that a run touches.

use bolted_joint_dynamics::Dof;
use bolted_joint_joint::DofSet;

use crate::described::Described;

/// Value references, in the order: DOFs of side a, then of side b.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct References {
    pub(super) displacements: Vec<u32>,
    pub(super) velocities: Vec<u32>,
    /// Loads on the sides: inputs of a lap, outputs of an element.
    pub(super) loads: Vec<u32>,
    /// Load in the joint, on b.
    pub(super) joint: Vec<u32>,
    pub(super) energy: u32,
    pub(super) power: u32,
}

impl References {
    /// `None` where a variable is missing, which the inspection tells of.
    pub(super) fn of(described: &Described, dofs: DofSet) -> Option<Self> {
        let one = |name: &str| Some(described.variable(name)?.reference);
        let each = |prefixes: &[&str], name: fn(&Dof) -> &str| -> Option<Vec<u32>> {
            prefixes
                .iter()
                .flat_map(|prefix| dofs.rows().map(move |dof| (prefix, name(dof))))
                .map(|(prefix, name)| one(&format!("{prefix}.{name}")))
                .collect()
        };
        Some(Self {
            displacements: each(&["a", "b"], |dof| dof.name)?,
            velocities: each(&["a", "b"], |dof| dof.rate)?,
            loads: each(&["a", "b"], |dof| dof.load)?,
            joint: each(&["joint"], |dof| dof.load)?,
            energy: one("energy.stored")?,
            power: one("power.dissipated")?,
        })
    }

    /// Everything that is read after each step.
    pub(super) fn observed(&self) -> Vec<u32> {
        let mut all = self.displacements.clone();
        all.extend(&self.velocities);
        all.extend(&self.loads);
        all.extend(&self.joint);
        all.extend([self.energy, self.power]);
        all
    }

    /// Takes apart what was read.
    pub(super) fn sample<'v>(&self, values: &'v [f64]) -> Option<Sample<'v>> {
        let (displacements, rest) = values.split_at_checked(self.displacements.len())?;
        let (velocities, rest) = rest.split_at_checked(self.velocities.len())?;
        let (loads, rest) = rest.split_at_checked(self.loads.len())?;
        let (joint, rest) = rest.split_at_checked(self.joint.len())?;
        let &[energy_j, power_w] = rest else {
            return None;
        };
        Some(Sample {
            displacements,
            velocities,
            loads,
            joint,
            energy_j,
            power_w,
        })
    }
}

/// Values at one instant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Sample<'v> {
    pub(super) displacements: &'v [f64],
    pub(super) velocities: &'v [f64],
    pub(super) loads: &'v [f64],
    pub(super) joint: &'v [f64],
    pub(super) energy_j: f64,
    pub(super) power_w: f64,
}
