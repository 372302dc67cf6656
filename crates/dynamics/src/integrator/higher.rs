//! Steps of a lap whose joint has terms of higher order. Its damping depends on the displacement, so that the stages
//! cannot share the dampers' part as those of a cubic joint do; these steps are apart, and cost the others nothing.

use std::{array::from_fn, num::NonZeroU32};

use super::{LapIntegrator, join, moved, split};
use crate::{
    lap::{Lap, LapLoads, LapState},
    law::{DAMPER_COUNT, SPRING_COUNT},
    pair::Pair,
};

/// The joint's terms of higher order over the inertias.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Higher<const D: usize> {
    /// k5/m, k7/m, …
    springs: [[Pair; SPRING_COUNT - 1]; D],
    /// c2/m, c4/m, …
    dampers: [[Pair; DAMPER_COUNT]; D],
}

impl<const D: usize> Higher<D> {
    pub(super) fn new(lap: &Lap<D>) -> Self {
        let polynomials = lap.joint.polynomials();
        let of_bodies =
            |i: usize, term: f64| Pair::new(term / lap.a.inertia[i], term / lap.b.inertia[i]);
        Self {
            springs: from_fn(|i| from_fn(|j| of_bodies(i, polynomials[i].springs[j + 1]))),
            dampers: from_fn(|i| polynomials[i].dampers.map(|term| of_bodies(i, term))),
        }
    }

    /// What is left of `acceleration` after these terms have taken their share.
    #[inline]
    fn less(&self, acceleration: &[Pair; D], x: &[Pair; D], v: &[Pair; D]) -> [Pair; D] {
        // − M⁻¹ (k5 ∘ r⁵ + k7 ∘ r⁷ + (c2 ∘ r² + c4 ∘ r⁴) ∘ ṙ), each body's r as seen from the other
        from_fn(|i| {
            let (r, velocity) = (x[i].relative(), v[i].relative());
            let squared = r * r;
            let spring = sum(&self.springs[i], squared) * (squared * squared) * r;
            let damper = sum(&self.dampers[i], squared) * squared;
            acceleration[i] - spring - damper * velocity
        })
    }
}

/// Σ cⱼ uʲ
#[inline]
fn sum<const N: usize>(coefficients: &[Pair; N], u: Pair) -> Pair {
    let mut sum = coefficients[N - 1];
    for j in (0..N - 1).rev() {
        sum = coefficients[j] + sum * u;
    }
    sum
}

impl<const D: usize> LapIntegrator<D> {
    /// What is left of `acceleration` after all springs and dampers have taken their share.
    #[inline]
    pub(super) fn less_all(
        &self,
        higher: &Higher<D>,
        acceleration: &[Pair; D],
        x: &[Pair; D],
        v: &[Pair; D],
    ) -> [Pair; D] {
        let left = self.less_springs(&self.damping.less(acceleration, v), x);
        higher.less(&left, x, v)
    }

    /// Equal steps under held loads. Out of the way of the others, which are quicker if nothing of this is among them.
    #[cold]
    #[inline(never)]
    pub(super) fn advance_higher(
        &self,
        higher: &Higher<D>,
        state: &LapState<D>,
        loads: &LapLoads<D>,
        interval_s: f64,
        count: NonZeroU32,
    ) -> LapState<D> {
        let length_s = interval_s / f64::from(count.get());
        let load = self.accelerations_by(loads);
        let (mut x, mut v) = split(state);
        for _ in 0..count.get() {
            (x, v) = self.take_higher(higher, length_s, &x, &v, [&load; 3]);
        }
        join(&x, &v)
    }

    /// One RK4 step, with the accelerations that the loads give at its start, middle and end.
    #[inline]
    pub(super) fn take_higher(
        &self,
        higher: &Higher<D>,
        h: f64,
        x: &[Pair; D],
        v: &[Pair; D],
        [start, middle, end]: [&[Pair; D]; 3],
    ) -> ([Pair; D], [Pair; D]) {
        let (half, sixth) = (0.5 * h, (1.0 / 6.0) * h);
        // The four stages of ẋ = v, v̇ = f(t, x, v):
        // a₁ = f(t, x, v)
        let a1 = self.less_all(higher, start, x, v);
        // a₂ = f(t + h/2, x + h/2 v, v + h/2 a₁)
        let x2 = moved(x, half, v);
        let v2 = moved(v, half, &a1);
        let a2 = self.less_all(higher, middle, &x2, &v2);
        // a₃ = f(t + h/2, x + h/2 v + h²/4 a₁, v + h/2 a₂)
        let x3 = moved(&x2, half * half, &a1);
        let v3 = moved(v, half, &a2);
        let a3 = self.less_all(higher, middle, &x3, &v3);
        // a₄ = f(t + h, x + h v + h²/2 a₂, v + h a₃)
        let x1 = moved(x, h, v);
        let x4 = moved(&x1, half * h, &a2);
        let v4 = moved(v, h, &a3);
        let a4 = self.less_all(higher, end, &x4, &v4);
        // x(t+h) = x + h v + h²/6 (a₁ + a₂ + a₃),  v(t+h) = v + h/6 (a₁ + 2a₂ + 2a₃ + a₄)
        let inner: [Pair; D] = from_fn(|i| a1[i] + a2[i] + a3[i]);
        let outer: [Pair; D] = from_fn(|i| inner[i] + a2[i] + a3[i]);
        (
            moved(&x1, h * sixth, &inner),
            moved(&moved(v, sixth, &outer), sixth, &a4),
        )
    }
}
