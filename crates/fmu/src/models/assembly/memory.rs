//! What the joints of an assembly remember, between the steps of whoever integrates, and the events that Model Exchange has.

use bolted_joint_dynamics::{DofLaws, DofMemory, Dual};

use super::calculated::{Calculated, From};
use crate::{
    interface::{Name, Values, memory},
    models::events,
    refusal::Refusal,
};

/// Steps after which a preload that has not moved is taken to stay.
const STEPS_TO_STAY: f64 = 16.0;

/// Lets the joints remember the straight way to where the simulation starts; the heat of that way was before.
pub(super) fn begin(calculated: Calculated<'_>, values: &mut Values) {
    if values.memories().is_empty() {
        return;
    }
    let memory = calculated.memory(values.listed(), values.memories(), From::Start);
    calculated.write_inner(values.listed_mut(), &memory);
    values.memories_mut().copy_from_slice(&memory);
    stay(calculated, values, &Stayed::Beginning);
    if !calculated.layout.preload_energy.is_empty() {
        let listed = values.listed();
        let assembly = &calculated.file.assembly;
        let stored = assembly.stored_energy(calculated.motion(listed), values.memories());
        let [supplied, dissipated] =
            [0, 1].map(|which| listed[calculated.layout.energies.start + which]);
        values[memory::FIRST_ENERGY] = stored - supplied + dissipated;
    }
    each_that_turns(calculated, values, |ahead, law, [r, rate]| {
        events::begin_on(ahead, law, r, rate);
    });
}

/// What a step did to the preloads.
pub(super) enum Stayed {
    /// There was none yet.
    Beginning,
    /// It ended with these, N·m.
    Ended(Vec<f64>),
}

/// Remembers for how many steps the preloads have stayed what they are.
pub(super) fn stay(calculated: Calculated<'_>, values: &mut Values, stayed: &Stayed) {
    let first = calculated.file.assembly.laws().count();
    let preloads = calculated.layout.preloads.clone();
    for (which, place) in preloads.enumerate() {
        let begun_n_m = values.listed()[place];
        let (preload_n_m, has_stayed) = match stayed {
            Stayed::Beginning => (begun_n_m, false),
            Stayed::Ended(all) => {
                let ended_n_m = all.get(which).copied().unwrap_or(begun_n_m);
                (ended_n_m, ended_n_m == begun_n_m)
            }
        };
        if let Some([own, steps, ..]) = values.memories_mut().get_mut(first + which) {
            *steps = if has_stayed && *own == begun_n_m {
                *steps + 1.0
            } else {
                0.0
            };
            *own = preload_n_m;
        }
    }
}

/// Takes it that the preloads stay where they are.
pub(super) fn stay_for_good(calculated: Calculated<'_>, values: &mut Values) {
    let first = calculated.file.assembly.laws().count();
    for [_, steps, ..] in values.memories_mut().iter_mut().skip(first) {
        *steps = STEPS_TO_STAY;
    }
}

/// Preloads (N·m) of the joints that follow one, at which the linear part of a step is propagated.
pub(super) fn about_n_m(calculated: Calculated<'_>, values: &Values, is_held: bool) -> Vec<f64> {
    let assembly = &calculated.file.assembly;
    let first = assembly.laws().count();
    let present = &values.listed()[calculated.layout.preloads.clone()];
    let all = assembly.over_preload().zip(present).enumerate();
    all.map(|(which, (law, &preload_n_m))| {
        let remembered = values.memories().get(first + which);
        let steps = match remembered {
            Some([own, steps, ..]) if *own == preload_n_m && is_held => *steps,
            _ => 0.0,
        };
        if steps >= STEPS_TO_STAY {
            return preload_n_m;
        }
        let knots = law.samples_n_m(0);
        let nearer = |one: f64, other: f64| {
            let is_nearer = (other - preload_n_m).abs() < (one - preload_n_m).abs();
            if is_nearer { other } else { one }
        };
        knots.reduce(nearer).unwrap_or(preload_n_m)
    })
    .collect()
}

/// Moves what the joints remember on to the present point, where a step is completed.
pub(super) fn commit(
    calculated: Calculated<'_>,
    values: &mut Values,
    time_s: f64,
) -> Result<(), Refusal> {
    if values.memories().is_empty() {
        return Ok(());
    }
    // inner states are the importer's
    let inner = present(calculated, values);
    let mut memory = values.memories().to_vec();
    let mut all = memory.iter_mut().enumerate();
    let motion = calculated.motion(values.listed());
    let mut is_finite = true;
    calculated.file.assembly.each_law(motion, |laws, r, rate| {
        if let Some((dof, own)) = all.next()
            && laws.have_memory()
        {
            laws.commit(own, r, rate);
            if let Some(inner) = &inner {
                for shown in &calculated.layout.inner_states {
                    if shown.dof == dof {
                        own[shown.place] = inner[dof][shown.place];
                    }
                }
                laws.settle(own, r, rate);
            }
            is_finite &= laws.is_memory_finite(own);
        }
    });
    if !is_finite {
        let name = Name::Borrowed("of a joint");
        return Err(Refusal::StateNotFinite { name, time_s });
    }
    values.memories_mut().copy_from_slice(&memory);
    look_ahead(calculated, values, false);
    Ok(())
}

/// Looks for what comes next from the present point, which is committed: at an event a joint may have turned.
pub(super) fn look_ahead(calculated: Calculated<'_>, values: &mut Values, is_event: bool) {
    if values.have_events() {
        each_that_turns(calculated, values, |ahead, law, motion| {
            events::look_ahead_on(ahead, law, motion, is_event);
        });
    }
}

/// What the joints remember at the present point, where that is more than what was committed.
pub(super) fn present(calculated: Calculated<'_>, values: &Values) -> Option<Vec<DofMemory>> {
    let has_inner = !calculated.layout.inner.is_empty();
    (values.are_integrated() && has_inner)
        .then(|| calculated.memory(values.listed(), values.memories(), From::Variables))
}

/// The same with its changes along those of `listed`.
pub(super) fn present_change(
    calculated: Calculated<'_, Dual<1>>,
    values: &Values,
    listed: &[Dual<1>],
) -> Option<Vec<DofMemory<Dual<1>>>> {
    let from = match (values.are_starting(), values.memories().is_empty()) {
        (_, true) => return None,
        (true, false) => From::Start,
        (false, false) if calculated.layout.inner.is_empty() => return None,
        (false, false) => From::Variables,
    };
    Some(calculated.memory(listed, values.memories(), from))
}

/// Writes the event indicators.
pub(super) fn write_indicators(calculated: Calculated<'_>, values: &mut Values) {
    if values.have_events() {
        let all = indicators(calculated, values, values, events::indicators_on);
        write(calculated, &all, values);
    }
}

/// Writes their first-order changes.
pub(super) fn write_indicator_changes(
    calculated: Calculated<'_>,
    values: &Values,
    change: &mut Values,
) {
    if values.have_events() {
        let all = indicators(calculated, values, change, events::change_on);
        write(calculated, &all, change);
    }
}

/// What `of` gives for each DOF that turns at the motion of `at`.
fn indicators(
    calculated: Calculated<'_>,
    values: &Values,
    at: &Values,
    of: impl Fn(&[f64; 3], f64, f64) -> [f64; 2],
) -> Vec<[f64; 2]> {
    let mut dof = 0;
    let mut all = Vec::new();
    let mut ahead = values.all_ahead().iter();
    let motion = calculated.motion(at.listed());
    calculated.file.assembly.each_law(motion, |_, r, rate| {
        if calculated.layout.that_turn.contains(&dof)
            && let Some(ahead) = ahead.next()
        {
            all.push(of(ahead, r, rate));
        }
        dof += 1;
    });
    all
}

fn write(calculated: Calculated<'_>, all: &[[f64; 2]], to: &mut Values) {
    let layout = calculated.layout;
    let listed = to.listed_mut();
    for (which, &[turning, ahead]) in all.iter().enumerate() {
        listed[layout.turning.start + which] = turning;
        listed[layout.ahead.start + which] = ahead;
    }
}

/// Calls `of` for each DOF that turns, with its laws, what these remember, and its motion.
fn each_that_turns(
    calculated: Calculated<'_>,
    values: &mut Values,
    mut of: impl FnMut(&mut [f64; 3], (&DofLaws, &DofMemory), [f64; 2]),
) {
    let (listed, memory, ahead) = values.parts_mut();
    let mut ahead = ahead.iter_mut();
    let mut dof = 0;
    let motion = calculated.motion(listed);
    calculated.file.assembly.each_law(motion, |laws, r, rate| {
        if calculated.layout.that_turn.contains(&dof)
            && let Some(ahead) = ahead.next()
        {
            of(ahead, (laws, &memory[dof]), [r, rate]);
        }
        dof += 1;
    });
}
