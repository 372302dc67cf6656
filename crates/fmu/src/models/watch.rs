//! What the user is told of while all is still well: a softening joint that comes near to where it no longer holds, and
//! damping that turns negative with amplitude. Each is told once.

use bolted_joint_dynamics::JointLaw;

use crate::{
    interface::{first_row, reference as vr},
    models::sides::{A, B, name, unit},
    refusal::{Limit, Reached},
};

/// Part of the escape amplitude that the relative motion may reach before the user is told.
const NEAR: f64 = 0.8;

/// Relative displacements that are worth a warning.
#[derive(Clone, Copy, Debug)]
pub(super) struct Watch<const D: usize> {
    escape: [f64; D],
    active: [f64; D],
    escape_told: bool,
    active_told: bool,
}

impl<const D: usize> Default for Watch<D> {
    fn default() -> Self {
        Self {
            escape: [f64::MAX; D],
            active: [f64::MAX; D],
            escape_told: false,
            active_told: false,
        }
    }
}

impl<const D: usize> Watch<D> {
    /// Takes over the limits of new parameters; what was told stays told.
    pub(super) fn set(&mut self, law: &JointLaw<D>, escape: [f64; D]) {
        self.escape = escape;
        // where the joint is active at rest, that is told when its parameters take effect
        self.active = law.active_amplitude().map(|amplitude| {
            amplitude
                .filter(|&amplitude| amplitude > 0.0)
                .unwrap_or(f64::MAX)
        });
    }

    /// Relative displacement of each DOF up to which there is nothing to tell.
    pub(super) fn quiet(&self) -> [f64; D] {
        std::array::from_fn(|dof| {
            let escape = if self.escape_told {
                f64::MAX
            } else {
                NEAR * self.escape[dof]
            };
            let active = if self.active_told {
                f64::MAX
            } else {
                self.active[dof]
            };
            escape.min(active)
        })
    }

    /// What there is to tell of this relative displacement at `time_s` (s).
    #[cold]
    pub(super) fn look(&mut self, relative: &[f64; D], time_s: f64) -> Option<Reached> {
        let reached = |dof: usize, limit: Limit, amplitude: f64| Reached {
            limit,
            a: name(A.displacement[first_row::<D>() + dof]),
            b: name(B.displacement[first_row::<D>() + dof]),
            unit: unit(A.displacement[first_row::<D>() + dof]),
            relative: relative[dof],
            amplitude,
            time_s,
        };
        let past = |limits: &[f64; D]| (0..D).find(|&dof| relative[dof].abs() > limits[dof]);
        if !self.escape_told
            && let Some(dof) = past(&self.escape.map(|amplitude| NEAR * amplitude))
        {
            self.escape_told = true;
            let parameter = name(vr::JOINT_ESCAPE_AMPLITUDE[first_row::<D>() + dof]);
            return Some(reached(dof, Limit::Escape { parameter }, self.escape[dof]));
        }
        if !self.active_told
            && let Some(dof) = past(&self.active)
        {
            self.active_told = true;
            return Some(reached(dof, Limit::ActiveDamping, self.active[dof]));
        }
        None
    }

    /// Forgets what was told.
    pub(super) fn forget(&mut self) {
        self.escape_told = false;
        self.active_told = false;
    }
}

/// Escape amplitudes as the FMU gives them: the largest double where there is none.
pub(super) fn finite<const D: usize>(amplitudes: [Option<f64>; D]) -> [f64; D] {
    amplitudes.map(|amplitude| amplitude.unwrap_or(f64::MAX).min(f64::MAX))
}
