//! Time integration of a lap that keeps account: the joint's law may change within a step because its bolt loosens, the joint
//! may remember its motion, and the energy that comes and goes is counted.

mod cut;

use std::array::from_fn;

use crate::{
    lap::{Lap, LapLoads, LapState},
    law::{DOF_AT_REST, JointLaw, JointMemory},
    motion::Motion,
    vector::dot,
};

/// Energies that have passed since they were last zero, J.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PassedEnergy {
    /// Work of the external loads.
    pub supplied: f64,
    /// Turned into heat by joint and supports.
    pub dissipated: f64,
    /// Work done on the joint's springs by their change of stiffness; negative while the joint loosens.
    pub preload: f64,
}

/// What acts at one time of a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LapConditions<const D: usize> {
    /// The bodies, and the joint at its present preload.
    pub lap: Lap<D>,
    /// How fast the joint's springs change, those of its friction among them: coefficients per s.
    pub law_rate: JointLaw<D>,
    /// External loads.
    pub loads: LapLoads<D>,
}

/// Motion, and the energy that has passed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CountedState<const D: usize> {
    /// Motion of both bodies.
    pub state: LapState<D>,
    /// What was counted so far.
    pub passed: PassedEnergy,
}

impl<const D: usize> CountedState<D> {
    /// At rest, before anything has moved.
    pub const REST: Self = Self {
        state: LapState::REST,
        passed: PassedEnergy {
            supplied: 0.0,
            dissipated: 0.0,
            preload: 0.0,
        },
    };
}

/// Velocities and accelerations, and the powers.
struct Rate<const D: usize> {
    state: LapState<D>,
    powers: PassedEnergy,
}

impl<const D: usize> LapConditions<D> {
    /// Power of the external loads, of the dampers and of the changing stiffness in this state, W. The heat of laws that
    /// remember is none of it: that is counted where they move on.
    #[must_use]
    pub fn powers(&self, memory: &JointMemory<D>, state: &LapState<D>) -> PassedEnergy {
        let relative = state.relative();
        PassedEnergy {
            // P = F_aᵀ ẋ_a + F_bᵀ ẋ_b
            supplied: dot(&self.loads.a, &state.a.velocity) + dot(&self.loads.b, &state.b.velocity),
            dissipated: self.lap.viscous_power(state),
            preload: self
                .lap
                .joint
                .power_of_change(&self.law_rate, memory, &relative.displacement),
        }
    }

    /// Motion and energies after one step of the classical Runge–Kutta method of `step_s` (s), in which these conditions hold
    /// at its start, middle and end. What the joint remembers moves on at the end, and before where the joint turns or its load
    /// has a corner: there the step is cut. A joint that remembers nothing needs no `memory`.
    #[must_use]
    pub fn step(
        conditions: [&Self; 3],
        counted: &CountedState<D>,
        memory: Option<&mut JointMemory<D>>,
        step_s: f64,
    ) -> CountedState<D> {
        match memory {
            None => Self::plain_step(conditions, counted, &[DOF_AT_REST; D], step_s),
            Some(memory) => Self::cut_step(conditions, counted, memory, step_s),
        }
    }

    /// One step of a joint that remembers this all the way.
    fn plain_step(
        [start, middle, end]: [&Self; 3],
        counted: &CountedState<D>,
        before: &JointMemory<D>,
        step_s: f64,
    ) -> CountedState<D> {
        let half_s = 0.5 * step_s;
        let k1 = start.rate(before, &counted.state);
        let k2 = middle.rate(before, &moved(&counted.state, half_s, &k1.state));
        let k3 = middle.rate(before, &moved(&counted.state, half_s, &k2.state));
        let k4 = end.rate(before, &moved(&counted.state, step_s, &k3.state));
        // z(t+h) = z + h/6 (k₁ + 2k₂ + 2k₃ + k₄)
        let sixth_s = step_s / 6.0;
        let mean = |of: fn(&PassedEnergy) -> f64| {
            let [k1, k2, k3, k4] = [&k1, &k2, &k3, &k4].map(|k| of(&k.powers));
            of(&counted.passed) + sixth_s * (k1 + 2.0 * (k2 + k3) + k4)
        };
        let passed = PassedEnergy {
            supplied: mean(|passed| passed.supplied),
            dissipated: mean(|passed| passed.dissipated),
            preload: mean(|passed| passed.preload),
        };
        let inner = moved(&k2.state, 1.0, &k3.state);
        let outer = moved(&k1.state, 1.0, &k4.state);
        let sum = moved(&outer, 2.0, &inner);
        let state = moved(&counted.state, sixth_s, &sum);
        CountedState { state, passed }
    }

    fn rate(&self, memory: &JointMemory<D>, state: &LapState<D>) -> Rate<D> {
        let [of_a, of_b] = self.lap.accelerations(memory, state, &self.loads);
        let rate = |motion: &Motion<D>, acceleration| Motion {
            displacement: motion.velocity,
            velocity: acceleration,
        };
        Rate {
            state: LapState {
                a: rate(&state.a, of_a),
                b: rate(&state.b, of_b),
            },
            powers: self.powers(memory, state),
        }
    }
}

/// `state + factor · rate`
fn moved<const D: usize>(state: &LapState<D>, factor: f64, rate: &LapState<D>) -> LapState<D> {
    let sum = |of: &[f64; D], rate: &[f64; D]| from_fn(|i| of[i] + factor * rate[i]);
    let motion = |motion: &Motion<D>, rate: &Motion<D>| Motion {
        displacement: sum(&motion.displacement, &rate.displacement),
        velocity: sum(&motion.velocity, &rate.velocity),
    };
    LapState {
        a: motion(&state.a, &rate.a),
        b: motion(&state.b, &rate.b),
    }
}

#[cfg(test)]
mod tests;
