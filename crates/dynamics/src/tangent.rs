//! Exact directional derivatives of what the joint and the lap put out: how each result changes with motion, loads and
//! parameters, to first order.
//!
//! A change of parameters has the type of the parameters themselves, so that each function takes the point and the
//! direction side by side.

use crate::{
    joint::{JointLaw, Motion},
    lap::{Body, Lap, LapLoads, LapState},
    vector::{dot, product},
};

impl<const D: usize> JointLaw<D> {
    /// Change of [`JointLaw::load_on_b`] with the law and the relative motion.
    #[must_use]
    pub fn load_on_b_tangent(
        &self,
        law_change: &Self,
        relative: &Motion<D>,
        relative_change: &Motion<D>,
    ) -> [f64; D] {
        // dF = dK r + K dr + dC ṙ + C dṙ + dk3 ∘ r³ + 3 k3 ∘ r² ∘ dr, and the same of the terms of higher order
        let by_law = law_change.load_on_b(relative);
        let elastic = product(&self.stiffness, &relative_change.displacement);
        let viscous = product(&self.damping, &relative_change.velocity);
        let change = std::array::from_fn(|i| {
            let r = relative.displacement[i];
            let cubic = 3.0 * self.cubic[i] * r * r * relative_change.displacement[i];
            by_law[i] + elastic[i] + viscous[i] + cubic
        });
        if self.higher.are_none() {
            return change;
        }
        std::array::from_fn(|i| {
            let (r, velocity) = (relative.displacement[i], relative.velocity[i]);
            let spring = self.higher.tangent_stiffness(i, r, velocity);
            let damper = self.higher.damping(i, r);
            change[i]
                + spring * relative_change.displacement[i]
                + damper * relative_change.velocity[i]
        })
    }

    /// Change of [`JointLaw::stored_energy`] with the law and the relative displacement.
    #[must_use]
    pub fn stored_energy_tangent(
        &self,
        law_change: &Self,
        r: &[f64; D],
        displacement_change: &[f64; D],
    ) -> f64 {
        // dU = dU/dlaw + drᵀ(K r + k3 ∘ r³ + k5 ∘ r⁵ + k7 ∘ r⁷), K symmetric: the springs' load at rest
        let at_rest = Motion {
            displacement: *r,
            velocity: [0.0; D],
        };
        law_change.stored_energy(r) + dot(displacement_change, &self.load_on_b(&at_rest))
    }

    /// Change of [`JointLaw::dissipated_power`] with the law and the relative motion.
    #[must_use]
    pub fn dissipated_power_tangent(
        &self,
        law_change: &Self,
        relative: &Motion<D>,
        relative_change: &Motion<D>,
    ) -> f64 {
        // dP = ṙᵀ dC ṙ + 2 dṙᵀC ṙ, C symmetric
        let (velocity, velocity_change) = (&relative.velocity, &relative_change.velocity);
        let change = law_change.dissipated_power(relative)
            + 2.0 * dot(velocity_change, &product(&self.damping, velocity));
        if self.higher.are_none() {
            return change;
        }
        // and Σ c(r) 2 ṙ dṙ + c'(r) ṙ² dr with c(r) = c2 r² + c4 r⁴
        (0..D).fold(change, |sum, i| {
            let (r, v) = (relative.displacement[i], velocity[i]);
            sum + 2.0 * self.higher.damping(i, r) * v * velocity_change[i]
                + self.higher.tangent_damping(i, r) * v * v * relative_change.displacement[i]
        })
    }
}

impl<const D: usize> Lap<D> {
    /// Change of [`Lap::stored_energy`] with the parameters and the state.
    #[must_use]
    pub fn stored_energy_tangent(
        &self,
        lap_change: &Self,
        state: &LapState<D>,
        state_change: &LapState<D>,
    ) -> f64 {
        // dE = ½ Σ (dm ẋ² + dk x²) + Σ (m ẋ dẋ + k x dx) + dU
        let of_body = |body: &Body<D>, motion: &Motion<D>, change: &Motion<D>| {
            (0..D).fold(0.0, |sum, i| {
                sum + body.inertia[i] * motion.velocity[i] * change.velocity[i]
                    + body.stiffness[i] * motion.displacement[i] * change.displacement[i]
            })
        };
        let [relative, relative_change] = [state, state_change].map(|x| x.a.relative_to(&x.b));
        // the energy is linear in the bodies' parameters: with their change in place of them it is its own change
        let by_bodies = Self {
            joint: JointLaw::NONE,
            ..*lap_change
        };
        by_bodies.stored_energy(state)
            + of_body(&self.a, &state.a, &state_change.a)
            + of_body(&self.b, &state.b, &state_change.b)
            + self.joint.stored_energy_tangent(
                &lap_change.joint,
                &relative.displacement,
                &relative_change.displacement,
            )
    }

    /// Change of [`Lap::dissipated_power`] with the parameters and the state.
    #[must_use]
    pub fn dissipated_power_tangent(
        &self,
        lap_change: &Self,
        state: &LapState<D>,
        state_change: &LapState<D>,
    ) -> f64 {
        // dP = Σ dc ẋ² + 2 Σ c ẋ dẋ + dP_joint
        let of_body = |body: &Body<D>, motion: &Motion<D>, change: &Motion<D>| {
            (0..D).fold(0.0, |sum, i| {
                sum + 2.0 * body.damping[i] * motion.velocity[i] * change.velocity[i]
            })
        };
        let [relative, relative_change] = [state, state_change].map(|x| x.a.relative_to(&x.b));
        let by_bodies = Self {
            joint: JointLaw::NONE,
            ..*lap_change
        };
        by_bodies.dissipated_power(state)
            + of_body(&self.a, &state.a, &state_change.a)
            + of_body(&self.b, &state.b, &state_change.b)
            + self
                .joint
                .dissipated_power_tangent(&lap_change.joint, &relative, &relative_change)
    }

    /// Accelerations of body a and of body b: m/s², rad/s².
    #[must_use]
    pub fn accelerations(&self, state: &LapState<D>, loads: &LapLoads<D>) -> [[f64; D]; 2] {
        let on_b = self.joint.load_on_b(&state.a.relative_to(&state.b));
        // m_a ẍ_a = F_a − k_a x_a − c_a ẋ_a − F_joint, m_b ẍ_b = F_b − k_b x_b − c_b ẋ_b + F_joint
        let of_body = |body: &Body<D>, motion: &Motion<D>, load: &[f64; D], sign: f64| {
            let held = support(body, motion);
            std::array::from_fn(|i| (load[i] - held[i] + sign * on_b[i]) / body.inertia[i])
        };
        [
            of_body(&self.a, &state.a, &loads.a, -1.0),
            of_body(&self.b, &state.b, &loads.b, 1.0),
        ]
    }

    /// Change of [`Lap::accelerations`] with the parameters, the state and the loads.
    #[must_use]
    pub fn accelerations_tangent(
        &self,
        lap_change: &Self,
        [state, state_change]: [&LapState<D>; 2],
        [loads, loads_change]: [&LapLoads<D>; 2],
    ) -> [[f64; D]; 2] {
        let [relative, relative_change] = [state, state_change].map(|x| x.a.relative_to(&x.b));
        let on_b = self
            .joint
            .load_on_b_tangent(&lap_change.joint, &relative, &relative_change);
        let [of_a, of_b] = self.accelerations(state, loads);
        // m dẍ = dF − d(k x + c ẋ) ∓ dF_joint − dm ẍ
        let of_body = |bodies: [&Body<D>; 2],
                       motions: [&Motion<D>; 2],
                       load_change: &[f64; D],
                       sign: f64,
                       acceleration: &[f64; D]| {
            let [body, body_change] = bodies;
            let [motion, motion_change] = motions;
            let (by_body, by_motion) = (support(body_change, motion), support(body, motion_change));
            std::array::from_fn(|i| {
                let force = load_change[i] - by_body[i] - by_motion[i] + sign * on_b[i];
                (force - body_change.inertia[i] * acceleration[i]) / body.inertia[i]
            })
        };
        [
            of_body(
                [&self.a, &lap_change.a],
                [&state.a, &state_change.a],
                &loads_change.a,
                -1.0,
                &of_a,
            ),
            of_body(
                [&self.b, &lap_change.b],
                [&state.b, &state_change.b],
                &loads_change.b,
                1.0,
                &of_b,
            ),
        ]
    }
}

/// Load that the support takes: k x + c ẋ.
fn support<const D: usize>(body: &Body<D>, motion: &Motion<D>) -> [f64; D] {
    std::array::from_fn(|i| {
        body.stiffness[i] * motion.displacement[i] + body.damping[i] * motion.velocity[i]
    })
}
