//! Springs and dampers that are powers of the relative displacement: the cubic spring of Pirdayr's lap, stiffness of higher
//! order, and damping that grows or falls with the amplitude.
//!
//! Load on side b: `k3 r³ + k5 r⁵ + k7 r⁷ + (c2 r² + c4 r⁴) ṙ`. A further term is a further row of `SPRINGS` or `DAMPERS`.

mod term;

pub use term::{TERM_COUNT, Term};

use super::{
    Law,
    declaration::{ActsOn, Declaration, Parameter, Quantity, Range, Span, UnitRule},
};
use crate::{
    number::Number,
    power_series::{first_negative, positive_roots, value},
};

/// A spring; what is its own is written over this.
const SPRING: Parameter = Parameter {
    symbol: "",
    key: "",
    span: Span::Dof,
    unit: UnitRule::LoadPer {
        displacement: 0,
        seconds: 0,
    },
    range: Range::Any,
    quantity: Quantity {
        name: "",
        nominal: [1.0; 3],
        start: [0.0; 3],
    },
    description: "",
    acts_on: ActsOn::SPRING,
    grows_with_preload: false,
};

/// A damper, likewise.
const DAMPER: Parameter = Parameter {
    acts_on: ActsOn::DAMPER,
    ..SPRING
};

/// The springs k3 r³, k5 r⁵, …: the one at index j has the power 2j + 3.
const SPRINGS: [Parameter; 3] = [
    Parameter {
        symbol: "k3",
        key: "cubic",
        unit: UnitRule::LoadPer {
            displacement: 3,
            seconds: 0,
        },
        quantity: Quantity {
            name: "CubicStiffness",
            nominal: [1e12, 1e9, 1e6],
            ..SPRING.quantity
        },
        description: "Cubic stiffness of the joint in {motion}: positive hardens, negative softens",
        ..SPRING
    },
    Parameter {
        symbol: "k5",
        key: "quintic",
        unit: UnitRule::LoadPer {
            displacement: 5,
            seconds: 0,
        },
        quantity: Quantity {
            name: "QuinticStiffness",
            nominal: [1e18, 1e13, 1e9],
            ..SPRING.quantity
        },
        description: "Stiffness of fifth order of the joint in {motion}",
        ..SPRING
    },
    Parameter {
        symbol: "k7",
        key: "septic",
        unit: UnitRule::LoadPer {
            displacement: 7,
            seconds: 0,
        },
        quantity: Quantity {
            name: "SepticStiffness",
            nominal: [1e24, 1e18, 1e12],
            ..SPRING.quantity
        },
        description: "Stiffness of seventh order of the joint in {motion}",
        ..SPRING
    },
];

/// The dampers c2 r² ṙ, c4 r⁴ ṙ, …: the one at index j has the power 2j + 2 of r.
const DAMPERS: [Parameter; 2] = [
    Parameter {
        symbol: "c2",
        key: "damping_quadratic",
        unit: UnitRule::LoadPer {
            displacement: 3,
            seconds: 1,
        },
        quantity: Quantity {
            name: "QuadraticDamping",
            nominal: [1e7, 3e4, 100.0],
            ..SPRING.quantity
        },
        description: "Damping of the joint that grows with the square of the relative {motion}",
        ..DAMPER
    },
    Parameter {
        symbol: "c4",
        key: "damping_quartic",
        unit: UnitRule::LoadPer {
            displacement: 5,
            seconds: 1,
        },
        quantity: Quantity {
            name: "QuarticDamping",
            nominal: [1e13, 1e9, 1e5],
            ..SPRING.quantity
        },
        description: "Damping of the joint that grows with the fourth power of the relative {motion}",
        ..DAMPER
    },
];

/// Number of springs.
pub const SPRING_COUNT: usize = SPRINGS.len();

/// Number of dampers.
pub const DAMPER_COUNT: usize = DAMPERS.len();

const PARAMETERS: [Parameter; TERM_COUNT] = {
    let mut all = [SPRING; TERM_COUNT];
    let mut index = 0;
    while index < all.len() {
        all[index] = if index < SPRING_COUNT {
            SPRINGS[index]
        } else {
            DAMPERS[index - SPRING_COUNT]
        };
        index += 1;
    }
    all
};

/// The load with its derivatives at one moment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tangent {
    /// f, N or N·m.
    pub force: f64,
    /// ∂f/∂r
    pub stiffness: f64,
    /// ∂f/∂ṙ
    pub damping: f64,
}

/// The terms on one relative DOF.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Polynomial<N = f64> {
    /// k3, k5, k7: N/m³, N·m/rad³ and so on. Positive hardens, negative softens.
    pub springs: [N; SPRING_COUNT],
    /// c2, c4: N·s/m³, N·m·s/rad³ and so on.
    pub dampers: [N; DAMPER_COUNT],
}

impl<N: Number> Polynomial<N> {
    /// No such terms.
    pub const NONE: Self = Self {
        springs: [N::ZERO; SPRING_COUNT],
        dampers: [N::ZERO; DAMPER_COUNT],
    };

    /// These springs, from k3 on, and these dampers, from c2 on; what is left out is zero.
    #[must_use]
    pub fn with(springs: &[N], dampers: &[N]) -> Self {
        let or_zero = |list: &[N], index: usize| list.get(index).copied().unwrap_or(N::ZERO);
        Self {
            springs: std::array::from_fn(|j| or_zero(springs, j)),
            dampers: std::array::from_fn(|j| or_zero(dampers, j)),
        }
    }

    /// A cubic spring alone: N/m³, N·m/rad³.
    #[must_use]
    pub fn cubic(k3: N) -> Self {
        Self::with(&[k3], &[])
    }

    /// The terms on each of several DOFs, as joint files list them: the springs of third, fifth, … order on each DOF, then the
    /// dampers of second, fourth, … order; what is left out is zero.
    #[must_use]
    pub fn on_each<const D: usize>(springs: &[[N; D]], dampers: &[[N; D]]) -> [Self; D] {
        let mut all = [Self::NONE; D];
        for (i, own) in all.iter_mut().enumerate() {
            for (term, list) in own.springs.iter_mut().zip(springs) {
                *term = list[i];
            }
            for (term, list) in own.dampers.iter_mut().zip(dampers) {
                *term = list[i];
            }
        }
        all
    }

    /// The terms without the cubic spring.
    #[must_use]
    pub fn without_cubic(&self) -> Self {
        let mut rest = *self;
        rest.springs[0] = N::ZERO;
        rest
    }

    /// Whether there is nothing but a cubic spring, or not even that.
    #[inline]
    #[must_use]
    pub fn is_cubic(&self) -> bool {
        self.springs[1..].iter().all(|k| k.is_zero()) && !self.has_damping()
    }

    /// Whether the load depends on the velocity.
    #[inline]
    #[must_use]
    pub fn has_damping(&self) -> bool {
        !self.dampers.iter().all(|c| c.is_zero())
    }

    /// Damping coefficient that the amplitude adds at the relative displacement r: N·s/m, N·m·s/rad.
    #[inline]
    #[must_use]
    pub fn damping(&self, r: N) -> N {
        // c2 r² + c4 r⁴; without them nothing, however far out
        if !self.has_damping() {
            return N::ZERO;
        }
        let squared = r * r;
        value(&self.dampers, squared) * squared
    }
}

impl<N: Number> Law<N> for Polynomial<N> {
    const DECLARATION: Declaration = Declaration {
        name: "polynomial",
        summary: "Springs and dampers that are powers of the relative displacement",
        parameters: &PARAMETERS,
        memory: &[],
        hidden_memory: 0,
        at_most: 1,
        number: 1,
    };

    #[inline]
    fn new(parameters: &[N]) -> Self {
        let (springs, dampers) = parameters.split_at(SPRING_COUNT.min(parameters.len()));
        Self::with(springs, dampers)
    }

    fn write(&self, parameters: &mut [N]) {
        let own = self.springs.iter().chain(&self.dampers);
        for (parameter, own) in parameters.iter_mut().zip(own) {
            *parameter = *own;
        }
    }

    #[inline]
    fn load<M: Number + Into<N>>(&self, _: &[M], r: N, velocity: N) -> N {
        // k3 r³ + (k5 + k7 r²) r⁴ r + (c2 r² + c4 r⁴) ṙ
        let cubic = self.springs[0] * r * r * r;
        if self.is_cubic() {
            return cubic;
        }
        let squared = r * r;
        let spring = value(&self.springs[1..], squared) * squared * squared * r;
        cubic + (spring + self.damping(r) * velocity)
    }

    #[inline]
    fn stored_energy<M: Number + Into<N>>(&self, _: &[M], r: N) -> N {
        // ¼ k3 r⁴ + ⅙ k5 r⁶ + ⅛ k7 r⁸
        let squared = r * r;
        let of_spring = |j: usize| self.springs[j] / N::from((2 * j + 4) as f64);
        let cubic = N::from(0.25) * (self.springs[0] * squared * squared);
        if self.is_cubic() {
            return cubic;
        }
        let scaled: [N; SPRING_COUNT] = std::array::from_fn(of_spring);
        cubic + value(&scaled[1..], squared) * squared * squared * squared
    }

    #[inline]
    fn dissipated_power<M: Number + Into<N>>(&self, _: &[M], r: N, velocity: N) -> N {
        // (c2 r² + c4 r⁴) ṙ²
        self.damping(r) * velocity * velocity
    }

    fn nonlinear_amplitude(&self, k: f64, c: f64) -> f64 {
        // the first of the terms that is as large as the linear one of the same kind
        let of_term = |linear: f64, term: N, half_order: usize| {
            if term.is_zero() {
                return f64::INFINITY;
            }
            // |kₙ| rⁿ⁻¹ = k
            let ratio = linear / term.value().abs();
            match half_order {
                1 => ratio.sqrt(),
                2 => ratio.sqrt().sqrt(),
                3 => ratio.cbrt().sqrt(),
                n => ratio.powf(0.5 / n as f64),
            }
        };
        let springs = self
            .springs
            .iter()
            .enumerate()
            .map(|(j, &term)| of_term(k, term, j + 1));
        let dampers = self
            .dampers
            .iter()
            .enumerate()
            .map(|(j, &term)| of_term(c, term, j + 1));
        springs.chain(dampers).fold(f64::INFINITY, f64::min)
    }
}

impl Polynomial {
    /// Degree in r and ṙ together of the highest term there is; at least that of the cubic spring.
    #[must_use]
    pub fn degree(&self) -> usize {
        let there = Term::ALL
            .into_iter()
            .filter(|&term| self.coefficient(term) != 0.0);
        there
            .map(Term::degree)
            .fold(Term::CUBIC.degree(), usize::max)
    }

    /// The load and its derivatives by Horner's scheme: what [`crate::Dual`] numbers give, for loops over many moments.
    #[inline]
    #[must_use]
    pub fn tangent(&self, r: f64, velocity: f64) -> Tangent {
        // ∂f/∂r = 3 k3 r² + 5 k5 r⁴ + 7 k7 r⁶ + (2 c2 r + 4 c4 r³) ṙ, ∂f/∂ṙ = c2 r² + c4 r⁴
        let squared = r * r;
        let slopes: [f64; SPRING_COUNT] =
            std::array::from_fn(|j| (2 * j + 3) as f64 * self.springs[j]);
        let changes: [f64; DAMPER_COUNT] =
            std::array::from_fn(|j| (2 * j + 2) as f64 * self.dampers[j]);
        let damping = squared * value(&self.dampers, squared);
        Tangent {
            force: r * squared * value(&self.springs, squared) + damping * velocity,
            stiffness: squared * value(&slopes, squared) + r * value(&changes, squared) * velocity,
            damping,
        }
    }

    /// Displacements above rest and below `amplitude` (m, rad) at which the stiffness or the damping of small motion about
    /// them turns from growing to falling, or back.
    pub(crate) fn turning_points(&self, amplitude: f64) -> impl Iterator<Item = f64> + use<> {
        // of u = r²: 3 k3 + 10 k5 u + 21 k7 u² = 0 and c2 + 2 c4 u = 0
        let of_springs = std::array::from_fn::<_, SPRING_COUNT, _>(|j| {
            ((j + 1) * (2 * j + 3)) as f64 * self.springs[j]
        });
        let of_dampers =
            std::array::from_fn::<_, DAMPER_COUNT, _>(|j| (j + 1) as f64 * self.dampers[j]);
        let springs = positive_roots(&of_springs).into_iter();
        let dampers = positive_roots(&of_dampers).into_iter();
        springs
            .chain(dampers)
            .map(f64::sqrt)
            .filter(move |&r| r < amplitude)
    }

    /// Least damping coefficient that the amplitude adds (N·s/m, N·m·s/rad; zero or less) within a relative displacement of
    /// `amplitude` (m, rad), which may be infinite.
    #[must_use]
    pub fn least_damping(&self, amplitude: f64) -> f64 {
        let last = self.dampers.iter().rev().find(|&&c| c != 0.0);
        let farthest = if amplitude.is_finite() {
            self.damping(amplitude)
        } else if last.is_some_and(|&c| c < 0.0) {
            f64::NEG_INFINITY
        } else {
            0.0
        };
        self.turning_points(amplitude)
            .map(|r| self.damping(r))
            .fold(farthest, f64::min)
            .min(0.0)
    }

    /// Relative displacement (m, rad) beyond which the damping `c` together with what the amplitude adds is negative; `None`
    /// where it never is.
    pub(crate) fn first_active(&self, c: f64) -> Option<f64> {
        if self.dampers.iter().all(|&damper| damper >= 0.0) {
            return None;
        }
        let mut damping = [c; DAMPER_COUNT + 1];
        damping[1..].copy_from_slice(&self.dampers);
        first_negative(&damping).map(f64::sqrt)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::number::Dual;

    #[test]
    fn the_least_damping_is_that_of_a_fine_grid() {
        for (c2, c4) in [
            (-3.0, 2.0),
            (3.0, -2.0),
            (-1.0, -1.0),
            (1.0, 1.0),
            (-1.0, 0.0),
        ] {
            for amplitude in [0.3, 0.8, 2.0] {
                let least = (0..=100_000)
                    .map(|n| {
                        let u = (amplitude * f64::from(n) / 1e5).powi(2);
                        c2 * u + c4 * u * u
                    })
                    .fold(f64::INFINITY, f64::min);
                let found = Polynomial::with(&[], &[c2, c4]).least_damping(amplitude);
                assert!((found - least).abs() < 1e-8, "{c2} {c4} {amplitude}");
            }
        }
        let without_end = |c2, c4| Polynomial::with(&[], &[c2, c4]).least_damping(f64::INFINITY);
        assert_eq!(without_end(1.0, -1.0), f64::NEG_INFINITY);
        assert_eq!(without_end(-2.0, 1.0), -1.0);
    }

    #[test]
    fn the_tangent_is_that_of_the_load() {
        let all = Polynomial::with(&[-3e2, 7e3, 2e5], &[4.0, -6e2]);
        for (r, velocity) in [(0.1, 2.0), (-0.07, 0.5), (0.0, 1.0)] {
            let terms = Polynomial::new(&Term::ALL.map(|term| all.coefficient(term).into()));
            let dual = terms.load::<f64>(&[], Dual::<2>::along(r, 0), Dual::along(velocity, 1));
            let tangent = all.tangent(r, velocity);
            for (found, expected) in [
                (tangent.force, dual.value),
                (tangent.stiffness, dual.change[0]),
                (tangent.damping, dual.change[1]),
            ] {
                assert!(
                    (found - expected).abs() < 1e-13 * (1.0 + expected.abs()),
                    "{r}"
                );
            }
        }
    }

    #[test]
    fn the_powers_of_the_terms_are_those_of_their_units() {
        for (j, spring) in SPRINGS.iter().enumerate() {
            assert_eq!(usize::from(spring.unit.displacement()), 2 * j + 3);
            let mut alone = Polynomial::<f64>::NONE;
            alone.springs[j] = 1.0;
            let expected = 1.5_f64.powi(2 * j as i32 + 3);
            assert!((alone.load::<f64>(&[], 1.5, 7.0) / expected - 1.0).abs() < 1e-15);
        }
        for (j, damper) in DAMPERS.iter().enumerate() {
            // c r^(2j+2) ṙ: one more displacement is in the velocity
            assert_eq!(usize::from(damper.unit.displacement()), 2 * j + 3);
            let mut alone = Polynomial::<f64>::NONE;
            alone.dampers[j] = 1.0;
            let expected = 7.0 * 1.5_f64.powi(2 * j as i32 + 2);
            assert!((alone.load::<f64>(&[], 1.5, 7.0) / expected - 1.0).abs() < 1e-15);
        }
    }
}
