//! The reference run of an element: motions of both sides, held at levels, and the loads in the middle of each level.

use bolted_joint_dynamics::{DOF_AT_REST, JointMemory, Motion};

use super::{LOAD, Laws, Names, ReferenceRun, entry, of_motions, remembered, stimulus, table};
use crate::ExportError;

/// Communication step (s) where nothing says what frequencies matter.
const STEP_S: f64 = 1e-4;

/// Communication steps at each level, an even number, so that there is a communication point in its middle.
const STEPS_A_LEVEL: usize = 4;

const LEVELS: usize = 50;

/// What the last digit of the files leaves open, and nothing else: the element has no steps of its own.
const TOLERANCE: f64 = 1e-11;

pub(super) fn run<const D: usize>(
    laws: &Laws<D>,
    step_s: Option<f64>,
    names: Names,
) -> Result<ReferenceRun, ExportError> {
    let dofs = names.dofs;
    let step_s = step_s.unwrap_or(STEP_S);
    let amplitude = stimulus::relative_motion(laws.nominal(), dofs);
    let time = |step: usize| step as f64 * step_s;
    let level_s = STEPS_A_LEVEL as f64 * step_s;
    let motion = |on_b: bool, level: usize| {
        // Half of the largest relative motion on each side.
        let shape = |i| stimulus::shape(i, on_b, (level + 1) as f64);
        Motion {
            displacement: std::array::from_fn(|i| {
                stimulus::rounded(0.5 * amplitude[i] * shape(i).0)
            }),
            velocity: std::array::from_fn(|i| {
                stimulus::rounded(0.5 * amplitude[i] * shape(i).1 / level_s)
            }),
        }
    };
    let sides: Vec<[Motion<D>; 2]> = (0..LEVELS)
        .map(|level| [motion(false, level), motion(true, level)])
        .collect();
    let inputs = sides.iter().enumerate().flat_map(|(level, sides)| {
        // Constant from one level's beginning to the next.
        [level, level + 1].map(move |edge| {
            (time(STEPS_A_LEVEL * edge), move |name: &str| match name {
                "preload" => Some(laws.preload_n_m(level)),
                _ => of_motions(name, dofs, sides.each_ref()),
            })
        })
    });
    let committed = committed(laws, &sides, step_s);
    let outputs = sides
        .iter()
        .zip(&committed)
        .enumerate()
        .map(|(level, (sides, committed))| {
            let middle = time(STEPS_A_LEVEL * level + STEPS_A_LEVEL / 2);
            let relative = sides[0].relative_to(&sides[1]);
            let law = laws.at(level);
            let memory = &committed.memory;
            let on_b = law.load_on_b_after(memory, &relative);
            let on_a = on_b.map(|load| -load);
            (middle, move |name: &str| match name {
                "energy.stored" => Some(law.stored_energy_after(memory, &relative.displacement)),
                "energy.dissipated" => Some(committed.dissipated_j),
                "power.dissipated" => Some(law.dissipated_power_after(memory, &relative)),
                // the preload is held
                "power.preload" => Some(0.0),
                _ => [("a", &on_a), ("b", &on_b), ("joint", &on_b)]
                    .into_iter()
                    .find_map(|(side, load)| entry(name, side, dofs, &[(LOAD, load)]))
                    .or_else(|| remembered(name, dofs, memory)),
            })
        });
    Ok(ReferenceRun {
        step_s,
        steps: STEPS_A_LEVEL * LEVELS,
        inputs: table(names.inputs, inputs)?,
        outputs: table(names.outputs, outputs)?,
        tolerance: TOLERANCE,
    })
}

/// What the FMU has committed when it is asked in the middle of a level: it commits where each step begins.
struct Committed<const D: usize> {
    memory: JointMemory<D>,
    /// Heat since the start, J.
    dissipated_j: f64,
}

/// The same in the middle of each level.
fn committed<const D: usize>(
    laws: &Laws<D>,
    sides: &[[Motion<D>; 2]],
    step_s: f64,
) -> Vec<Committed<D>> {
    let mut memory = [DOF_AT_REST; D];
    let (mut dissipated_j, mut power_before) = (0.0, None);
    sides
        .iter()
        .enumerate()
        .map(|(level, [a, b])| {
            let (law, relative) = (laws.at(level), a.relative_to(b));
            let power = law.viscous_power(&relative);
            // dampers by the trapezoidal rule from commit to commit
            let mut commit = |memory: &mut JointMemory<D>| {
                let since_s = power_before.map_or(0.0, |before| 0.5 * step_s * (before + power));
                dissipated_j += law.commit(memory, &relative) + since_s;
                power_before = Some(power);
                dissipated_j
            };
            let first_half = (0..STEPS_A_LEVEL / 2).fold(0.0, |_, _| commit(&mut memory));
            let in_the_middle = Committed {
                memory,
                dissipated_j: first_half,
            };
            for _ in STEPS_A_LEVEL / 2..STEPS_A_LEVEL {
                commit(&mut memory);
            }
            in_the_middle
        })
        .collect()
}
