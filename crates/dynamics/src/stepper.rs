//! Steps of a lap with any joint: the quick ones where the joint remembers nothing, and those that commit what it remembers.

use crate::{
    counted::{CountedState, LapConditions, PassedEnergy},
    integrator::LapIntegrator,
    lap::{Lap, LapLoads, LapState},
    law::{JointLaw, JointMemory},
};

/// Motion of both bodies, and what the joint remembers of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LapMoment<const D: usize> {
    /// Motion of both bodies.
    pub state: LapState<D>,
    /// What the joint remembers.
    pub memory: JointMemory<D>,
}

impl<const D: usize> From<LapState<D>> for LapMoment<D> {
    /// The state of a joint that has not moved yet but for the way to it.
    fn from(state: LapState<D>) -> Self {
        Self {
            state,
            memory: JointMemory::REST,
        }
    }
}

/// A lap made ready for steps.
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

    /// One Runge–Kutta step of `step_s` (s), with the loads at its start, middle and end.
    #[must_use]
    pub fn step(
        &self,
        moment: &LapMoment<D>,
        loads: &[LapLoads<D>; 3],
        step_s: f64,
    ) -> LapMoment<D> {
        if !self.integrator.has_memory() {
            let state = self
                .integrator
                .step_with_loads(&moment.state, loads, step_s);
            return LapMoment { state, ..*moment };
        }
        let conditions = loads.map(|loads| LapConditions {
            lap: self.lap,
            law_rate: JointLaw::NONE,
            loads,
        });
        let counted = CountedState {
            state: moment.state,
            memory: moment.memory,
            passed: PassedEnergy::default(),
        };
        let CountedState { state, memory, .. } =
            LapConditions::step(conditions.each_ref(), &counted, step_s);
        LapMoment { state, memory }
    }
}
