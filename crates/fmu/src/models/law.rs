//! Where the joint's law comes from: from parameters, or from a table at the present preload.

use bolted_joint_dynamics::{JointLaw, JointOverPreload};

use super::sides::joint_law;
use crate::{
    interface::{Values, memory, reference as vr},
    refusal::Refusal,
};

/// Source of a joint's law.
#[derive(Clone, Debug)]
pub(super) enum LawSource<const D: usize> {
    /// The parameters of stiffness and damping.
    Parameters,
    /// A table over the input `preload`.
    Table(JointOverPreload<D>),
}

impl<const D: usize> LawSource<D> {
    /// The law at present.
    #[inline]
    pub(super) fn law(&self, values: &Values) -> JointLaw<D> {
        match self {
            Self::Parameters => joint_law(values),
            Self::Table(table) => table.law(values[vr::PRELOAD]),
        }
    }

    /// Its first-order change at the point `values` along the direction `change`.
    pub(super) fn law_change(&self, values: &Values, change: &Values) -> JointLaw<D> {
        match self {
            Self::Parameters => joint_law(change),
            Self::Table(table) => table.slope(values[vr::PRELOAD]).times(change[vr::PRELOAD]),
        }
    }

    /// Refuses what this input cannot be.
    pub(super) fn check_input(&self, input: usize, value: f64) -> Result<(), Refusal> {
        match self {
            Self::Table(table) if input == vr::PRELOAD => check_preload(table, value, None),
            _ => Ok(()),
        }
    }
}

/// Refuses a preload (N·m) at which there is no joint; `time_s` (s) where the simulation has come to it by itself.
pub(super) fn check_preload<const D: usize>(
    table: &JointOverPreload<D>,
    found_n_m: f64,
    time_s: Option<f64>,
) -> Result<(), Refusal> {
    if table.covers(found_n_m) {
        return Ok(());
    }
    let [first_n_m, last_n_m] = table.range_n_m();
    Err(Refusal::Preload {
        found_n_m,
        first_n_m,
        last_n_m,
        time_s,
    })
}

/// Power (W) that the springs take up at the relative displacement r because their law changes at the present rate.
pub(super) fn preload_power<const D: usize>(
    table: &JointOverPreload<D>,
    values: &Values,
    r: &[f64; D],
) -> f64 {
    // ∂U/∂p ṗ
    values[memory::PRELOAD_RATE] * table.slope(values[vr::PRELOAD]).stored_energy(r)
}

/// First-order change of [`preload_power`] along the direction `change`.
pub(super) fn preload_power_change<const D: usize>(
    table: &JointOverPreload<D>,
    [values, change]: [&Values; 2],
    [r, r_change]: [&[f64; D]; 2],
) -> f64 {
    let preload_n_m = values[vr::PRELOAD];
    let slope = table.slope(preload_n_m);
    let slope_change = table.curvature(preload_n_m).times(change[vr::PRELOAD]);
    // d(∂U/∂p ṗ) = ∂U/∂p dṗ + ṗ (∂²U/∂p² dp + ∂²U/∂p∂r dr)
    change[memory::PRELOAD_RATE] * slope.stored_energy(r)
        + values[memory::PRELOAD_RATE] * slope.stored_energy_tangent(&slope_change, r, r_change)
}
