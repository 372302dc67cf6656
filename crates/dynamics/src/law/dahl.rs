//! Dahl's law (1968): a slider whose stiffness falls evenly with its load, from all of it to none at the slip force.

use super::{
    Corner, Law,
    declaration::{Declaration, Outside, Parameter, Remembered, RememberedAs, is_positive},
    flow::{Flow, HIDDEN, release_all},
    slider_parameters::{SLIP_FORCE, STIFFNESS},
};
use crate::number::Number;

/// A slider on one relative DOF that flows from the first load on: dF/dx = σ₀ (1 − F sgn ẋ/F_c).
///
/// ```
/// use bolted_joint_dynamics::law::{Dahl, Law};
///
/// let law = Dahl { stiffness: 1e5, slip_force: 2.0 };
/// // F = F_c (1 − e^(−σ₀ x/F_c)) on the first way
/// let load = law.load(&[0.0; 3], 2e-5, 0.0);
/// assert!((load - 2.0 * (1.0 - (-1.0_f64).exp())).abs() < 1e-15);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dahl<N = f64> {
    /// σ₀: N/m, N·m/rad.
    pub stiffness: N,
    /// F_c: N, N·m.
    pub slip_force: N,
}

impl<N: Number> Dahl<N> {
    /// Its slider; `None` where it gives no load.
    fn flow(&self) -> Option<Flow<N>> {
        let is_there = self.stiffness.value() > 0.0 && self.slip_force.value() > 0.0;
        is_there.then_some(Flow {
            stiffness: self.stiffness,
            limit: self.slip_force,
            sharpness: N::ZERO,
        })
    }
}

impl<N: Number> Law<N> for Dahl<N> {
    const DECLARATION: Declaration = Declaration {
        name: "dahl",
        summary: "A slider whose stiffness falls with its load, after Dahl",
        parameters: &[
            Parameter {
                symbol: "dahl_k",
                description: "Stiffness of the joint's Dahl law in {motion} at no load",
                ..STIFFNESS
            },
            Parameter {
                symbol: "dahl_h",
                description: "Load at which the joint's Dahl law slips in {motion}",
                ..SLIP_FORCE
            },
        ],
        memory: &[Remembered {
            symbol: "dahl_p",
            quantity: RememberedAs::Load,
            description: "{Load} of the joint's Dahl law in {motion}, as of the last step",
            rate: None,
        }],
        hidden_memory: HIDDEN,
        at_most: 2,
        number: 1,
    };

    by_numbers!(stiffness, slip_force);

    fn load<M: Number + Into<N>>(&self, memory: &[M], r: N, _: N) -> N {
        self.flow().map_or(N::ZERO, |flow| flow.load(memory, r))
    }

    fn stored_energy<M: Number + Into<N>>(&self, memory: &[M], r: N) -> N {
        self.flow()
            .map_or(N::ZERO, |flow| flow.stored_energy(memory, r))
    }

    fn energy_in<M: Number + Into<N>>(&self, springs: &Self, memory: &[M], r: N) -> N {
        self.flow()
            .map_or(N::ZERO, |flow| flow.energy_in(springs.stiffness, memory, r))
    }

    fn dissipated_power<M: Number + Into<N>>(&self, memory: &[M], r: N, velocity: N) -> N {
        self.flow()
            .map_or(N::ZERO, |flow| flow.dissipated_power(memory, r, velocity))
    }

    fn commit(&self, memory: &mut [N], r: N, _: N) -> f64 {
        match self.flow() {
            _ if !r.is_finite() => 0.0,
            Some(flow) => flow.commit(memory, r),
            None => release_all(memory, self.stiffness, r),
        }
    }

    fn corners(&self, memory: &[f64], to: f64, tell: &mut dyn FnMut(Corner)) {
        if let Some(flow) = self.flow() {
            tell(flow.corner(memory, to));
        }
    }

    fn outside(&self) -> Option<Outside> {
        let values = [self.stiffness, self.slip_force].map(Number::value);
        let parameter = values.iter().position(|&value| !is_positive(value))?;
        Outside::at(parameter, "a number above 0")
    }

    fn nonlinear_amplitude(&self, _: f64, _: f64) -> f64 {
        self.slip_force.value() / self.stiffness.value()
    }
}

#[cfg(test)]
mod tests;
