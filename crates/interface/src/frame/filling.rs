//! What frames are filled with: the table of DOFs and the declarations of the laws.

use bolted_joint_dynamics::{
    DOF_SETS, DOFS, Dof,
    law::{DECLARATIONS, Declaration},
};

/// What frames are filled with.
#[derive(Clone, Copy, Debug)]
pub struct Filling<'a> {
    /// Table of DOFs.
    pub dofs: &'a [Dof],
    /// Sets of DOFs that a joint can have, by rows of the table.
    pub dof_sets: &'a [&'a [usize]],
    /// What the laws say of themselves.
    pub laws: &'a [Declaration],
}

impl Filling<'static> {
    /// The project's own DOFs and laws.
    pub const PRESENT: Self = Self {
        dofs: &DOFS,
        dof_sets: DOF_SETS,
        laws: DECLARATIONS,
    };
}

impl Filling<'_> {
    /// Whether a joint can have both DOFs.
    pub(super) fn are_together(&self, one: usize, other: usize) -> bool {
        let mut sets = self.dof_sets.iter();
        sets.any(|set| set.contains(&one) && set.contains(&other))
    }
}
