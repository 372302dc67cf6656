//! What one lap at one level answers: its rows, and how far its joint moves.

use bolted_joint_dynamics::LapState;

/// Rows of a table, and the largest relative displacement of each DOF, m and rad.
pub(super) struct Answer<const D: usize> {
    pub(super) rows: Vec<Vec<f64>>,
    pub(super) largest: [f64; D],
}

impl<const D: usize> Answer<D> {
    /// Rows of a response that scales with its load.
    pub(super) fn linear(rows: Vec<Vec<f64>>) -> Self {
        Self {
            rows,
            largest: [0.0; D],
        }
    }
}

/// The larger of what was largest and the relative displacements now.
pub(super) fn larger<const D: usize>(largest: &mut [f64; D], state: &LapState<D>) {
    for (largest, r) in largest.iter_mut().zip(state.relative().displacement) {
        *largest = largest.max(r.abs());
    }
}
