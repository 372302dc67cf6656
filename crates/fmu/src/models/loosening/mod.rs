//! Joints over the preload: their law follows the input `preload`.

mod element;
mod lap;

pub(super) use element::LooseningElement;
pub(super) use lap::LooseningLap;

use bolted_joint_dynamics::{Dual, JointLaw, JointOverPreload, Motion};

use crate::{
    interface::{Values, memory, reference as vr},
    models::sides::{check_laws, is_active, joint_law},
    preload_table::OverPreload,
    refusal::Refusal,
};

/// Preloads in each gap of the table at which what could go wrong is looked for, beside those of the table.
const CHECKED_BETWEEN: u32 = 3;

/// The joint with the friction that is among the parameters, or why that cannot be.
fn with_friction<const D: usize>(
    start: &OverPreload<D>,
    values: &Values,
) -> Result<JointOverPreload<D>, Refusal> {
    let law = joint_law(values);
    check_laws(&law)?;
    let table = start.with_friction(law.on);
    // a table of friction is what the start-value file says, at its preloads and between them
    for preload_n_m in table.samples_n_m(CHECKED_BETWEEN) {
        if table.covers(preload_n_m) && table.has_memory() {
            check_laws(&table.law(preload_n_m))?;
        }
    }
    Ok(table)
}

/// Refuses a preload (N·m) at which there is no joint; `time_s` (s) where the simulation has come to it by itself.
pub(in crate::models) fn check_preload<const D: usize>(
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
fn preload_power<const D: usize>(
    table: &JointOverPreload<D>,
    values: &Values,
    relative: &Motion<D>,
) -> f64 {
    // ∂U/∂p ṗ
    let preload_n_m = values[vr::PRELOAD];
    let (law, change) = (table.law(preload_n_m), table.spring_change(preload_n_m));
    let memory = values.joint_at(&law, relative);
    values[memory::PRELOAD_RATE] * law.power_of_change(&change, &memory, &relative.displacement)
}

/// First-order change of [`preload_power`] along the direction `change`.
fn preload_power_change<const D: usize>(
    table: &JointOverPreload<D>,
    [values, change]: [&Values; 2],
    [relative, relative_change]: [&Motion<D>; 2],
) -> f64 {
    let preload_n_m = values[vr::PRELOAD];
    let [r, r_change] = [relative, relative_change].map(|motion| &motion.displacement);
    let slope = table.slope(preload_n_m);
    let slope_change = table.curvature(preload_n_m).times(change[vr::PRELOAD]);
    let (law, spring_change) = (table.law(preload_n_m), table.spring_change(preload_n_m));
    let law_change = table.change(preload_n_m).times(change[vr::PRELOAD]);
    let memory = values.joint_at(&law, relative);
    // d(∂U/∂p ṗ) = ∂U/∂p dṗ + ṗ (∂²U/∂p² dp + ∂²U/∂p∂r dr)
    change[memory::PRELOAD_RATE] * law.power_of_change(&spring_change, &memory, r)
        + values[memory::PRELOAD_RATE]
            * (stored_energy_change([&slope, &slope_change], [r, r_change])
                + law.change_of_slider_power(&law_change, &spring_change, &memory, [r, r_change]))
}

/// First-order change of [`JointOverPreload::work_of_preload`] from the counted preload (N·m) to the present one.
fn work_of_preload_change<const D: usize>(
    table: &JointOverPreload<D>,
    [values, change]: [&Values; 2],
    [r, r_change]: [&[f64; D]; 2],
) -> f64 {
    let (counted_n_m, preload_n_m) = (values[memory::COUNTED_PRELOAD], values[vr::PRELOAD]);
    let springs = |at_n_m| table.springs(at_n_m);
    let slope = table.slope(preload_n_m).times(change[vr::PRELOAD]);
    // d(U(r; p) − U(r; p_counted))
    let of_springs = stored_energy_change([&springs(preload_n_m), &slope], [r, r_change])
        - stored_energy_change([&springs(counted_n_m), &JointLaw::NONE], [r, r_change]);
    let spring_change = table.spring_change(preload_n_m);
    if !spring_change.has_memory() {
        return of_springs;
    }
    let (from, to) = (table.law(counted_n_m), table.law(preload_n_m));
    let own = from.with_change(&JointLaw::NONE);
    let to = to.with_change(&spring_change.times(change[vr::PRELOAD]));
    let r = std::array::from_fn(|dof| Dual::new(r[dof], [r_change[dof]]));
    let memory = values.joint();
    let of_sliders = own.energy_in(&to, memory, &r) - own.energy_in(&own, memory, &r);
    of_springs + of_sliders.change[0]
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
