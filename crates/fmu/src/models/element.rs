//! The element FMU: a massless joint, motion of both sides in, loads on both sides out, no states.

use std::num::NonZeroU32;

use bolted_joint_dynamics::Motion;

use crate::{
    input_course::InputCourse,
    interface::{InterfaceType, Values, reference as vr},
    models::{
        CommunicationStep, Model,
        sides::{A, B, is_active, joint_law, set_joint_load},
    },
    refusal::{Active, Refusal},
};

/// The joint alone, with `D` degrees of freedom.
#[derive(Clone, Copy, Debug)]
pub(super) struct Element<const D: usize>;

impl<const D: usize> Model for Element<D> {
    fn prepare(&mut self, values: &Values, _: InterfaceType) -> Result<Option<Active>, Refusal> {
        let [joint_stiffness, joint_damping] = is_active::<D>(&joint_law(values));
        Ok(Active {
            joint_stiffness,
            joint_damping,
            supports: false,
        }
        .warning())
    }

    fn check_states(&self, _: &Values) -> Result<(), Refusal> {
        Ok(())
    }

    fn internal_steps(&self, _: f64) -> Result<NonZeroU32, Refusal> {
        Ok(NonZeroU32::MIN)
    }

    fn advance(
        &mut self,
        _: &mut Values,
        _: CommunicationStep,
        _: &InputCourse,
    ) -> Result<(), Refusal> {
        Ok(())
    }

    fn advance_steadily(&self, _: &mut Values, _: f64) -> bool {
        true
    }

    fn rates(&self, values: &Values, inputs: &InputCourse, rates: &mut Values) {
        for side in [A, B] {
            let Motion { velocity, .. } = side.motion::<D>(values);
            let [displacements, velocities] = side.motion_references::<D>();
            // the velocity that is put in is the displacement's derivative, unless another one was given
            side.set_motion(
                rates,
                &Motion {
                    displacement: std::array::from_fn(|dof| {
                        inputs.rate(displacements[dof]).unwrap_or(velocity[dof])
                    }),
                    velocity: velocities.map(|input| inputs.rate(input).unwrap_or(0.0)),
                },
            );
        }
    }

    fn calculate_outputs(&self, values: &mut Values) {
        let law = joint_law::<D>(values);
        let relative = A.motion::<D>(values).relative_to(&B.motion(values));
        let on_b = law.load_on_b(&relative);
        // 0 − F is −F but for F = 0, which stays without a sign
        A.set_load(values, &on_b.map(|load| 0.0 - load));
        B.set_load(values, &on_b);
        set_joint_load(values, &on_b);
        values[vr::ENERGY_STORED] = law.stored_energy(&relative.displacement);
        values[vr::POWER_DISSIPATED] = law.dissipated_power(&relative);
    }

    fn differentiate_outputs(&self, values: &Values, change: &mut Values) {
        let [law, law_change] = [values, &*change].map(joint_law::<D>);
        let [relative, relative_change] =
            [values, &*change].map(|values| A.motion::<D>(values).relative_to(&B.motion(values)));
        let on_b = law.load_on_b_tangent(&law_change, &relative, &relative_change);
        A.set_load(change, &on_b.map(|load| -load));
        B.set_load(change, &on_b);
        set_joint_load(change, &on_b);
        change[vr::ENERGY_STORED] = law.stored_energy_tangent(
            &law_change,
            &relative.displacement,
            &relative_change.displacement,
        );
        change[vr::POWER_DISSIPATED] =
            law.dissipated_power_tangent(&law_change, &relative, &relative_change);
    }
}
