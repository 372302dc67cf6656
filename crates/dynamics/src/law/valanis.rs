//! The law of Valanis (Tol 2.3; Gaul and Nitsche 2001): a spring beside a slider that begins to flow before it slips,
//! so that a loop has round corners. κ sets how round: at 1 it is a Jenkins element beside a spring, at 0 Dahl's law
//! beside one.

use super::{
    Corner, Law,
    declaration::{
        Declaration, Outside, Parameter, Quantity, Remembered, RememberedAs, UnitRule, is_positive,
    },
    flow::{Flow, HIDDEN, release_all},
    slider_parameters::{SLIP_FORCE, STIFFNESS},
};
use crate::number::Number;

/// A spring beside a slider that flows, on one relative DOF.
///
/// ```
/// use bolted_joint_dynamics::law::{Law, Valanis};
///
/// let law = Valanis { stiffness: 1000.0, slip_stiffness: 100.0, slip_force: 5.0, kappa: 1.0 };
/// let mut memory = [0.0; 3];
/// // with κ = 1 a spring of 100 N/m beside one of 900 N/m that slips at 4.5 N
/// assert!((law.load(&memory, 6e-3, 0.0) - 5.1).abs() < 1e-12);
/// assert!((law.commit(&mut memory, 6e-3, 0.0) - 4.5e-3).abs() < 1e-12);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Valanis<N = f64> {
    /// E₀ at small motion: N/m, N·m/rad.
    pub stiffness: N,
    /// E_t after much of it, from 0 to E₀: N/m, N·m/rad.
    pub slip_stiffness: N,
    /// σ₀, at which the line of small motion meets that of much: N, N·m.
    pub slip_force: N,
    /// κ from 0 to 1: how sharply it begins to slip.
    pub kappa: N,
}

impl<N: Number> Valanis<N> {
    fn parameters(&self) -> [N; 4] {
        [
            self.stiffness,
            self.slip_stiffness,
            self.slip_force,
            self.kappa,
        ]
    }

    /// Its slider; `None` where it has none.
    fn flow(&self) -> Option<Flow<N>> {
        // Ḟ = E₀ ẋ (1 + (λ/E₀) s (E_t x − F))/(1 + κ (λ/E₀) s (E_t x − F)) with λ = E₀/(σ₀ (1 − κ E_t/E₀))   (Tol 2.3):
        // with p = F − E_t x it is that of the slider with E₁ = E₀ − E_t, p_m = σ₀ E₁/E₀, c = κ E₁/(E₀ − κ E_t)
        let stiffness = self.stiffness - self.slip_stiffness;
        let is_there = stiffness.value() > 0.0 && self.slip_force.value() > 0.0;
        is_there.then(|| Flow {
            stiffness,
            limit: self.slip_force * stiffness / self.stiffness,
            sharpness: self.kappa * stiffness / (self.stiffness - self.kappa * self.slip_stiffness),
        })
    }
}

impl<N: Number> Law<N> for Valanis<N> {
    const DECLARATION: Declaration = Declaration {
        name: "valanis",
        summary: "A spring beside a slider that begins to flow before it slips, after Valanis",
        parameters: &[
            Parameter {
                symbol: "valanis_e0",
                description: "Stiffness of the joint's Valanis law in {motion} at small motion",
                ..STIFFNESS
            },
            Parameter {
                symbol: "valanis_et",
                key: "slip_stiffness",
                description: "Stiffness of the joint's Valanis law in {motion} while it slips, at most that at small motion",
                ..STIFFNESS
            },
            Parameter {
                symbol: "valanis_s0",
                description: "Load at which the joint's Valanis law turns from sticking to slipping in {motion}",
                ..SLIP_FORCE
            },
            Parameter {
                symbol: "valanis_kappa",
                key: "kappa",
                unit: UnitRule::One,
                quantity: Quantity {
                    name: "Sharpness",
                    nominal: [1.0; 3],
                    start: [0.0; 3],
                },
                description: "How sharply the joint's Valanis law begins to slip in {motion}: 0 softly, 1 at once",
                ..STIFFNESS
            },
        ],
        memory: &[Remembered {
            symbol: "valanis_p",
            quantity: RememberedAs::Load,
            description: "{Load} of the slider in the joint's Valanis law in {motion}, as of the last step",
            rate: None,
        }],
        hidden_memory: HIDDEN,
        at_most: 2,
        number: 1,
    };

    by_numbers!(stiffness, slip_stiffness, slip_force, kappa);

    fn load<M: Number + Into<N>>(&self, memory: &[M], r: N, _: N) -> N {
        // F = E_t x + p
        let slider = self.flow().map_or(N::ZERO, |flow| flow.load(memory, r));
        self.slip_stiffness * r + slider
    }

    fn stored_energy<M: Number + Into<N>>(&self, memory: &[M], r: N) -> N {
        let slider = self
            .flow()
            .map_or(N::ZERO, |flow| flow.stored_energy(memory, r));
        N::from(0.5) * self.slip_stiffness * r * r + slider
    }

    fn energy_in<M: Number + Into<N>>(&self, springs: &Self, memory: &[M], r: N) -> N {
        let slider = self.flow().map_or(N::ZERO, |flow| {
            flow.energy_in(springs.stiffness - springs.slip_stiffness, memory, r)
        });
        N::from(0.5) * springs.slip_stiffness * r * r + slider
    }

    fn dissipated_power<M: Number + Into<N>>(&self, memory: &[M], r: N, velocity: N) -> N {
        self.flow()
            .map_or(N::ZERO, |flow| flow.dissipated_power(memory, r, velocity))
    }

    fn commit(&self, memory: &mut [N], r: N, _: N) -> f64 {
        match self.flow() {
            _ if !r.is_finite() => 0.0,
            Some(flow) => flow.commit(memory, r),
            None => release_all(memory, self.stiffness - self.slip_stiffness, r),
        }
    }

    fn corners(&self, memory: &[f64], to: f64, tell: &mut dyn FnMut(Corner)) {
        if let Some(flow) = self.flow() {
            tell(flow.corner(memory, to));
        }
    }

    fn outside(&self) -> Option<Outside> {
        let [stiffness, slip_stiffness, slip_force, kappa] = self.parameters().map(Number::value);
        match () {
            () if !is_positive(stiffness) => Outside::at(0, "a number above 0"),
            () if !(0.0..=stiffness).contains(&slip_stiffness) => {
                Outside::at(1, format!("0 to {stiffness:?}, the stiffness"))
            }
            () if !is_positive(slip_force) => Outside::at(2, "a number above 0"),
            () if !(0.0..=1.0).contains(&kappa) => Outside::at(3, "0 to 1"),
            () => None,
        }
    }

    fn nonlinear_amplitude(&self, _: f64, _: f64) -> f64 {
        // where the line of small motion meets that of much: σ₀/E₀
        self.slip_force.value() / self.stiffness.value()
    }
}

#[cfg(test)]
mod tests;
