//! A slider that does not slip at once but flows the more, the nearer its load is to the limit: what the laws of
//! Valanis and Dahl have in common.
//!
//! Its load p follows dp/dx = E₁ (1 − s w)/(1 − c s w) with w = p/p_m and s = sgn ẋ. At c = 0 it is Dahl's, and towards
//! c = 1 a spring in series with a slider. The step over a way of any length is exact.

use super::Corner;
use crate::{elementary, number::Number};

/// Places of what is remembered: the load, and beside what is a variable the place and the direction of the latest
/// motion, and the stiffness E₁ then.
const LOAD: usize = 0;
const PLACE: usize = 1;
const DIRECTION: usize = 2;
const STIFFNESS: usize = 3;

/// Numbers that are no variables.
pub(super) const HIDDEN: usize = 3;

/// What the parameters of a law give.
#[derive(Clone, Copy, Debug)]
pub(super) struct Flow<N> {
    /// E₁ > 0 at no load: N/m, N·m/rad.
    pub(super) stiffness: N,
    /// p_m > 0, which the load approaches: N, N·m.
    pub(super) limit: N,
    /// c from 0 to 1.
    pub(super) sharpness: N,
}

/// A way of the slider. All is told in its direction: w is positive where the load resists the motion.
#[derive(Clone, Copy, Debug)]
struct Way<N> {
    sign: f64,
    /// s w where it begins.
    before: N,
    /// By how much s w grows.
    growth: N,
    /// ln of what is left to the limit at its end over what was left before.
    logarithm: N,
    /// E₁ |Δx|/p_m
    length: N,
}

impl<N: Number> Flow<N> {
    /// The way from the memory's place to r.
    fn way<M: Number + Into<N>>(&self, memory: &[M], r: N) -> Way<N> {
        let number = |place: usize| memory.get(place).map_or(N::ZERO, |&number| number.into());
        let one = N::from(1.0);
        let way = r - number(PLACE);
        let sign = match way.value() {
            way if way > 0.0 => 1.0,
            way if way < 0.0 => -1.0,
            _ if number(DIRECTION).value() < 0.0 => -1.0,
            _ => 1.0,
        };
        let before = N::from(sign) * self.load_of_now(memory) / self.limit;
        // a limit that was lowered meanwhile holds at once
        let before = match before.value() {
            w if w > 1.0 => one,
            w if w < -1.0 => -one,
            _ => before,
        };
        let length = N::from(sign) * way * self.stiffness / self.limit;
        let (growth, logarithm) = self.growth(one - before, length);
        Way {
            sign,
            before,
            growth,
            logarithm,
            length,
        }
    }

    /// The remembered load at the present stiffness: the elongation stays where that changes.
    fn load_of_now<M: Number + Into<N>>(&self, memory: &[M]) -> N {
        let number = |place: usize| memory.get(place).map_or(N::ZERO, |&number| number.into());
        let (load, then): (N, N) = (number(LOAD), number(STIFFNESS));
        if then.is_zero() || (then - self.stiffness).is_zero() {
            return load;
        }
        load * self.stiffness / then
    }

    /// By how much s w grows where `left` is left to the limit, over a way of this length in p_m/E₁; and the logarithm
    /// of the part that is left of it.
    fn growth(&self, left: N, length: N) -> (N, N) {
        let one = N::from(1.0);
        let c = self.sharpness;
        if c.value() >= 1.0 {
            // a spring until the limit is reached
            let growth = if length.value() < left.value() {
                length
            } else {
                left
            };
            return (growth, N::from(f64::NEG_INFINITY));
        }
        // c y (1 − e^ℓ) − (1−c) ℓ = ξ for ℓ = ln(y'/y): the Lambert W step in logarithms, so that nothing overflows
        let at = logarithm(c.value(), left.value(), length.value());
        let missing = c * left * N::from(elementary::exp_m1(at)) + (one - c) * N::from(at) + length;
        let slope = c.value() * left.value() * elementary::exp(at) + 1.0 - c.value();
        // a step of Newton's method from the root has the root's changes
        let logarithm = N::from(at) - missing / N::from(slope);
        (-(left * logarithm.exp_m1()), logarithm)
    }

    /// Load on side b at r.
    pub(super) fn load<M: Number + Into<N>>(&self, memory: &[M], r: N) -> N {
        let Way {
            sign,
            before,
            growth,
            ..
        } = self.way(memory, r);
        N::from(sign) * self.limit * (before + growth)
    }

    /// Where a spring alone would have come to the limit on a straight way to `to`: the sharper the slider, the nearer a
    /// corner it has there.
    pub(super) fn corner(&self, memory: &[f64], to: f64) -> Corner {
        let way = self.way(memory, N::from(to));
        let left = (1.0 - way.before.value()) * self.limit.value() / self.stiffness.value();
        let place = memory.get(PLACE).copied().unwrap_or(0.0) + way.sign * left;
        if self.sharpness.value() >= 1.0 {
            Corner::Sharp(place)
        } else {
            Corner::Rounded(place)
        }
    }

    /// Energy in its spring at r.
    pub(super) fn stored_energy<M: Number + Into<N>>(&self, memory: &[M], r: N) -> N {
        // p²/(2 E₁)
        let load = self.load(memory, r);
        N::from(0.5) * load * load / self.stiffness
    }

    /// Energy (J) of its elongation at r in a spring of this stiffness.
    pub(super) fn energy_in<M: Number + Into<N>>(&self, stiffness: N, memory: &[M], r: N) -> N {
        let elongation = self.load(memory, r) / self.stiffness;
        N::from(0.5) * stiffness * elongation * elongation
    }

    /// Power that it turns into heat at r.
    pub(super) fn dissipated_power<M: Number + Into<N>>(
        &self,
        memory: &[M],
        r: N,
        velocity: N,
    ) -> N {
        let one = N::from(1.0);
        let w = self.load(memory, r) / self.limit;
        let against = N::from(velocity.value().signum()) * w;
        let speed = N::from(velocity.value().signum()) * velocity;
        if against.value() >= 1.0 - 1e-12 {
            return self.limit * speed;
        }
        // p_m (1 − c) w²/(1 − c s w) |ẋ|
        self.limit * (one - self.sharpness) * w * w / (one - self.sharpness * against) * speed
    }

    /// Moves the memory on to r, and returns the heat, J: of what a lower limit no longer holds, and of the way.
    pub(super) fn commit(&self, memory: &mut [N], r: N) -> f64 {
        if memory.len() <= DIRECTION {
            return 0.0;
        }
        memory[LOAD] = self.load_of_now(memory);
        if let Some(stiffness) = memory.get_mut(STIFFNESS) {
            *stiffness = self.stiffness;
        }
        let released = release(memory, self.limit, self.stiffness);
        if r.value() == memory[PLACE].value() {
            return released;
        }
        let way = self.way(memory, r);
        let heat = self.limit * self.limit / self.stiffness * self.heat(&way);
        memory[LOAD] = N::from(way.sign) * self.limit * (way.before + way.growth);
        memory[PLACE] = r;
        memory[DIRECTION] = N::from(way.sign);
        // rounding apart, no way gives heat back
        released + heat.value().max(0.0)
    }

    /// Heat of a way in p_m²/E₁.
    fn heat(&self, way: &Way<N>) -> N {
        let (before, after) = (way.before, way.before + way.growth);
        if self.sharpness.value() >= 1.0 {
            return way.length - way.growth;
        }
        // (1−c) ∫ w²/(1−w) dw
        let integral = if before.value().abs().max(after.value().abs()) < SERIES_BELOW {
            series(after) - series(before)
        } else {
            -way.logarithm - way.growth * (N::from(1.0) + N::from(0.5) * (before + after))
        };
        (N::from(1.0) - self.sharpness) * integral
    }
}

/// Takes off the remembered load what a limit does not hold, in place, and returns its heat, J: what the spring of this
/// stiffness gives up.
pub(super) fn release<N: Number>(memory: &mut [N], limit: N, stiffness: N) -> f64 {
    let load = memory[LOAD];
    if load.value().abs() <= limit.value() {
        return 0.0;
    }
    let held = N::from(load.value().signum()) * limit;
    memory[LOAD] = held;
    // (p² − p_m²)/(2 E₁)
    (N::from(0.5) * (load - held) * (load + held) / stiffness).value()
}

/// The same where nothing presses any more: all goes, and the joint moves on to r without load.
pub(super) fn release_all<N: Number>(memory: &mut [N], stiffness: N, r: N) -> f64 {
    if memory.len() <= DIRECTION {
        return 0.0;
    }
    memory[PLACE] = r;
    if stiffness.value() <= 0.0 {
        memory[LOAD] = N::ZERO;
        return 0.0;
    }
    if let Some(then) = memory.get(STIFFNESS).copied()
        && !then.is_zero()
    {
        memory[LOAD] = memory[LOAD] * stiffness / then;
    }
    release(memory, N::ZERO, stiffness)
}

/// ℓ < 0 with c y (1 − e^ℓ) − (1−c) ℓ = ξ.
fn logarithm(c: f64, left: f64, length: f64) -> f64 {
    // Newton's method for a concave function, from the side on which it does not overshoot
    let mut at = -(length - c * left).max(0.0) / (1.0 - c);
    for _ in 0..100 {
        let missing = c * left * elementary::exp_m1(at) + (1.0 - c) * at + length;
        let slope = c * left * elementary::exp(at) + 1.0 - c;
        let next = at - missing / slope;
        let step = (next - at).abs();
        at = next;
        if step.is_nan() || step <= 1e-15 * at.abs() {
            break;
        }
    }
    at
}

/// Up to which |w| the series below is taken.
const SERIES_BELOW: f64 = 0.25;

/// −ln(1−w) − w − ½w² = Σ wᵏ/k from k = 3, without the cancellation.
fn series<N: Number>(w: N) -> N {
    let terms = (3..30).rev().map(|k| N::from(1.0 / f64::from(k)));
    let sum = terms.fold(N::ZERO, |sum, term| sum * w + term);
    w * w * w * sum
}
