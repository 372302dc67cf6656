//! The reference run of a lap: steps of load on both bodies, then free vibration.

use std::num::NonZeroU32;

use bolted_joint_dynamics::{
    CountedState, DOF_AT_REST, JointLaw, JointMemory, Lap, LapConditions, LapIntegrator, LapLoads,
    substeps,
};

use bolted_joint_joint::DofSet;

use super::super::fmu::LapFacts;
use super::super::step::{StepChoice, rounded_down};
use super::{LOAD, Laws, Names, ReferenceRun, entry, of_motions, remembered, stimulus, table};
use crate::ExportError;

const COMMUNICATION_STEPS: usize = 200;
/// Communication steps at each level of load.
const STEPS_A_LEVEL: usize = 5;
/// Levels of load; the bodies are free for the rest of the run.
const LOADED_LEVELS: usize = 32;

/// Length of the run in periods of the slowest mode …
const PERIODS: f64 = 8.0;
/// … as far as these many of the FMU's Runge–Kutta steps go.
const MOST_STEPS: f64 = 2e4;
/// … and these many where each of them follows what a joint remembers, at many times the cost.
const MOST_STEPS_WITH_MEMORY: f64 = 5e3;
/// They may be so many times as many where they are shorter than the modes ask for.
const MOST_TIMES_OF_SHORTER: f64 = 10.0;
/// Runge–Kutta steps in a communication step where nothing moves by itself.
const STEPS_WITHOUT_MODES: f64 = 5.0;

/// Steps of the reference in one step of the FMU: its error is smaller by the fourth power of this, 4096.
const REFINEMENT: NonZeroU32 = NonZeroU32::MIN.saturating_add(7);

/// The FMU may differ by this many times what its Runge–Kutta steps make it differ.
const MARGIN: f64 = 10.0;
/// Differences that rounding in files and sums makes at most.
const ROUNDING: f64 = 1e-9;

/// How often the loads are scaled until the joint opens as far as wanted.
const SCALINGS: usize = 40;
/// How far the joint may open beyond what is wanted.
const EXCESS: f64 = 1.2;
/// Loads of the first try: those that open the joint by these parts of the wanted motion if nothing moves but it.
const FIRST_PART: f64 = 0.1;

pub(super) fn run<const D: usize>(
    lap: &Lap<D>,
    laws: &Laws<D>,
    facts: &LapFacts,
    names: Names,
) -> Result<Option<ReferenceRun>, ExportError> {
    let dofs = names.dofs;
    let system = System { lap, laws, dofs };
    let Some(Course {
        plan,
        levels,
        of_fmu,
        states,
    }) = Course::new(&system, facts)
    else {
        return Ok(None);
    };

    let time = |step: usize| step as f64 * plan.step_s;
    let inputs = levels.iter().enumerate().flat_map(|(level, loads)| {
        // Constant from one level's beginning to the next.
        [level, level + 1].map(move |edge| {
            (time(STEPS_A_LEVEL * edge), move |name: &str| match name {
                "preload" => Some(laws.preload_n_m(level)),
                _ => input(loads, dofs, name),
            })
        })
    });
    let outputs = |states: Vec<Moment<D>>| {
        let levels = &levels;
        let rows = states
            .into_iter()
            .enumerate()
            .filter(|(step, _)| laws.tells(*step))
            .map(|(step, moment)| {
                let level = step.saturating_sub(1) / STEPS_A_LEVEL;
                let conditions = system.conditions(level, &levels[level]);
                (time(step), move |name: &str| {
                    output(&conditions, &moment, dofs, name)
                })
            });
        table(names.outputs.clone(), rows)
    };
    let (mut found, mut reference) = (outputs(of_fmu)?, outputs(states)?);
    let noise = reference.of_rounding();
    found.leave_out(&noise);
    reference.leave_out(&noise);
    let deviation = (0..reference.names.len())
        .map(|column| {
            let both = || found.rows.iter().zip(&reference.rows);
            let largest = |values: &mut dyn Iterator<Item = f64>| values.fold(0.0, f64::max);
            let difference = largest(&mut both().map(|(f, r)| (f.1[column] - r.1[column]).abs()));
            match largest(&mut both().map(|(_, r)| r.1[column].abs())) {
                0.0 => 0.0,
                magnitude => difference / magnitude,
            }
        })
        .fold(0.0, f64::max);
    Ok(Some(ReferenceRun {
        step_s: plan.step_s,
        steps: COMMUNICATION_STEPS,
        inputs: table(names.inputs.clone(), inputs)?,
        outputs: reference,
        tolerance: rounded_up((MARGIN * deviation).max(ROUNDING)),
    }))
}

/// Motion and energies at a time, and what the joint remembers then.
pub(super) type Moment<const D: usize> = (CountedState<D>, JointMemory<D>);

/// What goes on in the run.
struct Course<const D: usize> {
    plan: Plan,
    levels: Vec<LapLoads<D>>,
    /// States at the communication points, by the FMU's steps.
    of_fmu: Vec<Moment<D>>,
    /// The same, by far smaller ones.
    states: Vec<Moment<D>>,
}

impl<const D: usize> Course<D> {
    /// `None` if there is nothing that stays finite.
    fn new(system: &System<'_, D>, facts: &LapFacts) -> Option<Self> {
        let plan = Plan::new(facts, system.laws.have_memory())?;
        let levels = plan.levels(system)?;
        Some(Self {
            of_fmu: plan.states(system, &levels, NonZeroU32::MIN)?,
            states: plan.states(system, &levels, REFINEMENT)?,
            plan,
            levels,
        })
    }
}

impl<const D: usize> Laws<D> {
    /// Whether the joint remembers, at any preload.
    pub(super) fn have_memory(&self) -> bool {
        match self {
            Self::Constant(law) => law.has_memory(),
            Self::Table { .. } => self.at(0).has_memory(),
        }
    }

    /// Whether the outputs at this communication point can be compared: where a level begins, importers differ in whether they
    /// read before or after they set the inputs, and with the preload the outputs jump.
    fn tells(&self, step: usize) -> bool {
        matches!(self, Self::Constant(_)) || !step.is_multiple_of(STEPS_A_LEVEL)
    }
}

/// What is integrated.
pub(super) struct System<'a, const D: usize> {
    pub(super) lap: &'a Lap<D>,
    pub(super) laws: &'a Laws<D>,
    pub(super) dofs: DofSet,
}

impl<const D: usize> System<'_, D> {
    /// What acts at a level.
    fn conditions(&self, level: usize, loads: &LapLoads<D>) -> LapConditions<D> {
        LapConditions {
            lap: Lap {
                joint: self.laws.at(level),
                ..*self.lap
            },
            law_rate: JointLaw::NONE,
            loads: *loads,
        }
    }

    /// Motions of both bodies and the joint's loads at communication point number `step`.
    pub(super) fn values(&self, step: usize, moment: &Moment<D>) -> Vec<f64> {
        let (CountedState { state, .. }, memory) = moment;
        let law = self.laws.at(step.saturating_sub(1) / STEPS_A_LEVEL);
        let motions = [&state.a, &state.b].into_iter();
        let motions = motions.flat_map(|motion| [motion.displacement, motion.velocity]);
        let loads = law.load_on_b_after(memory, &state.relative());
        motions.chain([loads]).flatten().collect()
    }

    /// From communication point to communication point, from rest.
    fn states(&self, levels: &[LapLoads<D>], step_s: f64, substeps: NonZeroU32) -> Vec<Moment<D>> {
        let (mut counted, mut memory) = (CountedState::REST, [DOF_AT_REST; D]);
        let mut states = vec![(counted, memory)];
        let plain = LapIntegrator::new(self.lap);
        for (level, loads) in levels.iter().enumerate() {
            let conditions = self.conditions(level, loads);
            if let Some(before) = level.checked_sub(1) {
                // the preload jumps, and what holds less slips
                if let Laws::Table { table, .. } = self.laws {
                    let preloads_n_m = [before, level].map(|level| self.laws.preload_n_m(level));
                    let relative = counted.state.relative();
                    counted.passed.preload +=
                        table.work_of_preload(preloads_n_m, &memory, &relative.displacement);
                    let law = &conditions.lap.joint;
                    counted.passed.dissipated += law.commit(&mut memory, &relative);
                }
            }
            for _ in 0..STEPS_A_LEVEL {
                match self.laws {
                    Laws::Constant(law) if !law.has_memory() => {
                        counted.state = plain.advance(&counted.state, loads, step_s, substeps);
                    }
                    Laws::Constant(_) | Laws::Table { .. } => {
                        let length_s = step_s / f64::from(substeps.get());
                        for _ in 0..substeps.get() {
                            counted = LapConditions::step(
                                [&conditions; 3],
                                &counted,
                                Some(&mut memory),
                                length_s,
                            );
                        }
                    }
                }
                states.push((counted, memory));
            }
        }
        states
    }
}

/// Communication steps of the run.
pub(super) struct Plan {
    pub(super) step_s: f64,
    substeps: NonZeroU32,
}

impl Plan {
    pub(super) fn new(facts: &LapFacts, have_memory: bool) -> Option<Self> {
        let longest_s = facts.step.longest_s;
        let most_steps = if have_memory {
            MOST_STEPS_WITH_MEMORY
        } else {
            MOST_STEPS
        };
        let most_s = match facts.step.choice {
            // as long as with the step of the modes, so that the joint opens as far
            StepChoice::Error { of_modes_s, .. } => {
                let most_shorter_s = MOST_TIMES_OF_SHORTER * longest_s;
                most_steps * longest_s.max(of_modes_s.min(most_shorter_s))
            }
            _ => most_steps * longest_s,
        };
        let duration_s = match facts.modes.first() {
            Some(slowest) => (PERIODS / slowest.frequency_hz).min(most_s),
            None => STEPS_WITHOUT_MODES * longest_s * COMMUNICATION_STEPS as f64,
        };
        let step_s = rounded_down(duration_s / COMMUNICATION_STEPS as f64, 2);
        let substeps = substeps(step_s, longest_s)?;
        Some(Self { step_s, substeps })
    }

    /// Loads that open the joint as far as wanted in one DOF, and no further in the other.
    pub(super) fn levels<const D: usize>(
        &self,
        system: &System<'_, D>,
    ) -> Option<Vec<LapLoads<D>>> {
        let joint = &system.lap.joint;
        let wanted = stimulus::relative_motion(joint, system.dofs);
        let amplitude: [f64; D] = std::array::from_fn(|i| {
            let load = FIRST_PART * joint.linear.stiffness[i][i] * wanted[i];
            if load > 0.0 { load } else { wanted[i] }
        });
        // friction that begins to slip opens the joint all at once: between loads that open it too little and too far the next
        // ones lie between these
        let (mut scale, mut below, mut above) = (1.0, 0.0, f64::INFINITY);
        for _ in 0..SCALINGS {
            let levels = levels_of(&amplitude.map(|load| scale * load));
            let opening = self
                .states(system, &levels, NonZeroU32::MIN)
                .map(|states| opening(&states, &wanted));
            let factor = match opening {
                Some(opening) if (1.0 / EXCESS..=EXCESS).contains(&opening) => return Some(levels),
                Some(opening) if opening > 0.0 => (1.0 / opening).clamp(0.1, 1e6),
                Some(_) => return None,
                None => 0.1,
            };
            if factor > 1.0 {
                below = scale;
            } else {
                above = scale;
            }
            let next = scale * factor;
            scale = if (below..=above).contains(&next) {
                next
            } else {
                (below * above).sqrt()
            };
        }
        None
    }

    /// States at the communication points, from rest; `None` if they do not stay finite.
    fn states<const D: usize>(
        &self,
        system: &System<'_, D>,
        levels: &[LapLoads<D>],
        refinement: NonZeroU32,
    ) -> Option<Vec<Moment<D>>> {
        self.states_of(system, levels, self.substeps.checked_mul(refinement)?)
    }

    /// The same with so many steps between communication points.
    pub(super) fn states_of<const D: usize>(
        &self,
        system: &System<'_, D>,
        levels: &[LapLoads<D>],
        substeps: NonZeroU32,
    ) -> Option<Vec<Moment<D>>> {
        let states = system.states(levels, self.step_s, substeps);
        let last = states.last()?.0.state;
        let finite = [last.a, last.b].iter().all(|motion| {
            let mut values = motion.displacement.iter().chain(&motion.velocity);
            values.all(|value| value.is_finite())
        });
        finite.then_some(states)
    }
}

fn levels_of<const D: usize>(amplitude: &[f64; D]) -> Vec<LapLoads<D>> {
    let side = |on_b, level| {
        std::array::from_fn(|i| {
            stimulus::rounded(amplitude[i] * stimulus::shape(i, on_b, (level + 1) as f64).0)
        })
    };
    (0..COMMUNICATION_STEPS / STEPS_A_LEVEL)
        .map(|level| match level {
            0..LOADED_LEVELS => LapLoads {
                a: side(false, level),
                b: side(true, level),
            },
            _ => LapLoads {
                a: [0.0; D],
                b: [0.0; D],
            },
        })
        .collect()
}

/// Largest relative motion as a part of what is wanted.
fn opening<const D: usize>(states: &[Moment<D>], wanted: &[f64; D]) -> f64 {
    states
        .iter()
        .flat_map(|(counted, _)| {
            let relative = counted.state.a.relative_to(&counted.state.b);
            std::array::from_fn::<f64, D, _>(|i| relative.displacement[i].abs() / wanted[i])
        })
        .fold(0.0, f64::max)
}

fn input<const D: usize>(loads: &LapLoads<D>, dofs: DofSet, name: &str) -> Option<f64> {
    [("a", &loads.a), ("b", &loads.b)]
        .into_iter()
        .find_map(|(side, load)| entry(name, side, dofs, &[(LOAD, load)]))
}

fn output<const D: usize>(
    conditions: &LapConditions<D>,
    moment: &Moment<D>,
    dofs: DofSet,
    name: &str,
) -> Option<f64> {
    let LapConditions { lap, .. } = conditions;
    let (CountedState { state, passed }, memory) = moment;
    let on_b = lap.joint.load_on_b_after(memory, &state.relative());
    match name {
        "energy.stored" => Some(lap.stored_energy(memory, state)),
        "energy.supplied" => Some(passed.supplied),
        "energy.dissipated" => Some(passed.dissipated),
        "energy.preload" => Some(passed.preload),
        "power.dissipated" => Some(lap.dissipated_power(memory, state)),
        "power.supplied" => Some(conditions.powers(memory, state).supplied),
        // the preload is held
        "power.preload" => Some(0.0),
        _ => of_motions(name, dofs, [&state.a, &state.b])
            .or_else(|| entry(name, "joint", dofs, &[(LOAD, &on_b)]))
            .or_else(|| remembered(name, dofs, memory)),
    }
}

/// To one significant digit, never down.
fn rounded_up(value: f64) -> f64 {
    let down = rounded_down(value, 1);
    if down >= value {
        return down;
    }
    let power = 10_f64.powi(down.log10().floor() as i32);
    format!("{:.0e}", down + power).parse().unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use super::rounded_up;

    #[test]
    fn rounding_up_keeps_one_digit() {
        for (value, expected) in [(1.01e-5, 2e-5), (9.2e-7, 1e-6), (3e-4, 3e-4), (1e-9, 1e-9)] {
            assert_eq!(rounded_up(value), expected, "{value}");
        }
    }
}
