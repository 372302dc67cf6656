//! Ways of the Bouc–Wen law in its own units and in their own direction, by the integrals of its equation.
//!
//! While the load w resists the motion, dw/dx = 1 − q wⁿ with q = β + γ; while it helps, dw/dx = 1 + q |w|ⁿ with q = β
//! − γ. The way is x = ∫ dw/(1 ∓ q wⁿ), the heat q ∫ w^(n+1) dx. Both are hypergeometric functions, which are summed
//! where they converge quickly: in m = q wⁿ up to one half, and in what is left to 1 beyond, where w approaches its
//! limit.

use crate::{elementary, number::Number};

/// What the parameters give.
#[derive(Clone, Copy, Debug)]
pub(super) struct Branch<N> {
    /// n
    pub(super) exponent: N,
    /// β + γ ≥ 0
    pub(super) loading: N,
    /// β − γ ≥ 0
    pub(super) unloading: N,
}

/// The end of a way.
#[derive(Clone, Copy, Debug)]
pub(super) struct Way<N> {
    /// w there, positive where it resists the motion.
    pub(super) after: N,
    /// Heat of the way.
    pub(super) heat: f64,
}

/// Most steps of Newton's method; they are far fewer.
const STEPS_MAX: usize = 100;

/// Below which share of a step nothing changes.
const SMALL: f64 = 1e-16;

/// Up to which part of its distance from where the rate is not smooth a way is short.
const SHORT: f64 = 0.2;

/// What a short way must leave to the limit.
const CLEAR_OF_LIMIT: f64 = 1e-6;

/// What is left to the limit where the load stays.
const AT_LIMIT: f64 = 1e-15;

impl<N: Number> Branch<N> {
    /// The way of this length from w.
    pub(super) fn way(&self, w: N, length: N) -> Way<N> {
        self.way_by::<true>(w, length)
    }

    /// w at the end of the way of this length from w.
    pub(super) fn load(&self, w: N, length: N) -> N {
        self.way_by::<false>(w, length).after
    }

    /// That, with its heat or without.
    fn way_by<const IS_HEAT: bool>(&self, w: N, length: N) -> Way<N> {
        let [start, x] = [w, length].map(Number::value);
        let plain = self.plain();
        if x == 0.0 || !self.is_fixed() || plain.rate(start) <= AT_LIMIT {
            return self.way_of_all::<IS_HEAT>(w, length);
        }
        let way = plain.way_of_all::<IS_HEAT>(start, x);
        let (by_start, by_length) = (w - N::from(start), length - N::from(x));
        let mut after = N::from(way.after);
        if !(by_start.is_zero() && by_length.is_zero()) {
            // where the start and the length alone change: dw′ = (dw′/dx) (dx + dw/(dw/dx)), as the equation knows no x
            let slope = plain.rate(way.after);
            let share = slope / plain.rate(start);
            after = after + N::from(slope) * by_length + N::from(share) * by_start;
        }
        Way {
            after,
            heat: way.heat,
        }
    }

    /// Whether the parameters do not change.
    fn is_fixed(&self) -> bool {
        let parameters = [self.exponent, self.loading, self.unloading];
        parameters
            .iter()
            .all(|&own| (own - N::from(own.value())).is_zero())
    }

    /// The way, whatever changes.
    fn way_of_all<const IS_HEAT: bool>(&self, w: N, length: N) -> Way<N> {
        if length.value() == 0.0 {
            // w moves with the length
            return Way {
                after: w + self.rate(w) * length,
                heat: 0.0,
            };
        }
        if let Some(way) = self.short_way(w, length) {
            return way;
        }
        let plain = self.plain();
        if w.value() >= 0.0 {
            return self.loaded::<IS_HEAT>(w, length);
        }
        // until there is no load left
        let whole = self.unloading_way(-w);
        if length.value() >= whole.value() {
            let loaded = self.loaded::<IS_HEAT>(N::ZERO, length - whole);
            return Way {
                heat: loaded.heat + heat_where::<IS_HEAT>(|| plain.unloading_heat(-w.value())),
                ..loaded
            };
        }
        let left = whole - length;
        let at = plain.unloaded(left.value());
        // a step of Newton's method from the root has the root's changes
        let missing = self.unloading_way(N::from(at)) - left;
        let slope = 1.0 + plain.unloading * at.powf_of(plain.exponent);
        let after = N::from(at) - missing * N::from(slope);
        let heat =
            heat_where::<IS_HEAT>(|| plain.unloading_heat(-w.value()) - plain.unloading_heat(at));
        Way {
            after: -after,
            heat: heat.max(0.0),
        }
    }

    /// A way that is short beside its distance from no load and from the limit: quadrature is quicker there than
    /// series.
    fn short_way(&self, w: N, length: N) -> Option<Way<N>> {
        let plain = self.plain();
        let (from, x) = (w.value(), length.value());
        let rate = plain.rate(from);
        let is_short = rate.max(1.0) * x * plain.exponent <= SHORT * from.abs();
        if !(is_short && x > 0.0 && rate > CLEAR_OF_LIMIT) {
            return None;
        }
        let mut to = from + rate * x;
        for _ in 0..STEPS_MAX {
            let [found, _] = plain.quadrature(from, to);
            let step = (found - x) * plain.rate(to);
            to -= step;
            if step.abs() <= SMALL * to.abs() {
                break;
            }
        }
        // a step of Newton's method from the root has the root's changes
        let [found, heat] = self.quadrature(w, N::from(to));
        let after = N::from(to) - (found - length) * N::from(plain.rate(to));
        Some(Way {
            after,
            heat: heat.value(),
        })
    }

    /// Length and heat of the way between two loads of the same sign, by the rule of Gauss and Legendre with eight
    /// points.
    fn quadrature(&self, from: N, to: N) -> [N; 2] {
        const RULE: [(f64, f64); 4] = [
            (0.183_434_642_495_649_8, 0.362_683_783_378_362),
            (0.525_532_409_916_329, 0.313_706_645_877_887_27),
            (0.796_666_477_413_626_7, 0.222_381_034_453_374_48),
            (0.960_289_856_497_536_3, 0.101_228_536_290_376_26),
        ];
        let half = N::from(0.5) * (to - from);
        let middle = N::from(0.5) * (to + from);
        let (q, sign) = if middle.value() < 0.0 {
            (-self.unloading, -1.0)
        } else {
            (self.loading, 1.0)
        };
        let mut sums = [N::ZERO; 2];
        for (node, weight) in RULE {
            for node in [node, -node] {
                let w = N::from(sign) * (middle + N::from(node) * half);
                let m = q * w.powf(self.exponent);
                let each = N::from(weight) * half / (N::from(1.0) - m);
                sums[0] = sums[0] + each;
                // |q| |w|^(n+1) dx
                sums[1] = sums[1] + N::from(sign) * m * w * each;
            }
        }
        sums
    }

    /// The way of this length from w ≥ 0.
    fn loaded<const IS_HEAT: bool>(&self, w: N, length: N) -> Way<N> {
        let plain = self.plain();
        let one = N::from(1.0);
        let m = self.loading * w.powf(self.exponent);
        if m.value() >= 1.0 - AT_LIMIT {
            // q w^(n+1) over the way, at the limit
            let limit = self.limit();
            return Way {
                after: limit,
                heat: (limit * length).value(),
            };
        }
        if length.value() == 0.0 {
            // w moves with the length, 1 − m
            return Way {
                after: w + (one - m) * length,
                heat: 0.0,
            };
        }
        let target = self.loading_way(w, m) + length;
        let (at, missing_part, heat) = plain.loaded_to::<IS_HEAT>(target.value());
        let before = heat_where::<IS_HEAT>(|| plain.loading_heat(w.value(), m.value()));
        let heat = (heat - before).max(0.0);
        if missing_part <= AT_LIMIT {
            return Way {
                after: self.limit(),
                heat,
            };
        }
        let at_m = self.loading * N::from(at).powf(self.exponent);
        let missing = self.loading_way(N::from(at), at_m) - target;
        Way {
            after: N::from(at) - missing * N::from(missing_part),
            heat,
        }
    }

    /// q^(−1/n), which the load approaches.
    fn limit(&self) -> N {
        self.loading.powf(-(N::from(1.0) / self.exponent))
    }

    /// x from no load to w ≥ 0, where m = q wⁿ < 1.
    fn loading_way(&self, w: N, m: N) -> N {
        let a = N::from(1.0) / self.exponent;
        if m.value() <= 0.5 {
            return w * hypergeometric(a, m);
        }
        // x = x½ + (1/n) q^(−1/n) ∫ (1−ε)^(1/n − 1) dε/ε from ε = ½ down to 1 − m
        let half = N::from(0.5);
        let at_half = self.limit() * half.powf(a);
        at_half * hypergeometric(a, half)
            + a * self.limit() * tail(a - N::from(1.0), N::from(1.0) - m)
    }

    /// x from w = −y to no load.
    pub(super) fn unloading_way(&self, y: N) -> N {
        let a = N::from(1.0) / self.exponent;
        y * hypergeometric(a, -(self.unloading * y.powf(self.exponent)))
    }

    /// dw/dx
    pub(super) fn rate(&self, w: N) -> N {
        let (q, size) = if w.value() < 0.0 {
            (-self.unloading, -w)
        } else {
            (self.loading, w)
        };
        N::from(1.0) - q * size.powf(self.exponent)
    }

    fn plain(&self) -> Branch<f64> {
        Branch {
            exponent: self.exponent.value(),
            loading: self.loading.value(),
            unloading: self.unloading.value(),
        }
    }
}

impl Branch<f64> {
    /// Where x from no load is reached: w, 1 − m there, and the heat of all of it.
    fn loaded_to<const IS_HEAT: bool>(&self, target: f64) -> (f64, f64, f64) {
        let a = 1.0 / self.exponent;
        if self.loading == 0.0 {
            return (target, 1.0, 0.0);
        }
        let limit = self.limit();
        let half = limit * 0.5.powf_of(a);
        let way_to_half = half * hypergeometric(a, 0.5);
        if target <= way_to_half {
            // x(w) is convex and at least w
            let mut w = target.min(half);
            for _ in 0..STEPS_MAX {
                let m = self.loading * w.powf_of(self.exponent);
                let step = (self.loading_way(w, m) - target) * (1.0 - m);
                w -= step;
                if step.abs() <= SMALL * w {
                    break;
                }
            }
            let m = self.loading * w.powf_of(self.exponent);
            let heat = heat_where::<IS_HEAT>(|| self.loading_heat(w, m));
            return (w, 1.0 - m, heat);
        }
        // over θ = −ln ε, in which x is concave
        let (scale, ln_2) = (a * limit, std::f64::consts::LN_2);
        let mut theta = ln_2;
        for _ in 0..STEPS_MAX {
            let left = elementary::exp(-theta);
            let found = way_to_half + scale * (theta - ln_2 + series(a - 1.0, left));
            let step = (target - found) / (scale * (1.0 - left).powf_of(a - 1.0));
            theta += step;
            if step.abs() <= SMALL * theta {
                break;
            }
        }
        let left = elementary::exp(-theta);
        let heat = heat_where::<IS_HEAT>(|| {
            self.heat_to_half() + a * limit * limit * (theta - ln_2 + series(2.0 * a, left))
        });
        (limit * (1.0 - left).powf_of(a), left, heat)
    }

    /// Heat from no load to w ≥ 0, where m = q wⁿ < 1.
    fn loading_heat(&self, w: f64, m: f64) -> f64 {
        let a = 1.0 / self.exponent;
        if m <= 0.5 {
            // q ∫ w^(n+1)/(1−q wⁿ) dw
            return m * w * w / (self.exponent + 2.0) * hypergeometric(1.0 + 2.0 * a, m);
        }
        let limit = self.limit();
        self.heat_to_half() + a * limit * limit * tail(2.0 * a, 1.0 - m)
    }

    fn heat_to_half(&self) -> f64 {
        let a = 1.0 / self.exponent;
        let half = self.limit() * 0.5.powf_of(a);
        self.loading_heat(half, 0.5)
    }

    /// Heat from w = −y to no load.
    fn unloading_heat(&self, y: f64) -> f64 {
        let (a, m) = (
            1.0 / self.exponent,
            self.unloading * y.powf_of(self.exponent),
        );
        m * y * y / (self.exponent + 2.0) * hypergeometric(1.0 + 2.0 * a, -m)
    }

    /// Where x is left to no load: y.
    fn unloaded(&self, left: f64) -> f64 {
        // x(y) is concave and at most y
        let mut y = left;
        for _ in 0..STEPS_MAX {
            let slope = 1.0 + self.unloading * y.powf_of(self.exponent);
            let step = (left - self.unloading_way(y)) * slope;
            y += step;
            if step.abs() <= SMALL * y {
                break;
            }
        }
        y
    }
}

/// Heat where it is asked for.
fn heat_where<const IS_HEAT: bool>(heat: impl FnOnce() -> f64) -> f64 {
    if IS_HEAT { heat() } else { 0.0 }
}

/// ₂F₁(1, b; 1+b; m) for m from −∞ to ½.
fn hypergeometric<N: Number>(b: N, m: N) -> N {
    let one = N::from(1.0);
    if m.value() < 0.0 {
        // Pfaff: ₂F₁(1, b; 1+b; m) = ₂F₁(1, 1; 1+b; m/(m−1))/(1−m)
        let argument = m / (m - one);
        let (mut term, mut sum) = (one, one);
        for k in 0..TERMS_MAX {
            let k = N::from(f64::from(k));
            term = term * (k + one) / (k + one + b) * argument;
            sum = sum + term;
            if term.value() <= SMALL * sum.value() {
                break;
            }
        }
        return sum / (one - m);
    }
    let (mut power, mut sum) = (one, one);
    for k in 1..TERMS_MAX {
        power = power * m;
        let term = power * b / (b + N::from(f64::from(k)));
        sum = sum + term;
        if term.value() <= SMALL * sum.value() {
            break;
        }
    }
    sum
}

/// ∫ (1−ε)^p dε/ε from `left` to ½.
fn tail<N: Number>(p: N, left: N) -> N {
    let logarithm = left.chain(-elementary::ln(left.value()), -1.0 / left.value());
    logarithm - N::from(std::f64::consts::LN_2) + series(p, left)
}

/// That but for the logarithm: Σ cₖ (2⁻ᵏ − εᵏ)/k, where (1−ε)^p = Σ cₖ εᵏ.
fn series<N: Number>(p: N, left: N) -> N {
    let one = N::from(1.0);
    let (mut coefficient, mut power, mut half) = (one, one, 1.0);
    let mut sum = N::ZERO;
    for k in 1..TERMS_MAX {
        let number = N::from(f64::from(k));
        coefficient = coefficient * (number - one - p) / number;
        power = power * left;
        half *= 0.5;
        sum = sum + coefficient * (N::from(half) - power) / number;
        if half <= SMALL {
            break;
        }
    }
    sum
}

/// Most terms of a series; near γ = −β they converge slowly.
const TERMS_MAX: u32 = 20_000;

/// x^y as the laws have it on every platform.
trait Power {
    fn powf_of(self, exponent: f64) -> f64;
}

impl Power for f64 {
    #[inline]
    fn powf_of(self, exponent: f64) -> f64 {
        Number::powf(self, exponent)
    }
}
