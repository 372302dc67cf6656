//! Joints over the preload: their law follows the input `preload`.

mod element;
mod lap;

pub(super) use element::LooseningElement;
pub(super) use lap::LooseningLap;

use bolted_joint_dynamics::{Dual, JointLaw, JointOverPreload};

use crate::{
    interface::{Values, memory, reference as vr},
    models::sides::{check_laws, is_active, joint_law},
    preload_table::OverPreload,
    refusal::Refusal,
};

/// Preloads in each gap of the table at which what could go wrong is looked for, beside those of the table.
const CHECKED_BETWEEN: u32 = 3;

/// How far beyond its table, as a part of its range, a course of the preload may come by rounding.
const ROUNDING: f64 = 1e-9;

/// The joint with the friction that is among the parameters, or why that cannot be.
fn with_friction<const D: usize>(
    start: &OverPreload<D>,
    values: &Values,
) -> Result<JointOverPreload<D>, Refusal> {
    let law = joint_law(values);
    check_laws(&law)?;
    Ok(start.with_friction(law.on))
}

/// Refuses a preload (N·m) at which there is no joint; `time_s` (s) where the simulation has come to it by itself.
pub(in crate::models) fn check_preload<const D: usize>(
    table: &JointOverPreload<D>,
    found_n_m: f64,
    time_s: Option<f64>,
) -> Result<(), Refusal> {
    let [first_n_m, last_n_m] = table.range_n_m();
    // a course that ends where the table does may pass it by rounding
    let rounding_n_m = time_s.map_or(0.0, |_| ROUNDING * (last_n_m - first_n_m));
    let is_rounding = (first_n_m - rounding_n_m..=last_n_m + rounding_n_m).contains(&found_n_m);
    if table.covers(found_n_m) || is_rounding {
        return Ok(());
    }
    Err(Refusal::Preload {
        found_n_m,
        first_n_m,
        last_n_m,
        time_s,
    })
}

/// Power (W) that the springs take up at the relative displacement r because their law changes at the present rate.
fn preload_power<const D: usize>(
    table: &JointOverPreload<D>,
    values: &Values,
    r: &[f64; D],
) -> f64 {
    // ∂U/∂p ṗ
    values[memory::PRELOAD_RATE] * table.slope(values[vr::PRELOAD]).stored_energy(r)
}

/// First-order change of [`preload_power`] along the direction `change`.
fn preload_power_change<const D: usize>(
    table: &JointOverPreload<D>,
    [values, change]: [&Values; 2],
    [r, r_change]: [&[f64; D]; 2],
) -> f64 {
    let preload_n_m = values[vr::PRELOAD];
    let slope = table.slope(preload_n_m);
    let slope_change = table.curvature(preload_n_m).times(change[vr::PRELOAD]);
    // d(∂U/∂p ṗ) = ∂U/∂p dṗ + ṗ (∂²U/∂p² dp + ∂²U/∂p∂r dr)
    change[memory::PRELOAD_RATE] * slope.stored_energy(r)
        + values[memory::PRELOAD_RATE]
            * stored_energy_change([&slope, &slope_change], [r, r_change])
}

/// First-order change of the energy that a law stores at the relative displacement r, with law and displacement.
fn stored_energy_change<const D: usize>(
    [law, law_change]: [&JointLaw<D>; 2],
    [r, r_change]: [&[f64; D]; 2],
) -> f64 {
    let r = std::array::from_fn(|dof| Dual::new(r[dof], [r_change[dof]]));
    law.with_change(law_change).stored_energy(&r).change[0]
}

/// Whether stiffness and damping of any of these laws can feed energy.
fn are_active<const D: usize>(laws: impl Iterator<Item = JointLaw<D>>) -> [bool; 2] {
    laws.fold([false; 2], |[stiffness, damping], law| {
        let own = is_active(&law);
        [stiffness || own[0], damping || own[1]]
    })
}

/// The smaller of two amplitudes in each DOF.
fn smaller<const D: usize>(one: [f64; D], other: [f64; D]) -> [f64; D] {
    std::array::from_fn(|dof| one[dof].min(other[dof]))
}
