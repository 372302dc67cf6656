//! The lap FMU of a joint with memory: Runge–Kutta steps whose stages take the joint as it was committed, with one commit at the
//! end of each. In Model Exchange the importer integrates the heat, and a commit follows each step that it has completed.

use std::num::NonZeroU32;

use bolted_joint_dynamics::{
    CountedState, DOF_AT_REST, JointLaw, JointMemory, Lap, LapConditions, LapState, PassedEnergy,
};

use crate::{
    input_course::InputCourse,
    interface::{Values, reference as vr},
    models::{
        Outcome, Step, events, heat_not_finite,
        lap::{
            differentiate_indicators,
            faults::check_held,
            loads::Loads,
            prepared::count,
            set_indicators,
            way::{Way, lap, loads, set_state, state},
        },
        watch::{Watch, finite},
    },
    refusal::{Reached, Refusal},
};

/// Two bodies and a joint with memory between them.
#[derive(Clone, Copy, Debug)]
pub(in crate::models) struct RememberingLap<const D: usize> {
    lap: Lap<D>,
    step_size_max_s: f64,
    hold: [f64; D],
    /// Where a communication step moves on what the joint remembers.
    memory: JointMemory<D>,
}

impl<const D: usize> Way<D> for RememberingLap<D> {
    fn new(lap: &Lap<D>, step_size_max_s: f64, escape: [Option<f64>; D], _: [f64; D]) -> Self {
        Self {
            lap: *lap,
            step_size_max_s,
            hold: finite(escape),
            memory: [DOF_AT_REST; D],
        }
    }

    fn hold(&self) -> &[f64; D] {
        &self.hold
    }

    fn look(&mut self, watch: &mut Watch<D>, state: &LapState<D>, time_s: f64) -> Option<Reached> {
        watch.look(&state.relative().displacement, time_s)
    }

    fn internal_steps(&self, interval_s: f64) -> Result<NonZeroU32, Refusal> {
        count(interval_s, self.step_size_max_s)
    }

    fn begin(values: &mut Values) {
        // the joint has come straight to where it starts; the heat of that way was before
        let law: JointLaw<D> = lap(values).joint;
        let relative = state(values).relative();
        values.commit_from_rest(&law, &relative);
        events::begin(values, &law, &relative);
    }

    fn commit(values: &mut Values, time_s: f64) -> Result<(), Refusal> {
        let relative = state::<D>(values).relative();
        let law: JointLaw<D> = lap(values).joint;
        // its heat is part of the power that the importer integrates
        let heat_j = values.commit_joint(&law, &relative);
        heat_j.ok_or(heat_not_finite(time_s))?;
        events::look_ahead(values, &law, &relative, false);
        Ok(())
    }

    fn pass_event(values: &mut Values) {
        let law: JointLaw<D> = lap(values).joint;
        let relative = state(values).relative();
        events::look_ahead(values, &law, &relative, true);
    }

    fn set_indicators(values: &mut Values) {
        set_indicators::<D>(values);
    }

    fn differentiate_indicators(values: &Values, change: &mut Values) {
        differentiate_indicators::<D>(values, change);
    }

    fn advance(
        &mut self,
        watch: &mut Watch<D>,
        values: &mut Values,
        step: Step,
        inputs: &InputCourse,
    ) -> Outcome {
        let loads: Loads<'_, D> = Loads {
            start: loads(values),
            course: inputs,
        };
        let count = self.internal_steps(step.interval_s)?.get();
        let length_s = step.interval_s / f64::from(count);
        let mut counted = CountedState {
            state: state::<D>(values),
            passed: PassedEnergy {
                dissipated: values[vr::ENERGY_DISSIPATED],
                ..PassedEnergy::default()
            },
        };
        // apart, so that a step that is refused leaves no trace
        let law = &self.lap.joint;
        law.copy_memory(values.joint(), &mut self.memory);
        for index in 0..count {
            let conditions = loads.at_stages(index, length_s).map(|loads| LapConditions {
                lap: self.lap,
                law_rate: JointLaw::NONE,
                loads,
            });
            let memory = Some(&mut self.memory);
            counted = LapConditions::step(conditions.each_ref(), &counted, memory, length_s);
            let end_s = step.time_s + length_s * f64::from(index + 1);
            check_held(&counted.state, &self.hold, end_s)?;
        }
        let end_s = step.time_s + step.interval_s;
        if !counted.passed.dissipated.is_finite() {
            return Err(heat_not_finite(end_s));
        }
        set_state(values, &counted.state);
        let (law, own) = (&self.lap.joint, &self.memory);
        values.change_joint(|memory| law.copy_memory(own, memory));
        values[vr::ENERGY_DISSIPATED] = counted.passed.dissipated;
        Ok(self.look(watch, &counted.state, end_s))
    }

    fn add_rates(values: &Values, rates: &mut Values) {
        rates[vr::ENERGY_DISSIPATED] = values[vr::POWER_DISSIPATED];
    }
}
