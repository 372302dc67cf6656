//! The element FMU of a joint with memory.
//!
//! The motion between two points at which the importer has completed a step is taken as going straight from one to the next:
//! the joint moves on to the motion that is put in where the next step begins, because only then is it known to stay.

use std::num::NonZeroU32;

use bolted_joint_dynamics::JointLaw;

use crate::{
    input_course::InputCourse,
    interface::{
        ElementCalculatedParameters, ElementMemoryOutputs, InterfaceType, Values, memory,
        reference as vr,
    },
    models::{
        CommunicationStep, Model,
        element::{differentiate, rates, relative, set_outputs},
        sides::{is_active, joint_law, joint_memory, set_joint_memory},
        watch::{Watch, finite},
    },
    refusal::{Active, Reached, Refusal},
};

/// The joint alone, with `D` degrees of freedom.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::models) struct RememberingElement<const D: usize> {
    watch: Watch<D>,
}

impl<const D: usize> RememberingElement<D> {
    /// What there is to tell of the inputs at `time_s` (s).
    fn look(&mut self, values: &Values, time_s: f64) -> Option<Reached> {
        let displacement = relative::<D>(values).displacement;
        let quiet = self.watch.quiet();
        if (0..D).all(|dof| displacement[dof].abs() <= quiet[dof]) {
            return None;
        }
        self.watch.look(&displacement, time_s)
    }
}

impl<const D: usize> Model for RememberingElement<D> {
    fn prepare(&mut self, values: &Values, _: InterfaceType) -> Result<Option<Active>, Refusal> {
        let law = joint_law::<D>(values);
        self.watch.set(&law, finite(law.escape_amplitude()));
        let [joint_stiffness, joint_damping] = is_active(&law);
        Ok(Active {
            joint_stiffness,
            joint_damping,
            supports: false,
        }
        .warning())
    }

    fn begin(&self, values: &mut Values) {
        let relative = relative::<D>(values);
        values[vr::ENERGY_DISSIPATED] = 0.0;
        values[memory::COMMITTED_TIME] = values[vr::TIME];
        values[memory::COMMITTED_POWER] = joint_law::<D>(values).viscous_power(&relative);
    }

    fn commit(&self, values: &mut Values) {
        let (law, relative): (JointLaw<D>, _) = (joint_law(values), relative(values));
        let mut remembered = joint_memory(values);
        let slid_j = law.commit(&mut remembered, &relative.displacement);
        // the dampers' heat by the trapezoidal rule
        let power = law.viscous_power(&relative);
        let since_s = values[vr::TIME] - values[memory::COMMITTED_TIME];
        let damped_j = 0.5 * since_s * (power + values[memory::COMMITTED_POWER]);
        set_joint_memory(values, &remembered);
        values[vr::ENERGY_DISSIPATED] += slid_j + damped_j;
        values[memory::COMMITTED_TIME] = values[vr::TIME];
        values[memory::COMMITTED_POWER] = power;
    }

    fn check_states(&mut self, values: &Values) -> Result<Option<Reached>, Refusal> {
        Ok(self.look(values, values[vr::TIME]))
    }

    fn internal_steps(&self, _: f64) -> Result<NonZeroU32, Refusal> {
        Ok(NonZeroU32::MIN)
    }

    fn advance(
        &mut self,
        values: &mut Values,
        step: CommunicationStep,
        _: &InputCourse,
    ) -> Result<Option<Reached>, Refusal> {
        values[vr::TIME] = step.time_s;
        self.commit(values);
        Ok(self.look(values, step.time_s))
    }

    fn advance_steadily(&self, _: &mut Values, _: f64) -> bool {
        false
    }

    fn reset(&mut self) {
        self.watch.forget();
    }

    fn calculate_parameters(&self, values: &mut Values) {
        let joint_escape_amplitude = finite(joint_law::<D>(values).escape_amplitude());
        ElementCalculatedParameters {
            joint_escape_amplitude,
        }
        .write(values);
    }

    fn differentiate_parameters(&self, values: &Values, change: &mut Values) {
        let [law, law_change] = [values, &*change].map(joint_law::<D>);
        ElementCalculatedParameters {
            joint_escape_amplitude: law.escape_amplitude_tangent(&law_change),
        }
        .write(change);
    }

    fn rates(&self, values: &Values, inputs: &InputCourse, change: &mut Values) {
        rates::<D>(values, inputs, change);
    }

    fn calculate_outputs(&self, values: &mut Values) {
        let law = joint_law::<D>(values);
        set_outputs(values, &law);
        // as of the last step
        ElementMemoryOutputs {
            energy_dissipated: values[vr::ENERGY_DISSIPATED],
        }
        .write(values);
    }

    fn differentiate_outputs(&self, values: &Values, change: &mut Values) {
        let [law, law_change] = [values, &*change].map(joint_law::<D>);
        differentiate([&law, &law_change], values, change);
        ElementMemoryOutputs {
            energy_dissipated: 0.0,
        }
        .write(change);
    }
}
