//! The lap model of Pirdayr, with rotation where the joint has it: two supported bodies and the joint between them.

use crate::joint::{JointLaw, Motion};

/// One side of the lap: a rigid body on its own support.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Body<const D: usize> {
    /// Mass in kg, moment of inertia in kg·m².
    pub inertia: [f64; D],
    /// Support stiffness in N/m, N·m/rad.
    pub stiffness: [f64; D],
    /// Support damping in N·s/m, N·m·s/rad.
    pub damping: [f64; D],
}

/// Two bodies and the joint between them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lap<const D: usize> {
    /// Law of the joint between the bodies.
    pub joint: JointLaw<D>,
    /// Body on side a.
    pub a: Body<D>,
    /// Body on side b.
    pub b: Body<D>,
}

/// State of the lap model: motion of both bodies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LapState<const D: usize> {
    /// Motion of body a.
    pub a: Motion<D>,
    /// Motion of body b.
    pub b: Motion<D>,
}

impl<const D: usize> LapState<D> {
    /// Both bodies at rest in the origin.
    pub const REST: Self = Self {
        a: Motion::REST,
        b: Motion::REST,
    };
}

/// External loads on the two bodies, N and N·m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LapLoads<const D: usize> {
    /// Load on body a.
    pub a: [f64; D],
    /// Load on body b.
    pub b: [f64; D],
}

/// Which entry of a lap model cannot be integrated, and why.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Defect {
    /// An inertia (body "a" or "b", DOF index, value in kg or kg·m²) is not positive and finite.
    Inertia {
        /// `true` for body a, `false` for body b.
        on_a: bool,
        /// Index of the DOF.
        dof: usize,
        /// Value found, kg or kg·m².
        value: f64,
    },
    /// A coefficient of a spring or damper is NaN or infinite.
    NotFinite,
}

impl<const D: usize> Lap<D> {
    /// What keeps the model from being integrated, if anything.
    #[must_use]
    pub fn defect(&self) -> Option<Defect> {
        for (on_a, body) in [(true, &self.a), (false, &self.b)] {
            for (dof, &value) in body.inertia.iter().enumerate() {
                if !(value.is_finite() && value > 0.0) {
                    return Some(Defect::Inertia { on_a, dof, value });
                }
            }
        }
        let coefficients = self
            .joint
            .stiffness
            .iter()
            .chain(&self.joint.damping)
            .flatten();
        let higher = &self.joint.higher;
        let bodies = [&self.a, &self.b];
        let supports = bodies
            .iter()
            .flat_map(|body| body.stiffness.iter().chain(&body.damping));
        let finite = coefficients
            .chain(&self.joint.cubic)
            .chain(&higher.quintic)
            .chain(&higher.septic)
            .chain(&higher.damping_quadratic)
            .chain(&higher.damping_quartic)
            .chain(supports)
            .all(|value| value.is_finite());
        (!finite).then_some(Defect::NotFinite)
    }

    /// Kinetic energy of the bodies and potential energy of their supports and of the joint, J.
    #[inline]
    #[must_use]
    pub fn stored_energy(&self, state: &LapState<D>) -> f64 {
        let relative = state.a.relative_to(&state.b);
        body_energy(&self.a, &state.a)
            + body_energy(&self.b, &state.b)
            + self.joint.stored_energy(&relative.displacement)
    }

    /// Power that the dampers of the joint and of the supports turn into heat, W.
    #[inline]
    #[must_use]
    pub fn dissipated_power(&self, state: &LapState<D>) -> f64 {
        let relative = state.a.relative_to(&state.b);
        body_dissipation(&self.a, &state.a)
            + body_dissipation(&self.b, &state.b)
            + self.joint.dissipated_power(&relative)
    }
}

fn body_energy<const D: usize>(body: &Body<D>, motion: &Motion<D>) -> f64 {
    // E = ½ Σ (mᵢ ẋᵢ² + kᵢ xᵢ²)
    let mut energy = 0.0;
    for i in 0..D {
        let (x, v) = (motion.displacement[i], motion.velocity[i]);
        energy += 0.5 * (body.inertia[i] * v * v + body.stiffness[i] * x * x);
    }
    energy
}

fn body_dissipation<const D: usize>(body: &Body<D>, motion: &Motion<D>) -> f64 {
    // P = Σ cᵢ ẋᵢ²
    let mut power = 0.0;
    for i in 0..D {
        power += body.damping[i] * motion.velocity[i] * motion.velocity[i];
    }
    power
}
