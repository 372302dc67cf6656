//! The Bouc–Wen law (Bouc 1967, Wen 1976), in its passive range (Erlicher and Point 2004).
//!
//! Its load is F = F_y w, and w follows dw/dx = 1 − (β s sgn w + γ) |w|ⁿ over x = k u/F_y, with s = sgn u̇: a function
//! of load and direction alone. So a way of any length is one step, by the integrals of [`integral`].

mod integral;

use super::{
    Corner, Law,
    declaration::{
        Declaration, Outside, Parameter, Quantity, Range, RateOf, Remembered, RememberedAs,
        UnitRule, is_positive,
    },
    flow,
    slider_parameters::{SLIP_FORCE, STIFFNESS},
};
use crate::number::Number;
use integral::Branch;

/// Places of what is remembered: the load, and beside what is a variable the place and the direction of the latest
/// motion.
const LOAD: usize = 0;
const PLACE: usize = 1;
const DIRECTION: usize = 2;

const NUMBER: Parameter = Parameter {
    unit: UnitRule::One,
    quantity: Quantity {
        name: "HysteresisExponent",
        nominal: [1.0; 3],
        start: [0.0; 3],
    },
    ..STIFFNESS
};

/// A hysteretic spring on one relative DOF.
///
/// ```
/// use bolted_joint_dynamics::law::{BoucWen, Law};
///
/// let law = BoucWen { stiffness: 2.0, slip_force: 3.0, exponent: 1.0, beta: 0.6, gamma: 0.4 };
/// // with n = 1 the first way is F_y/(β+γ) (1 − e^(−(β+γ) k u/F_y))
/// let load = law.load(&[0.0; 3], 1.5, 0.0);
/// assert!((load - 3.0 * (1.0 - (-1.0_f64).exp())).abs() < 1e-14);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoucWen<N = f64> {
    /// k at no load: N/m, N·m/rad.
    pub stiffness: N,
    /// F_y, the load of much motion where β + γ = 1; it is F_y (β+γ)^(−1/n) else: N, N·m.
    pub slip_force: N,
    /// n ≥ 1: how sharply it begins to slip.
    pub exponent: N,
    /// β > 0.
    pub beta: N,
    /// γ from −β to β.
    pub gamma: N,
}

impl<N: Number> BoucWen<N> {
    fn parameters(&self) -> [N; 5] {
        [
            self.stiffness,
            self.slip_force,
            self.exponent,
            self.beta,
            self.gamma,
        ]
    }

    fn is_there(&self) -> bool {
        let [stiffness, slip_force, exponent, beta, gamma] = self.parameters().map(Number::value);
        stiffness > 0.0 && slip_force > 0.0 && exponent >= 1.0 && beta >= gamma.abs()
    }

    /// (β+γ)^(−1/n), which |w| approaches; `None` where it has no limit.
    fn limit(&self) -> Option<N> {
        let sum = self.beta + self.gamma;
        (sum.value() > 0.0).then(|| sum.powf(-(N::from(1.0) / self.exponent)))
    }

    /// What of w holds if the limit was lowered meanwhile.
    fn held(&self, w: N) -> N {
        // the limit is then 1 or more
        if w.value().abs() <= 1.0 && (self.beta + self.gamma).value() <= 1.0 {
            return w;
        }
        match self.limit() {
            Some(limit) if w.value() > limit.value() => limit,
            Some(limit) if w.value() < -limit.value() => -limit,
            _ => w,
        }
    }

    fn branch(&self) -> Branch<N> {
        Branch {
            exponent: self.exponent,
            loading: self.beta + self.gamma,
            unloading: self.beta - self.gamma,
        }
    }

    /// The way from the memory's place to r: its direction, w before it, and its length.
    fn start<M: Number + Into<N>>(&self, memory: &[M], r: N) -> (f64, N, N) {
        let number = |place: usize| memory.get(place).map_or(N::ZERO, |&number| number.into());
        let way = r - number(PLACE);
        let sign = match way.value() {
            way if way > 0.0 => 1.0,
            way if way < 0.0 => -1.0,
            _ if number(DIRECTION).value() < 0.0 => -1.0,
            _ => 1.0,
        };
        let before = N::from(sign) * number(LOAD) / self.slip_force;
        let length = N::from(sign) * way * self.stiffness / self.slip_force;
        (sign, self.held(before), length)
    }
}

impl<N: Number> Law<N> for BoucWen<N> {
    const DECLARATION: Declaration = Declaration {
        name: "bouc-wen",
        summary: "A hysteretic spring after Bouc and Wen",
        parameters: &[
            Parameter {
                symbol: "bouc_wen_k",
                description: "Stiffness of the joint's Bouc-Wen law in {motion} at no load",
                ..STIFFNESS
            },
            Parameter {
                symbol: "bouc_wen_h",
                description: "Load at which the joint's Bouc-Wen law slips in {motion} where beta and gamma have the sum 1",
                ..SLIP_FORCE
            },
            Parameter {
                symbol: "bouc_wen_n",
                key: "exponent",
                description: "Exponent of the joint's Bouc-Wen law in {motion}, 1 or more: how sharply it begins to slip",
                ..NUMBER
            },
            Parameter {
                symbol: "bouc_wen_beta",
                key: "beta",
                quantity: Quantity {
                    name: "HysteresisShape",
                    ..NUMBER.quantity
                },
                description: "Coefficient beta of the joint's Bouc-Wen law in {motion}, by which it turns motion into heat",
                ..NUMBER
            },
            Parameter {
                symbol: "bouc_wen_gamma",
                key: "gamma",
                range: Range::Any,
                quantity: Quantity {
                    name: "HysteresisSkew",
                    ..NUMBER.quantity
                },
                description: "Coefficient gamma of the joint's Bouc-Wen law in {motion}, from -beta to beta",
                ..NUMBER
            },
        ],
        memory: &[Remembered {
            symbol: "bouc_wen_p",
            quantity: RememberedAs::Load,
            description: "{Load} of the joint's Bouc-Wen law in {motion}; in Co-Simulation as of the last step",
            rate: Some(RateOf {
                symbol: "bouc_wen_pdot",
                description: "Rate of the {load} of the joint's Bouc-Wen law in {motion}",
            }),
        }],
        hidden_memory: 2,
        at_most: 2,
        number: 1,
    };

    by_numbers!(stiffness, slip_force, exponent, beta, gamma);

    fn load<M: Number + Into<N>>(&self, memory: &[M], r: N, _: N) -> N {
        if !self.is_there() {
            return N::ZERO;
        }
        let (sign, before, length) = self.start(memory, r);
        N::from(sign) * self.slip_force * self.branch().load(before, length)
    }

    fn stored_energy<M: Number + Into<N>>(&self, memory: &[M], r: N) -> N {
        if !self.is_there() {
            return N::ZERO;
        }
        // F²/(2k)
        let load = self.load(memory, r, N::ZERO);
        N::from(0.5) * load * load / self.stiffness
    }

    fn energy_in<M: Number + Into<N>>(&self, springs: &Self, memory: &[M], r: N) -> N {
        if !self.is_there() {
            return N::ZERO;
        }
        let elongation = self.load(memory, r, N::ZERO) / self.stiffness;
        N::from(0.5) * springs.stiffness * elongation * elongation
    }

    fn dissipated_power<M: Number + Into<N>>(&self, memory: &[M], r: N, velocity: N) -> N {
        if !self.is_there() {
            return N::ZERO;
        }
        // F_y |w|^(n+1) (β + γ s sgn w) |u̇|
        let load = self.load(memory, r, N::ZERO);
        let sign = N::from(velocity.value().signum());
        let against = sign * load / self.slip_force;
        let (w, coefficient) = if against.value() < 0.0 {
            (-against, self.beta - self.gamma)
        } else {
            (against, self.beta + self.gamma)
        };
        self.slip_force * w.powf(self.exponent + N::from(1.0)) * coefficient * sign * velocity
    }

    fn commit(&self, memory: &mut [N], r: N, _: N) -> f64 {
        if memory.len() <= DIRECTION || !r.is_finite() {
            return 0.0;
        }
        if !self.is_there() {
            return flow::release_all(memory, self.stiffness, r);
        }
        let released = self.limit().map_or(0.0, |limit| {
            flow::release(memory, self.slip_force * limit, self.stiffness)
        });
        if r.value() == memory[PLACE].value() {
            return released;
        }
        let (sign, before, length) = self.start(memory, r);
        let way = self.branch().way(before, length);
        memory[LOAD] = N::from(sign) * self.slip_force * way.after;
        memory[PLACE] = r;
        memory[DIRECTION] = N::from(sign);
        let [stiffness, slip_force, ..] = self.parameters().map(Number::value);
        released + slip_force * slip_force / stiffness * way.heat
    }

    fn settle(&self, memory: &mut [N], r: N, velocity: N) {
        if memory.len() > DIRECTION {
            memory[PLACE] = r;
            if velocity.value() != 0.0 {
                memory[DIRECTION] = N::from(velocity.value().signum());
            }
        }
    }

    fn inner_rate(&self, memory: &[N], velocity: N) -> N {
        let Some(&load) = memory.get(LOAD).filter(|_| self.is_there()) else {
            return N::ZERO;
        };
        // dF/dt = k (1 − (β s sgn w + γ) |w|ⁿ) u̇
        let sign = N::from(if velocity.value() < 0.0 { -1.0 } else { 1.0 });
        let against = sign * load / self.slip_force;
        self.stiffness * self.branch().rate(against) * velocity
    }

    fn corners(&self, memory: &[f64], to: f64, tell: &mut dyn FnMut(Corner)) {
        if self.is_there() {
            // where no load is left
            let number = |place: usize| memory.get(place).copied().unwrap_or(0.0);
            let (place, load) = (number(PLACE), number(LOAD));
            let sign = if to < place { -1.0 } else { 1.0 };
            let [stiffness, slip_force, ..] = self.parameters().map(Number::value);
            let against = sign * load / slip_force;
            if against < 0.0 {
                let way = self.branch().unloading_way(N::from(-against)).value();
                tell(Corner::Sharp(place + sign * way * slip_force / stiffness));
            }
        }
    }

    fn outside(&self) -> Option<Outside> {
        let [stiffness, slip_force, exponent, beta, gamma] = self.parameters().map(Number::value);
        match () {
            () if !is_positive(stiffness) => Outside::at(0, "a number above 0"),
            () if !is_positive(slip_force) => Outside::at(1, "a number above 0"),
            () if !(1.0..=EXPONENT_MAX).contains(&exponent) => {
                Outside::at(2, format!("1 to {EXPONENT_MAX}"))
            }
            () if !is_positive(beta) => Outside::at(3, "a number above 0"),
            () if !(-beta..=beta).contains(&gamma) => Outside::at(
                4,
                format!("-{beta:?} to {beta:?}, beta: beyond that the law gives energy"),
            ),
            () => None,
        }
    }

    fn nonlinear_amplitude(&self, _: f64, _: f64) -> f64 {
        self.slip_force.value() / self.stiffness.value()
    }
}

/// Largest exponent: beyond it the law is a spring and a slider, of which the Jenkins element is the better form.
const EXPONENT_MAX: f64 = 100.0;

#[cfg(test)]
mod tests;
