//! Steps of a lap with any joint: the quick ones where the joint remembers nothing, and those that commit what it remembers.

use crate::{
    counted::{CountedState, LapConditions, PassedEnergy},
    integrator::LapIntegrator,
    lap::{Lap, LapLoads, LapState},
    law::{DOF_AT_REST, JointLaw, JointMemory},
};

/// Motion of both bodies, and what the joint remembers of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LapMoment<const D: usize> {
    /// Motion of both bodies.
    pub state: LapState<D>,
    /// What the joint remembers.
    pub memory: JointMemory<D>,
}

/// A lap made ready for steps.
///
/// A body on a spring, beside the cosine that it follows:
///
/// ```
/// use bolted_joint_dynamics::{Body, JointLaw, Lap, LapLoads, LapState, LapStepper, Motion};
///
/// let body = |stiffness| Body { inertia: [2.0], stiffness: [stiffness], damping: [0.0] };
/// let lap = Lap { joint: JointLaw::NONE, a: body(8e4), b: body(0.0) };
/// let at = |displacement| Motion { displacement: [displacement], velocity: [0.0] };
/// let stepper = LapStepper::new(&lap);
/// let mut moment = stepper.begin(LapState { a: at(1e-3), b: at(0.0) });
/// let (step_s, steps) = (1e-5, 1000);
/// for _ in 0..steps {
///     stepper.step(&mut moment, &[LapLoads { a: [0.0], b: [0.0] }; 3], step_s);
/// }
/// // ω = √(k/m)
/// let expected = 1e-3 * (200.0 * step_s * f64::from(steps)).cos();
/// assert!((moment.state.a.displacement[0] - expected).abs() < 1e-14);
/// ```
#[derive(Clone, Copy, Debug)]
pub struct LapStepper<const D: usize> {
    lap: Lap<D>,
    integrator: LapIntegrator<D>,
}

impl<const D: usize> LapStepper<D> {
    /// Prepares `lap` for stepping. Its inertias must be positive: [`Lap::defect`] tells.
    #[must_use]
    pub fn new(lap: &Lap<D>) -> Self {
        Self {
            lap: *lap,
            integrator: LapIntegrator::new(lap),
        }
    }

    /// Where the joint has come straight from rest to this state, and may turn there.
    #[must_use]
    pub fn begin(&self, state: LapState<D>) -> LapMoment<D> {
        let mut memory = [DOF_AT_REST; D];
        if self.integrator.has_memory() {
            self.lap.joint.commit(&mut memory, &state.relative());
        }
        LapMoment { state, memory }
    }

    /// One Runge–Kutta step of `step_s` (s), with the loads at its start, middle and end.
    pub fn step(&self, moment: &mut LapMoment<D>, loads: &[LapLoads<D>; 3], step_s: f64) {
        if !self.integrator.has_memory() {
            let next = self
                .integrator
                .step_with_loads(&moment.state, loads, step_s);
            moment.state = next;
            return;
        }
        let conditions = loads.map(|loads| LapConditions {
            lap: self.lap,
            law_rate: JointLaw::NONE,
            loads,
        });
        let counted = CountedState {
            state: moment.state,
            passed: PassedEnergy::default(),
        };
        let memory = Some(&mut moment.memory);
        let CountedState { state, .. } =
            LapConditions::step(conditions.each_ref(), &counted, memory, step_s);
        moment.state = state;
    }
}
