//! The LuGre law (Canudas de Wit, Olsson, Åström, Lischinsky 1995): bristles that bend and slip, with a slip force that
//! falls with the velocity from that of rest to that of sliding (Stribeck).
//!
//! ż = v − σ₀ |v| z/g(v), F = σ₀ z + σ₁ ż + σ₂ v, g = F_c + (F_s − F_c) e^(−(v/v_s)²). Over a way at constant velocity
//! the deflection z relaxes exponentially, which is taken at the mean of the velocities at its ends: however stiff the
//! bristles are, no step is too long for them.

use super::{
    Law,
    declaration::{
        Declaration, Outside, Parameter, Quantity, RateOf, Remembered, RememberedAs, UnitRule,
        is_positive,
    },
    slider_parameters::{SLIP_FORCE, STIFFNESS},
};
use crate::number::Number;

/// Places of what is remembered: the deflection, and beside what is a variable the place and the velocity.
const DEFLECTION: usize = 0;
const PLACE: usize = 1;
const VELOCITY: usize = 2;

const DAMPER: Parameter = Parameter {
    unit: UnitRule::LoadPer {
        displacement: 1,
        seconds: 1,
    },
    quantity: Quantity {
        name: "SliderDamping",
        nominal: [10.0, 1.0, 0.1],
        start: [0.0; 3],
    },
    ..STIFFNESS
};

/// Part of the largest deflection of the bristles by which rounding may take them beyond it.
const ROUNDING: f64 = 1e-12;

/// Bristles on one relative DOF.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LuGre<N = f64> {
    /// σ₀ of the bristles: N/m, N·m/rad.
    pub stiffness: N,
    /// σ₁ of the bristles: N·s/m, N·m·s/rad.
    pub bristle_damping: N,
    /// σ₂ beside the bristles: N·s/m, N·m·s/rad. The law takes energy where it is at least σ₁ (F_s − F_c)/F_c.
    pub damping: N,
    /// F_c in fast sliding: N, N·m.
    pub slip_force: N,
    /// F_s ≥ F_c in slow sliding: N, N·m.
    pub static_force: N,
    /// v_s, at which the slip force has fallen to F_c + (F_s − F_c)/e: m/s, rad/s.
    pub stribeck_velocity: N,
}

/// A way of the bristles at constant velocity.
struct Way<N> {
    /// Slip force at that velocity.
    slip_force: N,
    /// Part of the bend of steady sliding that is missing where it begins and where it ends, in its direction.
    missing: [N; 2],
    /// Deflection at its end.
    deflection: N,
}

impl<N: Number> LuGre<N> {
    fn parameters(&self) -> [N; 6] {
        [
            self.stiffness,
            self.bristle_damping,
            self.damping,
            self.slip_force,
            self.static_force,
            self.stribeck_velocity,
        ]
    }

    fn is_there(&self) -> bool {
        self.stiffness.value() > 0.0
            && self.slip_force.value() > 0.0
            && self.stribeck_velocity.value() > 0.0
    }

    /// g(v) = F_c + (F_s − F_c) e^(−(v/v_s)²)
    fn slip_force(&self, velocity: N) -> N {
        let part = velocity / self.stribeck_velocity;
        self.slip_force + (self.static_force - self.slip_force) * (-(part * part)).exp()
    }

    /// What the bristles can hold of a deflection: that of F_s/σ₀ at the most, if that was lowered meanwhile.
    fn held(&self, deflection: N) -> N {
        let limit = self.static_force / self.stiffness;
        match deflection.value() {
            z if z > limit.value() * (1.0 + ROUNDING) => limit,
            z if z < -limit.value() * (1.0 + ROUNDING) => -limit,
            _ => deflection,
        }
    }

    /// Heat of what they can no longer hold, J: ½ σ₀ z² of before less that of now.
    fn heat_of_release(&self, deflection: N) -> f64 {
        let held = match self.is_there() {
            true => self.held(deflection),
            false => N::ZERO,
        };
        let half = N::from(0.5) * self.stiffness;
        (half * (deflection - held) * (deflection + held)).value()
    }

    /// The way from the memory's place to r, where this velocity is reached.
    fn way<M: Number + Into<N>>(&self, memory: &[M], r: N, velocity: N) -> Way<N> {
        let number = |place: usize| memory.get(place).map_or(N::ZERO, |&number| number.into());
        let way = r - number(PLACE);
        let sign = N::from(if way.value() < 0.0 { -1.0 } else { 1.0 });
        let mean = mean_velocity(memory, velocity);
        let slip_force = self.slip_force(mean);
        // dz/dx = 1 − s σ₀ z/g: with y = 1 − s σ₀ z/g, y' = y e^(−σ₀|Δx|/g)
        let steady = slip_force / self.stiffness;
        let start = self.held(number(DEFLECTION));
        let before = N::from(1.0) - sign * start / steady;
        let gone = -(before * (-(sign * way / steady)).exp_m1());
        Way {
            slip_force,
            missing: [before, before - gone],
            deflection: start + sign * steady * gone,
        }
    }

    /// ż = v − σ₀ |v| z/g(v)
    fn rate(&self, deflection: N, velocity: N) -> N {
        let speed = N::from(velocity.value().signum()) * velocity;
        velocity - self.stiffness * speed * deflection / self.slip_force(velocity)
    }
}

impl<N: Number> Law<N> for LuGre<N> {
    const DECLARATION: Declaration = Declaration {
        name: "lugre",
        summary: "Bristles that bend and slip, with a slip force that falls with the velocity",
        parameters: &[
            Parameter {
                symbol: "lugre_s0",
                description: "Stiffness of the bristles in the joint's LuGre law in {motion}",
                ..STIFFNESS
            },
            Parameter {
                symbol: "lugre_s1",
                key: "bristle_damping",
                description: "Damping of the bristles in the joint's LuGre law in {motion}",
                ..DAMPER
            },
            Parameter {
                symbol: "lugre_s2",
                key: "damping",
                description: "Damping beside the bristles in the joint's LuGre law in {motion}",
                ..DAMPER
            },
            Parameter {
                symbol: "lugre_fc",
                key: "slip_force",
                description: "Load at which the bristles of the joint's LuGre law slip in fast {motion}",
                ..SLIP_FORCE
            },
            Parameter {
                symbol: "lugre_fs",
                key: "static_force",
                description: "Load at which the bristles of the joint's LuGre law slip in slow {motion}",
                ..SLIP_FORCE
            },
            Parameter {
                symbol: "lugre_vs",
                key: "stribeck_velocity",
                unit: UnitRule::Rate,
                quantity: Quantity {
                    name: "StribeckVelocity",
                    nominal: [1e-3, 1e-2, 1e-2],
                    start: [0.0; 3],
                },
                description: "Relative {rate} at which the slip force of the joint's LuGre law falls from its static value",
                ..STIFFNESS
            },
        ],
        memory: &[Remembered {
            symbol: "lugre_z",
            quantity: RememberedAs::Displacement,
            description: "Deflection of the bristles in the joint's LuGre law in {motion}; in Co-Simulation as of the last step",
            rate: Some(RateOf {
                symbol: "lugre_zdot",
                description: "{Rate} at which the bristles in the joint's LuGre law bend in {motion}",
            }),
        }],
        hidden_memory: 2,
        at_most: 2,
        number: 1,
    };

    by_numbers!(
        stiffness,
        bristle_damping,
        damping,
        slip_force,
        static_force,
        stribeck_velocity
    );

    fn load<M: Number + Into<N>>(&self, memory: &[M], r: N, velocity: N) -> N {
        if !self.is_there() {
            return N::ZERO;
        }
        // F = σ₀ z + σ₁ ż + σ₂ v
        let deflection = self.way(memory, r, velocity).deflection;
        self.stiffness * deflection
            + self.bristle_damping * self.rate(deflection, velocity)
            + self.damping * velocity
    }

    fn stored_energy<M: Number + Into<N>>(&self, memory: &[M], r: N) -> N {
        if !self.is_there() {
            return N::ZERO;
        }
        // ½ σ₀ z², at the velocity of the last step: the energy is a function of places alone
        let velocity = memory.get(VELOCITY).map_or(N::ZERO, |&rate| rate.into());
        let deflection = self.way(memory, r, velocity).deflection;
        N::from(0.5) * self.stiffness * deflection * deflection
    }

    fn energy_in<M: Number + Into<N>>(&self, springs: &Self, memory: &[M], r: N) -> N {
        if !self.is_there() {
            return N::ZERO;
        }
        let velocity = memory.get(VELOCITY).map_or(N::ZERO, |&rate| rate.into());
        let deflection = self.way(memory, r, velocity).deflection;
        N::from(0.5) * springs.stiffness * deflection * deflection
    }

    fn dissipated_power<M: Number + Into<N>>(&self, memory: &[M], r: N, velocity: N) -> N {
        if !self.is_there() {
            return N::ZERO;
        }
        // P = F v − σ₀ z ż = σ₀² z² |v|/g + σ₁ v ż + σ₂ v²
        let deflection = self.way(memory, r, velocity).deflection;
        let load = self.stiffness * deflection;
        let speed = N::from(velocity.value().signum()) * velocity;
        load * load * speed / self.slip_force(velocity)
            + self.bristle_damping * velocity * self.rate(deflection, velocity)
            + self.damping * velocity * velocity
    }

    fn commit(&self, memory: &mut [N], r: N, velocity: N) -> f64 {
        if memory.len() <= VELOCITY || !(r + velocity).is_finite() {
            return 0.0;
        }
        let released = self.heat_of_release(memory[DEFLECTION]);
        if !self.is_there() {
            // nothing presses
            memory.copy_from_slice(&[N::ZERO, r, velocity]);
            return released;
        }
        let way = self.way(memory, r, velocity);
        let length = (r - memory[PLACE]).value().abs();
        let speed = mean_velocity::<N, N>(memory, velocity).value().abs();
        let [before, after] = way.missing.map(Number::value);
        let slip_force = way.slip_force.value();
        let [stiffness, bristle_damping, damping, ..] = self.parameters().map(Number::value);
        let (steady, gone) = (slip_force / stiffness, before - after);
        // ∫ g ζ² dx with ζ = 1 − y
        let slipped = slip_force * (length - steady * gone * (2.0 - 0.5 * (before + after)));
        // |v| ∫ (σ₁ (1−ζ) + σ₂) dx
        let damped = speed * (bristle_damping * steady * gone + damping * length);
        memory[DEFLECTION] = way.deflection;
        memory[PLACE] = r;
        memory[VELOCITY] = velocity;
        // rounding apart, no way gives heat back
        released + (slipped + damped).max(0.0)
    }

    fn settle(&self, memory: &mut [N], r: N, velocity: N) {
        if memory.len() > VELOCITY {
            memory[PLACE] = r;
            memory[VELOCITY] = velocity;
        }
    }

    fn inner_rate(&self, memory: &[N], velocity: N) -> N {
        match memory.get(DEFLECTION) {
            Some(&deflection) if self.is_there() => self.rate(deflection, velocity),
            _ => N::ZERO,
        }
    }

    fn outside(&self) -> Option<Outside> {
        let [
            stiffness,
            bristle_damping,
            damping,
            slip_force,
            static_force,
            velocity,
        ] = self.parameters().map(Number::value);
        let is_damper = |value: f64| value >= 0.0 && value.is_finite();
        // Barabanov and Ortega, IEEE Trans. Autom. Control 45 (2000) 830
        let least = bristle_damping * (static_force - slip_force) / slip_force;
        match () {
            () if !is_positive(stiffness) => Outside::at(0, "a number above 0"),
            () if !is_damper(bristle_damping) => Outside::at(1, "zero or more"),
            () if !is_damper(damping) => Outside::at(2, "zero or more"),
            () if !is_positive(slip_force) => Outside::at(3, "a number above 0"),
            () if !(static_force >= slip_force && static_force.is_finite()) => {
                Outside::at(4, format!("{slip_force:?}, the slip force, or more"))
            }
            () if !is_positive(velocity) => Outside::at(5, "a number above 0"),
            // written so that rounding does not refuse the bound itself
            () if damping < least * (1.0 - 4.0 * f64::EPSILON) => Outside::at(
                2,
                format!(
                    "{least:?} or more, the bristles' damping times (static force - slip force)/slip force: below that the \
                     law gives energy"
                ),
            ),
            () => None,
        }
    }

    fn outside_towards(&self, other: &Self) -> Option<(f64, Outside)> {
        let [from, to] = [self, other].map(|law| law.parameters().map(Number::value));
        let at = |share: f64| {
            let own: [N; 6] =
                std::array::from_fn(|k| N::from((1.0 - share) * from[k] + share * to[k]));
            Self::new(&own)
        };
        // q = σ₂ F_c − σ₁ (F_s − F_c) is a parabola over the share, convex where it can be less between than at the ends
        let q = |share: f64| {
            let [_, s1, s2, fc, fs, _] = at(share).parameters().map(Number::value);
            s2 * fc - s1 * (fs - fc)
        };
        let (first, middle, last) = (q(0.0), q(0.5), q(1.0));
        let curvature = 2.0 * (first - 2.0 * middle + last);
        let share = 0.5 - 0.5 * (last - first) / curvature;
        if !(curvature > 0.0 && share > 0.0 && share < 1.0) {
            return None;
        }
        at(share).outside().map(|outside| (share, outside))
    }

    fn nonlinear_amplitude(&self, _: f64, _: f64) -> f64 {
        // the bristles slip from F_c/σ₀ on
        self.slip_force.value() / self.stiffness.value()
    }
}

/// Velocity of the way from the memory's place to where this one is reached. How the joint came to its first place is
/// not known: slowly.
fn mean_velocity<N: Number, M: Number + Into<N>>(memory: &[M], velocity: N) -> N {
    if memory.iter().all(|&number| number.value() == 0.0) {
        return N::ZERO;
    }
    let before = memory.get(VELOCITY).map_or(N::ZERO, |&rate| rate.into());
    N::from(0.5) * (velocity + before)
}

#[cfg(test)]
mod tests;
