//! The lap model of Pirdayr, with rotation where the joint has it: two supported bodies and the joint between them.

use crate::{
    law::{JointLaw, JointMemory},
    motion::{Motion, changed},
    number::{Dual, Number},
};

/// One side of the lap: a rigid body on its own support.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Body<const D: usize, N = f64> {
    /// Mass in kg, moment of inertia in kg·m².
    pub inertia: [N; D],
    /// Support stiffness in N/m, N·m/rad.
    pub stiffness: [N; D],
    /// Support damping in N·s/m, N·m·s/rad.
    pub damping: [N; D],
}

/// Two bodies and the joint between them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lap<const D: usize, N = f64> {
    /// Law of the joint between the bodies.
    pub joint: JointLaw<D, N>,
    /// Body on side a.
    pub a: Body<D, N>,
    /// Body on side b.
    pub b: Body<D, N>,
}

/// State of the lap model: motion of both bodies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LapState<const D: usize, N = f64> {
    /// Motion of body a.
    pub a: Motion<D, N>,
    /// Motion of body b.
    pub b: Motion<D, N>,
}

/// External loads on the two bodies, N and N·m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LapLoads<const D: usize, N = f64> {
    /// Load on body a.
    pub a: [N; D],
    /// Load on body b.
    pub b: [N; D],
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

impl<const D: usize, N: Number> LapState<D, N> {
    /// Both bodies at rest in the origin.
    pub const REST: Self = Self {
        a: Motion::REST,
        b: Motion::REST,
    };

    /// Motion of body a as seen from body b.
    #[inline]
    #[must_use]
    pub fn relative(&self) -> Motion<D, N> {
        self.a.relative_to(&self.b)
    }
}

impl<const D: usize, N: Number> Body<D, N> {
    /// E = ½ Σ (mᵢ ẋᵢ² + kᵢ xᵢ²)
    #[inline]
    fn energy(&self, motion: &Motion<D, N>) -> N {
        let half = N::from(0.5);
        (0..D).fold(N::ZERO, |energy, i| {
            let (x, v) = (motion.displacement[i], motion.velocity[i]);
            energy + half * (self.inertia[i] * v * v + self.stiffness[i] * x * x)
        })
    }

    /// P = Σ cᵢ ẋᵢ²
    #[inline]
    fn dissipation(&self, motion: &Motion<D, N>) -> N {
        (0..D).fold(N::ZERO, |power, i| {
            power + self.damping[i] * motion.velocity[i] * motion.velocity[i]
        })
    }

    /// m ẍ = F − k x − c ẋ + F_joint
    #[inline]
    fn acceleration(&self, motion: &Motion<D, N>, load: &[N; D], of_joint: &[N; D]) -> [N; D] {
        std::array::from_fn(|i| {
            let held =
                self.stiffness[i] * motion.displacement[i] + self.damping[i] * motion.velocity[i];
            (load[i] - held + of_joint[i]) / self.inertia[i]
        })
    }
}

impl<const D: usize, N: Number> Lap<D, N> {
    /// Kinetic energy of the bodies and potential energy of their supports and of the joint, J.
    #[inline]
    #[must_use]
    pub fn stored_energy<M: Number + Into<N>>(
        &self,
        memory: &JointMemory<D, M>,
        state: &LapState<D, N>,
    ) -> N {
        let relative = state.relative();
        self.a.energy(&state.a)
            + self.b.energy(&state.b)
            + self
                .joint
                .stored_energy_after(memory, &relative.displacement)
    }

    /// Power that joint and supports turn into heat, W.
    #[inline]
    #[must_use]
    pub fn dissipated_power<M: Number + Into<N>>(
        &self,
        memory: &JointMemory<D, M>,
        state: &LapState<D, N>,
    ) -> N {
        self.a.dissipation(&state.a)
            + self.b.dissipation(&state.b)
            + self.joint.dissipated_power_after(memory, &state.relative())
    }

    /// Power that the dampers of joint and supports turn into heat, W, as [`JointLaw::viscous_power`].
    #[must_use]
    pub fn viscous_power(&self, state: &LapState<D, N>) -> N {
        self.a.dissipation(&state.a)
            + self.b.dissipation(&state.b)
            + self.joint.viscous_power(&state.relative())
    }

    /// Accelerations of body a and of body b: m/s², rad/s².
    #[must_use]
    pub fn accelerations<M: Number + Into<N>>(
        &self,
        memory: &JointMemory<D, M>,
        state: &LapState<D, N>,
        loads: &LapLoads<D, N>,
    ) -> [[N; D]; 2] {
        // m_a ẍ_a = F_a − k_a x_a − c_a ẋ_a − F_joint, m_b ẍ_b = F_b − k_b x_b − c_b ẋ_b + F_joint
        let on_b = self.joint.load_on_b_after(memory, &state.relative());
        [
            self.a
                .acceleration(&state.a, &loads.a, &on_b.map(|load| -load)),
            self.b.acceleration(&state.b, &loads.b, &on_b),
        ]
    }
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
        let finite = [&self.a, &self.b]
            .iter()
            .flat_map(|body| body.stiffness.iter().chain(&body.damping))
            .all(|value| value.is_finite());
        (!finite || !self.joint.is_finite()).then_some(Defect::NotFinite)
    }

    /// Whether a support can feed energy: its stiffness or damping on a DOF is negative.
    #[must_use]
    pub fn has_active_support(&self) -> bool {
        [&self.a, &self.b]
            .iter()
            .flat_map(|body| body.stiffness.iter().chain(&body.damping))
            .any(|&coefficient| coefficient < 0.0)
    }

    /// The model with its change along one direction.
    #[must_use]
    pub fn with_change(&self, change: &Self) -> Lap<D, Dual<1>> {
        let body = |body: &Body<D>, change: &Body<D>| Body {
            inertia: changed(&body.inertia, &change.inertia),
            stiffness: changed(&body.stiffness, &change.stiffness),
            damping: changed(&body.damping, &change.damping),
        };
        Lap {
            joint: self.joint.with_change(&change.joint),
            a: body(&self.a, &change.a),
            b: body(&self.b, &change.b),
        }
    }
}

impl<const D: usize> LapState<D> {
    /// The state with its change along one direction.
    #[must_use]
    pub fn with_change(&self, change: &Self) -> LapState<D, Dual<1>> {
        LapState {
            a: self.a.with_change(&change.a),
            b: self.b.with_change(&change.b),
        }
    }
}

impl<const D: usize> LapLoads<D> {
    /// The loads with their change along one direction.
    #[must_use]
    pub fn with_change(&self, change: &Self) -> LapLoads<D, Dual<1>> {
        LapLoads {
            a: changed(&self.a, &change.a),
            b: changed(&self.b, &change.b),
        }
    }
}
