//! The lap FMU of a joint over the preload: its law follows the input `preload` within each step, and the energy that comes
//! and goes is counted.
//!
//! The energies are what Co-Simulation integrates along with the motion, by the same Runge–Kutta stages. In Model Exchange
//! the importer integrates the work of the loads and the heat of the dampers; it does not tell how fast the preload changes,
//! so that the energy by the changing stiffness is what is left of the balance.

use std::num::NonZeroU32;

use bolted_joint_dynamics::{
    CountedState, JointLaw, JointMemory, JointOverPreload, Lap, LapConditions, LapLoads, LapState,
    PassedEnergy,
};

use super::{
    CHECKED_BETWEEN, are_active, check_preload, preload_power, preload_power_change, smaller,
    with_friction, work_of_preload_change,
};
use crate::{
    input_course::InputCourse,
    interface::{
        InterfaceType, LapCalculatedParameters, LapOverPreloadOutputs, Values, memory,
        reference as vr,
    },
    models::{
        Model, Outcome, Step, events, heat_not_finite,
        lap::{
            differentiate, differentiate_indicators,
            faults::{check_held, check_parameters, check_step},
            loads::Loads,
            prepared::count,
            rates, set_indicators, set_outputs,
            way::{loads, set_state, state},
        },
        sides::{A, B},
        watch::{Watch, finite},
    },
    preload_table::OverPreload,
    refusal::{Active, Reached, Refusal},
};

/// Runge–Kutta steps after which the escape amplitude is taken anew while the preload changes.
const STEPS_BETWEEN_CHECKS: u32 = 8;

/// Two bodies and a joint over the preload between them.
#[derive(Clone, Debug)]
pub(in crate::models) struct LooseningLap<const D: usize> {
    /// What the start-value file says.
    start: OverPreload<D>,
    /// The joint with the friction among the parameters.
    table: JointOverPreload<D>,
    step_size_max_s: Option<f64>,
    /// Who integrates: where it is the importer, so it is for the energies.
    interface_type: InterfaceType,
    /// The joint at the latest preload that a communication step began with.
    latest: Option<AtPreload<D>>,
    watch: Watch<D>,
}

/// The joint at one preload.
#[derive(Clone, Copy, Debug)]
struct AtPreload<const D: usize> {
    preload_n_m: f64,
    law: JointLaw<D>,
    /// Relative displacement that a softening joint holds at most; the largest number where it always holds.
    hold: [f64; D],
}

impl<const D: usize> LooseningLap<D> {
    pub(in crate::models) fn new(start: OverPreload<D>) -> Self {
        Self {
            table: start.joint.clone(),
            start,
            step_size_max_s: None,
            interface_type: InterfaceType::CoSimulation,
            latest: None,
            watch: Watch::default(),
        }
    }

    fn lap_with(&self, values: &Values, joint: JointLaw<D>) -> Lap<D> {
        Lap {
            joint,
            a: A.body(values),
            b: B.body(values),
        }
    }

    /// Bodies and joint at present.
    fn lap(&self, values: &Values) -> Lap<D> {
        self.lap_with(values, self.table.law(values[vr::PRELOAD]))
    }

    /// Energy (J) by the change of stiffness up to the present preload, which may have jumped since the last step.
    fn preload_energy(&self, values: &Values, r: &[f64; D]) -> f64 {
        let counted_n_m = values[memory::COUNTED_PRELOAD];
        if counted_n_m == values[vr::PRELOAD] {
            return values[memory::PRELOAD_WORK];
        }
        let preloads_n_m = [counted_n_m, values[vr::PRELOAD]];
        values[memory::PRELOAD_WORK] + self.table.work_of_preload(preloads_n_m, values.joint(), r)
    }

    /// The steps of one communication step. `conditions_at` gives what acts at a time after its start (s).
    fn steps(
        &self,
        start: &CountedState<D>,
        mut memory: Option<&mut JointMemory<D>>,
        step: Step,
        mut hold: [f64; D],
        conditions_at: &dyn Fn(f64) -> Result<LapConditions<D>, Refusal>,
        is_held: bool,
    ) -> Result<(CountedState<D>, LapConditions<D>), Refusal> {
        let count = self.internal_steps(step.interval_s)?.get();
        let length_s = step.interval_s / f64::from(count);
        let mut counted = *start;
        let mut first = conditions_at(0.0)?;
        for index in 0..count {
            let from_s = f64::from(index) * length_s;
            let to_s = f64::from(index + 1) * length_s;
            counted = if is_held {
                LapConditions::step([&first; 3], &counted, memory.as_deref_mut(), length_s)
            } else {
                let middle = conditions_at(from_s + 0.5 * length_s)?;
                let last = conditions_at(to_s)?;
                let stages = [&first, &middle, &last];
                let next = LapConditions::step(stages, &counted, memory.as_deref_mut(), length_s);
                first = last;
                if (index + 1) % STEPS_BETWEEN_CHECKS == 0 || index + 1 == count {
                    hold = finite(first.lap.escape_amplitude());
                }
                next
            };
            check_held(&counted.state, &hold, step.time_s + to_s)?;
        }
        let PassedEnergy {
            supplied,
            dissipated,
            preload,
        } = counted.passed;
        for (name, energy) in [
            ("energy.supplied", supplied),
            ("energy.dissipated", dissipated),
            ("energy.preload", preload),
        ] {
            if !energy.is_finite() {
                let time_s = step.time_s + step.interval_s;
                let name = name.into();
                return Err(Refusal::StateNotFinite { name, time_s });
            }
        }
        Ok((counted, first))
    }

    /// What there is to tell of a state of this lap at `time_s` (s).
    fn look(
        &mut self,
        lap: &Lap<D>,
        hold: [f64; D],
        state: &LapState<D>,
        time_s: f64,
    ) -> Option<Reached> {
        self.watch.set(&lap.joint, hold);
        self.watch.look(&state.relative().displacement, time_s)
    }

    /// The lap at the preloads that are looked at, for changes of the bodies.
    fn laps(&self, values: &Values) -> impl Iterator<Item = Lap<D>> {
        let [a, b] = [A.body(values), B.body(values)];
        let samples = self.table.samples_n_m(CHECKED_BETWEEN);
        samples.map(move |preload_n_m| Lap {
            joint: self.table.law(preload_n_m),
            a,
            b,
        })
    }
}

impl<const D: usize> Model for LooseningLap<D> {
    fn prepare(
        &mut self,
        values: &Values,
        interface_type: InterfaceType,
    ) -> Result<Option<Active>, Refusal> {
        self.table = with_friction(&self.start, values)?;
        let step_size_max_s = values[vr::STEP_SIZE_MAX];
        check_parameters(&self.lap(values))?;
        // the bolt may come to any preload of the table
        if interface_type == InterfaceType::CoSimulation {
            for lap in self.laps(values) {
                check_step(&lap, step_size_max_s)?;
            }
        }
        let active = are_active(self.laps(values).map(|lap| lap.joint));
        self.step_size_max_s = Some(step_size_max_s);
        self.interface_type = interface_type;
        // the bodies may be others
        self.latest = None;
        Ok(Active::of(active, self.lap(values).has_active_support()))
    }

    fn begin(&self, values: &mut Values) {
        values[memory::COUNTED_PRELOAD] = values[vr::PRELOAD];
        values[memory::PRELOAD_WORK] = 0.0;
        if self.table.has_memory() {
            // the joint has come straight to where it starts; the heat of that way was before
            let (law, relative) = (self.lap(values).joint, state(values).relative());
            values.commit_from_rest(&law, &relative);
            events::begin(values, &law, &relative);
        }
        // what the balance E = E₀ + supplied − dissipated + preload starts from
        let stored = self
            .lap(values)
            .stored_energy(values.joint(), &state(values));
        values[memory::FIRST_ENERGY] =
            stored - values[vr::ENERGY_SUPPLIED] + values[vr::ENERGY_DISSIPATED];
    }

    fn commit(&self, values: &mut Values, time_s: f64) -> Result<(), Refusal> {
        if !self.table.has_memory() {
            return Ok(());
        }
        // its heat is part of the power that the importer integrates
        let (law, relative) = (self.lap(values).joint, state(values).relative());
        let heat_j = values.commit_joint(&law, &relative);
        heat_j.ok_or(heat_not_finite(time_s))?;
        events::look_ahead(values, &law, &relative, false);
        Ok(())
    }

    fn pass_event(&self, values: &mut Values) {
        if self.table.has_memory() {
            let (law, relative) = (self.lap(values).joint, state(values).relative());
            events::look_ahead(values, &law, &relative, true);
        }
    }

    fn check_input(&self, input: usize, value: f64) -> Result<(), Refusal> {
        if input == vr::PRELOAD {
            check_preload(&self.table, value, None)
        } else {
            Ok(())
        }
    }

    fn check_states(&mut self, values: &Values) -> Outcome {
        let (state, lap) = (state(values), self.lap(values));
        let hold = finite(lap.escape_amplitude());
        check_held(&state, &hold, values[vr::TIME])?;
        Ok(self.look(&lap, hold, &state, values[vr::TIME]))
    }

    fn internal_steps(&self, interval_s: f64) -> Result<NonZeroU32, Refusal> {
        let step_size_max_s = self.step_size_max_s.ok_or(Refusal::NotUsable)?;
        count(interval_s, step_size_max_s)
    }

    fn advance(&mut self, values: &mut Values, step: Step, inputs: &InputCourse) -> Outcome {
        let preload_n_m = values[vr::PRELOAD];
        let latest = match self.latest {
            Some(latest) if latest.preload_n_m.to_bits() == preload_n_m.to_bits() => latest,
            _ => {
                let law = self.table.law(preload_n_m);
                let hold = finite(self.lap_with(values, law).escape_amplitude());
                AtPreload {
                    preload_n_m,
                    law,
                    hold,
                }
            }
        };
        self.latest = Some(latest);
        let law = latest.law;
        let state = state::<D>(values);
        let relative = state.relative();
        let mut start = CountedState {
            state,
            passed: PassedEnergy {
                supplied: values[vr::ENERGY_SUPPLIED],
                dissipated: values[vr::ENERGY_DISSIPATED],
                preload: self.preload_energy(values, &relative.displacement),
            },
        };
        // apart, so that a step that is refused leaves no trace
        let mut memory = self.table.has_memory().then(|| *values.joint());
        if let Some(memory) = &mut memory
            && values[memory::COUNTED_PRELOAD] != preload_n_m
        {
            // what holds less since the preload has jumped slips where it is
            start.passed.dissipated += law.commit(memory, &relative);
        }
        let loads: Loads<'_, D> = Loads {
            start: loads(values),
            course: inputs,
        };
        let lap = self.lap_with(values, law);
        let held = |_| {
            Ok(LapConditions {
                lap,
                law_rate: JointLaw::NONE,
                loads: loads.start,
            })
        };
        let along = |after_s: f64| {
            let preload_n_m = inputs.value(vr::PRELOAD, preload_n_m, after_s);
            check_preload(&self.table, preload_n_m, Some(step.time_s + after_s))?;
            let rate = inputs.rate_after(vr::PRELOAD, after_s);
            Ok(LapConditions {
                lap: Lap {
                    joint: self.table.law(preload_n_m),
                    ..lap
                },
                law_rate: self.table.spring_change(preload_n_m).times(rate),
                loads: loads.after(after_s),
            })
        };
        let is_held = inputs.is_held();
        let conditions_at: &dyn Fn(f64) -> _ = if is_held { &held } else { &along };
        let (end, last) = self.steps(
            &start,
            memory.as_mut(),
            step,
            latest.hold,
            conditions_at,
            is_held,
        )?;
        set_state(values, &end.state);
        if let Some(own) = memory {
            values.change_joint(|memory| *memory = own);
        }
        values[vr::ENERGY_SUPPLIED] = end.passed.supplied;
        values[vr::ENERGY_DISSIPATED] = end.passed.dissipated;
        values[memory::PRELOAD_WORK] = end.passed.preload;
        values[memory::COUNTED_PRELOAD] = if is_held {
            preload_n_m
        } else {
            inputs.value(vr::PRELOAD, preload_n_m, step.interval_s)
        };
        let hold = if is_held {
            latest.hold
        } else {
            finite(last.lap.escape_amplitude())
        };
        let end_s = step.time_s + step.interval_s;
        Ok(self.look(&last.lap, hold, &end.state, end_s))
    }

    fn reset(&mut self) {
        self.watch.forget();
    }

    fn calculate_parameters(&self, values: &mut Values) {
        let joint_escape_amplitude = self.laps(values).fold([f64::MAX; D], |least, lap| {
            smaller(least, finite(lap.escape_amplitude()))
        });
        LapCalculatedParameters {
            joint_escape_amplitude,
        }
        .write(values);
    }

    fn differentiate_parameters(&self, values: &Values, change: &mut Values) {
        let mut least = [f64::MAX; D];
        let mut tangent = [0.0; D];
        for lap in self.laps(values) {
            let own = finite(lap.escape_amplitude());
            let own_tangent = lap.escape_amplitude_tangent(&Lap {
                joint: JointLaw::NONE,
                a: A.body(change),
                b: B.body(change),
            });
            for dof in 0..D {
                if own[dof] < least[dof] {
                    (least[dof], tangent[dof]) = (own[dof], own_tangent[dof]);
                }
            }
        }
        LapCalculatedParameters {
            joint_escape_amplitude: tangent,
        }
        .write(change);
    }

    fn rates(&self, values: &Values, inputs: &InputCourse, change: &mut Values) {
        rates::<D>(values, inputs, change);
        change[vr::ENERGY_SUPPLIED] = values[vr::POWER_SUPPLIED];
        change[vr::ENERGY_DISSIPATED] = values[vr::POWER_DISSIPATED];
    }

    fn calculate_outputs(&self, values: &mut Values) {
        let lap = self.lap(values);
        let state = state::<D>(values);
        let relative = state.relative();
        set_outputs(values, &lap, &state);
        if self.table.has_memory() {
            set_indicators::<D>(values);
        }
        LapOverPreloadOutputs {
            power_preload: preload_power(&self.table, values, &relative),
            power_supplied: supplied_power(&loads(values), &state),
            energy_preload: match self.interface_type {
                InterfaceType::CoSimulation => self.preload_energy(values, &relative.displacement),
                // E − E₀ − supplied + dissipated
                InterfaceType::ModelExchange => {
                    values[vr::ENERGY_STORED]
                        - values[memory::FIRST_ENERGY]
                        - values[vr::ENERGY_SUPPLIED]
                        + values[vr::ENERGY_DISSIPATED]
                }
            },
        }
        .write(values);
    }

    fn hold_at_start(&self, change: &mut Values) {
        // nothing has passed yet, whatever the preload is that it begins with
        change[vr::ENERGY_PRELOAD] = 0.0;
    }

    fn differentiate_outputs(&self, values: &Values, change: &mut Values) {
        let lap = self.lap(values);
        let preload_n_m = values[vr::PRELOAD];
        let lap_change = Lap {
            joint: self.table.change(preload_n_m).times(change[vr::PRELOAD]),
            a: A.body(change),
            b: B.body(change),
        };
        let [state, state_change] = [values, &*change].map(state::<D>);
        let motions = [&state, &state_change].map(LapState::relative);
        differentiate([&lap, &lap_change], values, change);
        if self.table.has_memory() {
            differentiate_indicators::<D>(values, change);
        }
        LapOverPreloadOutputs {
            power_preload: preload_power_change(
                &self.table,
                [values, &*change],
                motions.each_ref(),
            ),
            // dP = dFᵀẋ + Fᵀdẋ
            power_supplied: supplied_power(&loads(change), &state)
                + supplied_power(&loads(values), &state_change),
            energy_preload: match self.interface_type {
                InterfaceType::CoSimulation => {
                    let r = motions.each_ref().map(|motion| &motion.displacement);
                    work_of_preload_change(&self.table, [values, &*change], r)
                }
                InterfaceType::ModelExchange => {
                    change[vr::ENERGY_STORED] - change[vr::ENERGY_SUPPLIED]
                        + change[vr::ENERGY_DISSIPATED]
                }
            },
        }
        .write(change);
    }
}

/// Power of the external loads, W.
fn supplied_power<const D: usize>(loads: &LapLoads<D>, state: &LapState<D>) -> f64 {
    let of_side = |load: &[f64; D], velocity: &[f64; D]| {
        (0..D).fold(0.0, |sum, dof| sum + load[dof] * velocity[dof])
    };
    of_side(&loads.a, &state.a.velocity) + of_side(&loads.b, &state.b.velocity)
}
