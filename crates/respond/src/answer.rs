//! What one lap at one level answers: its rows, and how far its joint moves.

use bolted_joint_dynamics::{JointLaw, LapState};

use super::hysteresis::HysteresisLoop;

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

    /// Rows of displacement, load on side b and heat of a closed loop.
    pub(super) fn of_loop(motion: HysteresisLoop, law: &JointLaw<D>) -> Self {
        let points = motion.points(law).into_iter();
        let rows = points.map(|of| vec![of.displacement, of.load, of.heat_j]);
        let mut largest = [0.0; D];
        largest[motion.dof] = motion.amplitude;
        Self {
            rows: rows.collect(),
            largest,
        }
    }
}

/// The larger of what was largest and the relative displacements now.
pub(super) fn larger<const D: usize>(largest: &mut [f64; D], state: &LapState<D>) {
    for (largest, r) in largest.iter_mut().zip(state.relative().displacement) {
        *largest = largest.max(r.abs());
    }
}
