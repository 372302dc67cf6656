//! The lap FMU of a joint with memory: Runge–Kutta steps whose stages take the joint as it was committed, with one commit at the
//! end of each. In Model Exchange the importer integrates the heat, and a commit follows each step that it has completed.

use std::num::NonZeroU32;

use bolted_joint_dynamics::{CountedState, JointLaw, Lap, LapConditions, LapState, PassedEnergy};

use crate::{
    input_course::InputCourse,
    interface::{InterfaceType, LapCalculatedParameters, Values, reference as vr},
    models::{
        CommunicationStep, Model,
        lap::{
            differentiate,
            faults::{check_parameters, check_step, fault},
            lap, loads,
            loads::Loads,
            prepared::{count, is_within},
            rates, set_outputs, state,
        },
        sides::{A, B, is_active, joint_memory, set_joint_memory},
        watch::{Watch, finite},
    },
    refusal::{Active, Reached, Refusal},
};

/// Two bodies and a joint with memory between them.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::models) struct RememberingLap<const D: usize> {
    /// What the parameters give; `None` before they are first taken into use.
    prepared: Option<Prepared<D>>,
    watch: Watch<D>,
}

#[derive(Clone, Copy, Debug)]
struct Prepared<const D: usize> {
    lap: Lap<D>,
    step_size_max_s: f64,
    /// Relative displacement that a softening joint holds at most; the largest number where it always holds.
    hold: [f64; D],
}

impl<const D: usize> RememberingLap<D> {
    fn prepared(&self) -> Result<&Prepared<D>, Refusal> {
        self.prepared.as_ref().ok_or(Refusal::NotUsable)
    }

    /// What there is to tell of this state at `time_s` (s).
    fn look(&mut self, state: &LapState<D>, time_s: f64) -> Option<Reached> {
        if is_within(&self.watch.quiet(), state) {
            return None;
        }
        self.watch.look(&state.relative().displacement, time_s)
    }
}

impl<const D: usize> Model for RememberingLap<D> {
    fn prepare(
        &mut self,
        values: &Values,
        interface_type: InterfaceType,
    ) -> Result<Option<Active>, Refusal> {
        let lap = lap::<D>(values);
        check_parameters(&lap)?;
        let step_size_max_s = values[vr::STEP_SIZE_MAX];
        if interface_type == InterfaceType::CoSimulation {
            check_step(&lap, step_size_max_s)?;
        }
        let hold = finite(lap.escape_amplitude());
        self.watch.set(&lap.joint, hold);
        self.prepared = Some(Prepared {
            lap,
            step_size_max_s,
            hold,
        });
        let [joint_stiffness, joint_damping] = is_active(&lap.joint);
        Ok(Active {
            joint_stiffness,
            joint_damping,
            supports: lap.has_active_support(),
        }
        .warning())
    }

    fn commit(&self, values: &mut Values) {
        let relative = state::<D>(values).relative();
        let mut remembered = joint_memory(values);
        // its heat is part of the power that the importer integrates
        let law: JointLaw<D> = lap(values).joint;
        law.commit(&mut remembered, &relative.displacement);
        set_joint_memory(values, &remembered);
    }

    fn check_states(&mut self, values: &Values) -> Result<Option<Reached>, Refusal> {
        let hold = self.prepared()?.hold;
        let state = state(values);
        if !is_within(&hold, &state) {
            return Err(fault(&state, &hold, values[vr::TIME]));
        }
        Ok(self.look(&state, values[vr::TIME]))
    }

    fn internal_steps(&self, interval_s: f64) -> Result<NonZeroU32, Refusal> {
        count(interval_s, self.prepared()?.step_size_max_s)
    }

    fn advance(
        &mut self,
        values: &mut Values,
        step: CommunicationStep,
        inputs: &InputCourse,
    ) -> Result<Option<Reached>, Refusal> {
        let Prepared { lap, hold, .. } = *self.prepared()?;
        let loads: Loads<'_, D> = Loads {
            start: loads(values),
            course: inputs,
        };
        let count = self.internal_steps(step.interval_s)?.get();
        let length_s = step.interval_s / f64::from(count);
        let mut counted = CountedState {
            state: state(values),
            memory: joint_memory(values),
            passed: PassedEnergy {
                dissipated: values[vr::ENERGY_DISSIPATED],
                ..PassedEnergy::default()
            },
        };
        for index in 0..count {
            let conditions = loads.at_stages(index, length_s).map(|loads| LapConditions {
                lap,
                law_rate: JointLaw::NONE,
                loads,
            });
            counted = LapConditions::step(conditions.each_ref(), &counted, length_s);
            let end_s = step.time_s + length_s * f64::from(index + 1);
            if !is_within(&hold, &counted.state) {
                return Err(fault(&counted.state, &hold, end_s));
            }
        }
        let end_s = step.time_s + step.interval_s;
        if !counted.passed.dissipated.is_finite() {
            return Err(Refusal::StateNotFinite {
                name: "energy.dissipated",
                time_s: end_s,
            });
        }
        A.set_motion(values, &counted.state.a);
        B.set_motion(values, &counted.state.b);
        set_joint_memory(values, &counted.memory);
        values[vr::ENERGY_DISSIPATED] = counted.passed.dissipated;
        Ok(self.look(&counted.state, end_s))
    }

    fn advance_steadily(&self, _: &mut Values, _: f64) -> bool {
        false
    }

    fn reset(&mut self) {
        self.watch.forget();
    }

    fn calculate_parameters(&self, values: &mut Values) {
        let joint_escape_amplitude = finite(lap::<D>(values).escape_amplitude());
        LapCalculatedParameters {
            joint_escape_amplitude,
        }
        .write(values);
    }

    fn differentiate_parameters(&self, values: &Values, change: &mut Values) {
        let [lap, lap_change] = [values, &*change].map(lap::<D>);
        LapCalculatedParameters {
            joint_escape_amplitude: lap.escape_amplitude_tangent(&lap_change),
        }
        .write(change);
    }

    fn rates(&self, values: &Values, inputs: &InputCourse, change: &mut Values) {
        rates::<D>(values, inputs, change);
        change[vr::ENERGY_DISSIPATED] = values[vr::POWER_DISSIPATED];
    }

    fn calculate_outputs(&self, values: &mut Values) {
        let (lap, state) = (lap::<D>(values), state::<D>(values));
        set_outputs(values, &lap, &state);
    }

    fn differentiate_outputs(&self, values: &Values, change: &mut Values) {
        let [lap, lap_change] = [values, &*change].map(lap::<D>);
        differentiate([&lap, &lap_change], values, change);
    }
}
