//! Time integration of the lap model, under held loads and under loads that change within a step.

mod higher;

use std::{array::from_fn, num::NonZeroU32};

use crate::{
    lap::{Body, Lap, LapLoads, LapState},
    law::Polynomial,
    motion::Motion,
    pair::Pair,
};
use higher::Higher;

/// The lap model made ready for stepping: all coefficients are divided by the inertias once.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LapIntegrator<const D: usize> {
    /// 1/m
    mobility: [Pair; D],
    /// k/m of the supports.
    support: [Pair; D],
    /// K/m of the joint.
    joint: [[Pair; D]; D],
    /// k3/m of the joint.
    cubic: [Pair; D],
    damping: Damping<D>,
    /// The joint's terms of higher order; `None` where it has none, so that nothing is spent on them.
    higher: Option<Higher<D>>,
    has_memory: bool,
}

/// The dampers of supports and joint, as a linear map of velocities to accelerations.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Damping<const D: usize> {
    /// c/m of the supports.
    support: [Pair; D],
    /// C/m of the joint.
    joint: [[Pair; D]; D],
}

/// What a step needs of its length h.
struct Step<const D: usize> {
    /// h
    length_s: f64,
    /// The dampers times h/2 and h.
    half_damping: Damping<D>,
    full_damping: Damping<D>,
}

impl<const D: usize> LapIntegrator<D> {
    /// Prepares `lap` for stepping. Its inertias must be positive: [`Lap::defect`] tells.
    #[must_use]
    pub fn new(lap: &Lap<D>) -> Self {
        let over_inertia =
            |i: usize, a: f64, b: f64| Pair::new(a / lap.a.inertia[i], b / lap.b.inertia[i]);
        let of_bodies = |value: fn(&Body<D>, usize) -> f64| {
            from_fn(|i| over_inertia(i, value(&lap.a, i), value(&lap.b, i)))
        };
        let of_joint = |matrix: &[[f64; D]; D]| {
            from_fn(|i| from_fn(|j| over_inertia(i, matrix[i][j], matrix[i][j])))
        };
        let law = &lap.joint;
        let polynomials = law.polynomials();
        Self {
            mobility: of_bodies(|_, _| 1.0),
            support: of_bodies(|body, i| body.stiffness[i]),
            joint: of_joint(&law.linear.stiffness),
            cubic: from_fn(|i| {
                over_inertia(i, polynomials[i].springs[0], polynomials[i].springs[0])
            }),
            damping: Damping {
                support: of_bodies(|body, i| body.damping[i]),
                joint: of_joint(&law.linear.damping),
            },
            higher: (!polynomials.iter().all(Polynomial::is_cubic)).then(|| Higher::new(lap)),
            has_memory: law.has_memory(),
        }
    }

    /// Whether the joint has no cubic and no higher term, so that the equations of motion are linear.
    #[inline]
    #[must_use]
    pub fn is_linear(&self) -> bool {
        !self.has_memory
            && self.higher.is_none()
            && self.cubic.iter().all(|&cubic| cubic == Pair::both(0.0))
    }

    /// State after `interval_s` (s) in `substeps` equal RK4 steps, the loads held; it ends exactly at the interval's end.
    #[inline(always)]
    #[must_use]
    pub fn advance(
        &self,
        state: &LapState<D>,
        loads: &LapLoads<D>,
        interval_s: f64,
        substeps: NonZeroU32,
    ) -> LapState<D> {
        match &self.higher {
            None => self.advance_without_higher(state, loads, interval_s, substeps),
            Some(higher) => self.advance_higher(higher, state, loads, interval_s, substeps),
        }
    }

    /// Whether the joint remembers its motion. Such a lap is stepped by [`crate::LapConditions::step`], not by this.
    #[inline]
    #[must_use]
    pub fn has_memory(&self) -> bool {
        self.has_memory
    }

    /// Whether the joint has terms of higher order.
    #[inline]
    #[must_use]
    pub fn has_higher(&self) -> bool {
        self.higher.is_some()
    }

    /// What [`LapIntegrator::advance`] gives where [`LapIntegrator::has_higher`] says no, for those who have asked before;
    /// terms of higher order are left out.
    #[inline(always)]
    #[must_use]
    pub fn advance_without_higher(
        &self,
        state: &LapState<D>,
        loads: &LapLoads<D>,
        interval_s: f64,
        substeps: NonZeroU32,
    ) -> LapState<D> {
        // A single step in place spares the way through memory; with one DOF the bodies then fall apart into single
        // numbers, which costs more than that way.
        let (x, v) = if D > 1 && substeps == NonZeroU32::MIN {
            let load = self.accelerations_by(loads);
            let (x, v) = split(state);
            self.take(&self.step(interval_s), &x, &v, [&load; 3])
        } else {
            self.take_many(state, loads, interval_s, substeps)
        };
        join(&x, &v)
    }

    /// Equal steps under held loads. Apart from all else, so that the bodies stay side by side in the registers.
    #[inline(never)]
    fn take_many(
        &self,
        state: &LapState<D>,
        loads: &LapLoads<D>,
        interval_s: f64,
        count: NonZeroU32,
    ) -> ([Pair; D], [Pair; D]) {
        let step = self.step(interval_s / f64::from(count.get()));
        let load = self.accelerations_by(loads);
        let (mut x, mut v) = split(state);
        for _ in 0..count.get() {
            (x, v) = self.take(&step, &x, &v, [&load; 3]);
        }
        (x, v)
    }

    /// State after one RK4 step of `step_s` (s) under loads that change: `loads` at its start, its middle and its end.
    ///
    /// With three equal loads this is one substep of [`LapIntegrator::advance`], to the last bit.
    #[inline]
    #[must_use]
    pub fn step_with_loads(
        &self,
        state: &LapState<D>,
        loads: &[LapLoads<D>; 3],
        step_s: f64,
    ) -> LapState<D> {
        let loads = loads.each_ref().map(|loads| self.accelerations_by(loads));
        let (x, v) = split(state);
        let (x, v) = match &self.higher {
            None => self.take(&self.step(step_s), &x, &v, loads.each_ref()),
            Some(higher) => self.take_higher(higher, step_s, &x, &v, loads.each_ref()),
        };
        join(&x, &v)
    }

    /// Rate of change of the state: velocities and accelerations.
    #[inline]
    #[must_use]
    pub fn rate(&self, state: &LapState<D>, loads: &LapLoads<D>) -> LapState<D> {
        // ẍ = M⁻¹ (F − k x − c ẋ ∓ F_joint)   (Pirdayr's equations of motion)
        let (x, v) = split(state);
        let load = self.accelerations_by(loads);
        let acceleration = match &self.higher {
            None => self.less_springs(&self.damping.less(&load, &v), &x),
            Some(higher) => self.less_all(higher, &load, &x, &v),
        };
        join(&v, &acceleration)
    }

    /// M⁻¹ F
    #[inline]
    fn accelerations_by(&self, loads: &LapLoads<D>) -> [Pair; D] {
        from_fn(|i| Pair::new(loads.a[i], loads.b[i]) * self.mobility[i])
    }

    /// What is left of `acceleration` after the springs have taken their share.
    #[inline]
    fn less_springs(&self, acceleration: &[Pair; D], x: &[Pair; D]) -> [Pair; D] {
        // − M⁻¹ (k x + K r + k3 ∘ r³), where r is x_a − x_b for body a and x_b − x_a for body b
        let r = x.map(Pair::relative);
        from_fn(|i| {
            let cubic = (self.cubic[i] * r[i]) * (r[i] * r[i]);
            acceleration[i] - self.support[i] * x[i] - dot(&self.joint[i], &r) - cubic
        })
    }

    /// What a step of `length_s` (s) needs.
    #[inline]
    fn step(&self, length_s: f64) -> Step<D> {
        Step {
            length_s,
            half_damping: self.damping.times(0.5 * length_s),
            full_damping: self.damping.times(length_s),
        }
    }

    /// One RK4 step, with the accelerations that the loads give at its start, middle and end.
    #[inline(always)]
    fn take(
        &self,
        step: &Step<D>,
        x: &[Pair; D],
        v: &[Pair; D],
        [start, middle, end]: [&[Pair; D]; 3],
    ) -> ([Pair; D], [Pair; D]) {
        let h = step.length_s;
        let (half, sixth) = (0.5 * h, (1.0 / 6.0) * h);
        // With f the springs and loads and c the dampers, the four stages of ẋ = v, v̇ = f(t, x) − c(v) are as below.
        // Every sum takes last what is known last, so that as little as possible waits for it.
        // a₁ = f(t, x) − c(v)
        let a1 = self.less_springs(&self.damping.less(start, v), x);
        // a₂ = f(t + h/2, x + h/2 v) − c(v) − h/2 c(a₁)
        let middle = self.damping.less(middle, v);
        let x2 = moved(x, half, v);
        let a2 = step
            .half_damping
            .less(&self.less_springs(&middle, &x2), &a1);
        // a₃ = f(t + h/2, x + h/2 v + h²/4 a₁) − c(v) − h/2 c(a₂)
        let x3 = moved(&x2, half * half, &a1);
        let a3 = step
            .half_damping
            .less(&self.less_springs(&middle, &x3), &a2);
        // a₄ = f(t + h, x + h v + h²/2 a₂) − c(v) − h c(a₃)
        let end = self.damping.less(end, v);
        let x1 = moved(&x2, half, v);
        let x4 = moved(&x1, half * h, &a2);
        let a4 = step.full_damping.less(&self.less_springs(&end, &x4), &a3);
        // x(t+h) = x + h v + h²/6 (a₁ + a₂ + a₃),  v(t+h) = v + h/6 (a₁ + 2a₂ + 2a₃ + a₄)
        let inner: [Pair; D] = from_fn(|i| a1[i] + a2[i] + a3[i]);
        let outer: [Pair; D] = from_fn(|i| inner[i] + a2[i] + a3[i]);
        (
            moved(&x1, h * sixth, &inner),
            moved(&moved(v, sixth, &outer), sixth, &a4),
        )
    }
}

impl<const D: usize> Damping<D> {
    /// What is left of `acceleration` after the dampers have taken their share at these velocities.
    #[inline]
    fn less(&self, acceleration: &[Pair; D], v: &[Pair; D]) -> [Pair; D] {
        // − M⁻¹ (c v + C ṙ)
        let r = v.map(Pair::relative);
        from_fn(|i| acceleration[i] - self.support[i] * v[i] - dot(&self.joint[i], &r))
    }

    #[inline]
    fn times(&self, factor: f64) -> Self {
        Self {
            support: self.support.map(|c| c * factor),
            joint: self.joint.map(|row| row.map(|c| c * factor)),
        }
    }
}

#[inline]
fn dot<const D: usize>(row: &[Pair; D], vector: &[Pair; D]) -> Pair {
    let mut sum = row[0] * vector[0];
    for j in 1..D {
        sum = sum + row[j] * vector[j];
    }
    sum
}

/// `x + factor · by`
#[inline]
fn moved<const D: usize>(x: &[Pair; D], factor: f64, by: &[Pair; D]) -> [Pair; D] {
    from_fn(|i| x[i] + by[i] * factor)
}

/// Displacements and velocities.
#[inline]
fn split<const D: usize>(state: &LapState<D>) -> ([Pair; D], [Pair; D]) {
    let LapState { a, b } = state;
    let pairs = |a: &[f64; D], b: &[f64; D]| from_fn(|i| Pair::new(a[i], b[i]));
    (
        pairs(&a.displacement, &b.displacement),
        pairs(&a.velocity, &b.velocity),
    )
}

/// Inverse of [`split`].
#[inline]
fn join<const D: usize>(x: &[Pair; D], v: &[Pair; D]) -> LapState<D> {
    LapState {
        a: Motion {
            displacement: x.map(|pair| pair.a),
            velocity: v.map(|pair| pair.a),
        },
        b: Motion {
            displacement: x.map(|pair| pair.b),
            velocity: v.map(|pair| pair.b),
        },
    }
}

#[cfg(test)]
mod tests;
