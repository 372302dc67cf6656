//! The loads on a lap in the course of a communication step.

use bolted_joint_dynamics::LapLoads;

use crate::{
    input_course::InputCourse,
    models::sides::{A, B, Side},
};

/// The loads over a step.
pub(in crate::models) struct Loads<'a, const D: usize> {
    /// At its beginning.
    pub(in crate::models) start: LapLoads<D>,
    /// How they go on.
    pub(in crate::models) course: &'a InputCourse,
}

impl<const D: usize> Loads<'_, D> {
    /// Loads `after_s` (s) from the beginning.
    pub(in crate::models) fn after(&self, after_s: f64) -> LapLoads<D> {
        let of_side = |side: Side, start: &[f64; D]| {
            let inputs = side.load_references::<D>();
            std::array::from_fn(|dof| self.course.value(inputs[dof], start[dof], after_s))
        };
        LapLoads {
            a: of_side(A, &self.start.a),
            b: of_side(B, &self.start.b),
        }
    }

    /// Loads at the stages of the Runge–Kutta step of `length_s` (s) that has the number `index`, from 0.
    pub(in crate::models) fn at_stages(&self, index: u32, length_s: f64) -> [LapLoads<D>; 3] {
        [0.0, 0.5, 1.0].map(|part| self.after((f64::from(index) + part) * length_s))
    }
}
