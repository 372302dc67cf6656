//! The Iwan law with four parameters (Segalman, J. Appl. Mech. 72 (2005) 752): a continuum of springs and sliders side
//! by side, of which the weakest slip first. Small motion loses little energy, as bolted joints do, and large motion
//! slips through.
//!
//! It needs no sliders: the joint's motion is what it remembers, as the points at which it turned. Between them the
//! load follows the curve of the first loading at twice its size (Masing's rule), and a loop that has closed is
//! forgotten. Where the strength of the sliders changes, as with the preload of a bolt, their elongations are remembered.

mod curve;
mod elongations;
mod reversals;
mod strength;

use super::{
    Corner, Law,
    declaration::{
        Declaration, Outside, Parameter, Quantity, Range, Remembered, RememberedAs, UnitRule,
        is_positive,
    },
    slider_parameters::{SLIP_FORCE, STIFFNESS},
};
use crate::number::Number;
use curve::Curve;
use elongations::Elongations;
use reversals::{HIDDEN, Reversals};
use strength::Strength;

pub use reversals::REVERSALS_MAX;

/// Part of φ_max within which a motion is that of the latest commit, but for rounding.
const ROUNDING: f64 = 1e-9;

/// A continuum of sliders on one relative DOF, each a spring that slips at its own load: their density over the
/// displacement φ at which they slip is R φ^χ up to φ_max, and those of the ratio β slip at φ_max itself.
///
/// A cycle in the range of small motion costs the power χ + 3 of its amplitude:
///
/// ```
/// use bolted_joint_dynamics::law::{Iwan, Law};
///
/// let law = Iwan { slip_force: 1.0, stiffness: 1.0, exponent: -0.5, ratio: 0.0 };
/// let mut memory = [0.0; Iwan::<f64>::DECLARATION.memory_count()];
/// law.commit(&mut memory, 1.5, 0.0);
/// let heat = law.commit(&mut memory, -1.5, 0.0) + law.commit(&mut memory, 1.5, 0.0);
/// // φ_max = 3 m, R = 1/√12; D = 4 R U^(χ+3)/((χ+2)(χ+3)) at U = φ_max/2
/// assert!((heat - 0.84852813742386).abs() < 1e-12);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Iwan<N = f64> {
    /// F_S, at which all slips: N, N·m.
    pub slip_force: N,
    /// K_T while all sticks: N/m, N·m/rad.
    pub stiffness: N,
    /// χ > −1, the power of the density; a cycle of small amplitude costs the power χ + 3 of it.
    pub exponent: N,
    /// β ≥ 0, stiffness of the sliders that slip at φ_max to that of all others.
    pub ratio: N,
}

impl<N: Number> Iwan<N> {
    /// Its curve of first loading; `None` where it gives no load.
    fn curve<M: Number + Into<N>>(&self, memory: &[M]) -> Option<Curve<N>> {
        let known = || Reversals::of(memory).curve(self);
        (self.is_there() && self.slip_force.value() > 0.0)
            .then(|| known().unwrap_or_else(|| Curve::new(self)))
    }

    /// Whether it has sliders, be they pressed or not.
    fn is_there(&self) -> bool {
        self.stiffness.value() > 0.0 && self.exponent.value() > -1.0
    }

    fn parameters(&self) -> [N; 4] {
        [self.slip_force, self.stiffness, self.exponent, self.ratio]
    }
}

impl<N: Number> Law<N> for Iwan<N> {
    const DECLARATION: Declaration = Declaration {
        name: "iwan",
        summary: "Many sliders side by side, the weakest of which slip first, by Segalman's four parameters",
        parameters: &[
            Parameter {
                symbol: "iwan_h",
                description: "Load at which the joint's Iwan law slips through in {motion}",
                ..SLIP_FORCE
            },
            Parameter {
                symbol: "iwan_k",
                description: "Stiffness of the joint's Iwan law in {motion} while all of it sticks",
                ..STIFFNESS
            },
            Parameter {
                symbol: "iwan_chi",
                key: "exponent",
                unit: UnitRule::One,
                range: Range::Any,
                quantity: Quantity {
                    name: "Exponent",
                    nominal: [1.0; 3],
                    start: [0.0; 3],
                },
                description: "Exponent of the joint's Iwan law in {motion}: small cycles lose its power plus three of their amplitude",
                ..STIFFNESS
            },
            Parameter {
                symbol: "iwan_beta",
                key: "ratio",
                unit: UnitRule::One,
                quantity: Quantity {
                    name: "StiffnessRatio",
                    nominal: [1.0; 3],
                    start: [0.0; 3],
                },
                description: "Stiffness of what slips last in {motion} to that of all that slips before in the joint's Iwan law",
                ..STIFFNESS
            },
        ],
        memory: &[Remembered {
            symbol: "iwan_reversal",
            quantity: RememberedAs::Displacement,
            description: "Relative {motion} at which the joint turned last, zero before it has, as of the last step",
            rate: None,
        }],
        hidden_memory: HIDDEN,
        at_most: 2,
        number: 1,
    };

    by_numbers!(slip_force, stiffness, exponent, ratio);

    fn load<M: Number + Into<N>>(&self, memory: &[M], r: N, _: N) -> N {
        let reversals = Reversals::of(memory);
        if let Some(sliders) = reversals.elongations(self) {
            return Strength::of(self).load(&sliders, r - reversals.place().into());
        }
        if let Some(load) = reversals.load_here(self, r) {
            return load;
        }
        let Some(curve) = self.curve(memory) else {
            return N::ZERO;
        };
        let branch = reversals.branch(r.value());
        let at = reversals.at(&branch, r, &curve);
        reversals::load(reversals.tip(&branch, &curve).as_ref(), r, &curve, &at)
    }

    fn stored_energy<M: Number + Into<N>>(&self, memory: &[M], r: N) -> N {
        let reversals = Reversals::of(memory);
        if let Some(sliders) = reversals.elongations(self) {
            let stored = Strength::of(self).stored(&sliders, r - reversals.place().into());
            return stored - reversals.owed().into();
        }
        let Some(curve) = self.curve(memory) else {
            return N::ZERO;
        };
        let branch = reversals.branch(r.value());
        let at = reversals.at(&branch, r, &curve);
        let stored = match reversals.tip(&branch, &curve) {
            None => curve.stored(&at),
            Some(tip) => tip.stored + curve.masing_stored(tip.load, tip.stored, r - tip.place, &at),
        };
        stored - reversals.owed().into()
    }

    fn energy_in<M: Number + Into<N>>(&self, springs: &Self, memory: &[M], r: N) -> N {
        // wherever the joint has been, its points tell elongations as well
        let reversals = Reversals::of(memory);
        match reversals.all_elongations(self) {
            Some(sliders) => {
                let way = r - reversals.place().into();
                Strength::of(self).stored_in(&Strength::of(springs), &sliders, way)
            }
            None => N::ZERO,
        }
    }

    fn dissipated_power<M: Number + Into<N>>(&self, memory: &[M], r: N, velocity: N) -> N {
        let reversals = Reversals::of(memory);
        let rate = velocity.value();
        let way: N = r - reversals.place().into();
        // a commit has left it here: whoever sums the motion up differently has not turned
        let is_here = |span: N| way.value().abs() <= ROUNDING * span.value();
        if let Some(sliders) = reversals.elongations(self) {
            let (strength, sign) = (Strength::of(self), rate.signum());
            let way = match is_here(strength.span) {
                true => way - N::from(way.value()),
                false => way,
            };
            return strength.slipping(&sliders, way, sign) * N::from(sign) * velocity;
        }
        let Some(curve) = self.curve(memory) else {
            return N::ZERO;
        };
        let branch = match is_here(curve.span) {
            true => reversals.branch(reversals.place().value()),
            false => reversals.branch(r.value()),
        };
        if rate == 0.0 || branch.is_forward.is_some_and(|it| it != (rate > 0.0)) {
            // where it turns nothing slips yet
            return N::ZERO;
        }
        let speed = velocity * N::from(rate.signum());
        curve.heat_slope(&reversals.at(&branch, r, &curve)) * speed
    }

    fn commit(&self, memory: &mut [N], r: N, _: N) -> f64 {
        if !r.is_finite() {
            return 0.0;
        }
        if let Some(sliders) = Reversals::of(memory).elongations(self) {
            return strength::commit(self, &sliders, memory, r);
        }
        match self.curve(memory) {
            Some(curve) => reversals::commit(memory, &curve, r),
            None if self.is_there() => strength::commit(self, &Elongations::at_rest(), memory, r),
            None => 0.0,
        }
    }

    fn used(&self, memory: &[N]) -> usize {
        reversals::used(memory, self)
    }

    fn is_finite(&self, memory: &[N]) -> bool {
        reversals::is_finite(memory)
    }

    fn corners(&self, memory: &[f64], to: f64, tell: &mut dyn FnMut(Corner)) {
        let law = Iwan::<f64>::new(&self.parameters().map(Number::value));
        let reversals = Reversals::of(memory);
        if let Some(sliders) = reversals.elongations(&law) {
            sliders.corners(reversals.place(), to, Strength::of(&law).span, tell);
        } else if let Some(curve) = law.curve(memory) {
            reversals.corners(to, curve.span, tell);
        }
    }

    fn outside(&self) -> Option<Outside> {
        let [slip_force, stiffness, exponent, ratio] = self.parameters().map(Number::value);
        match () {
            () if !is_positive(slip_force) => Outside::at(0, "a number above 0"),
            () if !is_positive(stiffness) => Outside::at(1, "a number above 0"),
            () if !(exponent > -1.0 && exponent.is_finite()) => Outside::at(2, "a number above -1"),
            () if !(ratio >= 0.0 && ratio.is_finite()) => Outside::at(3, "zero or more"),
            () => None,
        }
    }

    fn nonlinear_amplitude(&self, _: f64, _: f64) -> f64 {
        // from φ_max on all of it slips
        self.curve::<N>(&[])
            .map_or(f64::INFINITY, |curve| curve.span.value())
    }
}

#[cfg(test)]
mod tests;
