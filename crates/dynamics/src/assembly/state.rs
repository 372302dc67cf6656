//! Where an assembly is: its motion, what its joints remember, and the energies that have passed.

use super::system::Assembly;
use crate::law::{DOF_AT_REST, DofMemory};

/// Motion of an assembly, what its joints remember, and the energies that have passed.
#[derive(Clone, Debug, PartialEq)]
pub struct AssemblyState {
    /// Coordinates q, and then their rates, 2n of them.
    pub motion: Vec<f64>,
    /// What the laws remember on each DOF that has any, joint by joint.
    pub memory: Vec<DofMemory>,
    /// Work of the loads, J.
    pub supplied_j: f64,
    /// Heat of structures and joints, J.
    pub dissipated_j: f64,
}

impl AssemblyState {
    /// That of an assembly that has not moved yet.
    #[must_use]
    pub fn at_rest(assembly: &Assembly) -> Self {
        Self::of_size(assembly.size(), assembly.laws().count())
    }

    pub(super) fn of_size(size: usize, laws: usize) -> Self {
        Self {
            motion: vec![0.0; 2 * size],
            memory: vec![DOF_AT_REST; laws],
            supplied_j: 0.0,
            dissipated_j: 0.0,
        }
    }
}

/// An assembly between steps, in the coordinates in which these go on ([`super::AssemblyCoordinates`]).
#[derive(Clone, Debug, PartialEq)]
pub struct Underway {
    /// The coordinates z, 2n of them.
    pub motion: Vec<f64>,
    /// What the laws remember on each DOF that has any, joint by joint.
    pub memory: Vec<DofMemory>,
    /// Work of the loads, J.
    pub supplied_j: f64,
    /// Heat of structures and joints, and beside it the energy of the linear part, J. The latter takes a sum over all
    /// coordinates, and is told where somebody asks.
    pub balance_j: f64,
}

impl Underway {
    /// An assembly that has not moved yet.
    #[must_use]
    pub fn at_rest(assembly: &Assembly) -> Self {
        Self::of_size(assembly.size(), assembly.laws().count())
    }

    pub(super) fn of_size(size: usize, laws: usize) -> Self {
        Self {
            motion: vec![0.0; 2 * size],
            memory: vec![DOF_AT_REST; laws],
            supplied_j: 0.0,
            balance_j: 0.0,
        }
    }
}
