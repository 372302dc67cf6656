//! Time integration of the lap model, under held loads and under loads that change within a step.

use std::{array::from_fn, num::NonZeroU32};

use crate::{
    joint::Motion,
    lap::{Body, Lap, LapLoads, LapState},
    pair::Pair,
};

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
        Self {
            mobility: of_bodies(|_, _| 1.0),
            support: of_bodies(|body, i| body.stiffness[i]),
            joint: of_joint(&law.stiffness),
            cubic: from_fn(|i| over_inertia(i, law.cubic[i], law.cubic[i])),
            damping: Damping {
                support: of_bodies(|body, i| body.damping[i]),
                joint: of_joint(&law.damping),
            },
        }
    }

    /// Whether the joint has no cubic term, so that the equations of motion are linear.
    #[inline]
    #[must_use]
    pub fn is_linear(&self) -> bool {
        self.cubic.iter().all(|&cubic| cubic == Pair::both(0.0))
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
        let (x, v) = self.take(&self.step(step_s), &x, &v, loads.each_ref());
        join(&x, &v)
    }

    /// Rate of change of the state: velocities and accelerations.
    #[inline]
    #[must_use]
    pub fn rate(&self, state: &LapState<D>, loads: &LapLoads<D>) -> LapState<D> {
        // ẍ = M⁻¹ (F − k x − c ẋ ∓ F_joint)   (Pirdayr's equations of motion)
        let (x, v) = split(state);
        let load = self.accelerations_by(loads);
        join(&v, &self.less_springs(&self.damping.less(&load, &v), &x))
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
mod tests {
    use super::*;
    use crate::joint::JointLaw;

    fn decoupled(support_stiffness: f64, support_damping: f64) -> Lap<1> {
        let body = Body {
            inertia: [2.0],
            stiffness: [support_stiffness],
            damping: [support_damping],
        };
        let joint = JointLaw {
            stiffness: [[0.0]],
            damping: [[0.0]],
            cubic: [0.0],
        };
        Lap {
            joint,
            a: body,
            b: body,
        }
    }

    #[test]
    fn a_damped_oscillator_follows_its_closed_form() {
        // x(t) = e^{−ζωt} (x₀ cos ω_d t + (ζω x₀/ω_d) sin ω_d t)
        let (omega, zeta): (f64, f64) = (50.0, 0.05);
        let lap = decoupled(2.0 * omega * omega, 2.0 * 2.0 * zeta * omega);
        let start = LapState {
            a: Motion {
                displacement: [1e-3],
                velocity: [0.0],
            },
            b: Motion::REST,
        };
        let loads = LapLoads { a: [0.0], b: [0.0] };
        let (duration_s, substeps) = (0.2, NonZeroU32::new(2000).unwrap());
        let end = LapIntegrator::new(&lap).advance(&start, &loads, duration_s, substeps);
        let omega_d = omega * (1.0 - zeta * zeta).sqrt();
        let (sin, cos) = (omega_d * duration_s).sin_cos();
        let expected =
            1e-3 * (-zeta * omega * duration_s).exp() * (cos + zeta * omega / omega_d * sin);
        assert!(
            (end.a.displacement[0] - expected).abs() < 5e-14,
            "{} {expected}",
            end.a.displacement[0]
        );
        assert_eq!(end.b, Motion::REST);
    }

    #[test]
    fn halving_the_step_divides_the_error_by_sixteen() {
        let omega: f64 = 50.0;
        let lap = decoupled(2.0 * omega * omega, 0.0);
        let start = LapState {
            a: Motion {
                displacement: [1.0],
                velocity: [0.0],
            },
            b: Motion::REST,
        };
        let loads = LapLoads { a: [0.0], b: [0.0] };
        let error = |count| {
            let end = LapIntegrator::new(&lap).advance(
                &start,
                &loads,
                0.1,
                NonZeroU32::new(count).unwrap(),
            );
            (end.a.displacement[0] - (omega * 0.1).cos()).abs()
        };
        let ratio = error(50) / error(100);
        assert!((15.0..17.0).contains(&ratio), "{ratio}");
    }

    /// Loads on body a alone at the start, the middle and the end of a step.
    fn on_a(load: impl Fn(f64) -> f64, time_s: f64, step_s: f64) -> [LapLoads<1>; 3] {
        [0.0, 0.5, 1.0].map(|part| LapLoads {
            a: [load(time_s + part * step_s)],
            b: [0.0],
        })
    }

    #[test]
    fn one_step_integrates_a_quadratic_load_on_a_free_body_exactly() {
        // m ẍ = 3 − 4t + 5t²: RK4's weights are Simpson's rule for ẋ, and ∫(h − s) ẍ ds is exact to this degree too
        let integrator = LapIntegrator::new(&decoupled(0.0, 0.0));
        let (m, h): (f64, f64) = (2.0, 0.7);
        let loads = on_a(|t| 3.0 - 4.0 * t + 5.0 * t * t, 0.0, h);
        let end = integrator.step_with_loads(&LapState::REST, &loads, h);
        let velocity = (3.0 * h - 2.0 * h * h + 5.0 / 3.0 * h.powi(3)) / m;
        let displacement = (1.5 * h * h - 2.0 / 3.0 * h.powi(3) + 5.0 / 12.0 * h.powi(4)) / m;
        assert!((end.a.velocity[0] - velocity).abs() < 1e-15);
        assert!((end.a.displacement[0] - displacement).abs() < 1e-15);
        assert_eq!(end.b, Motion::REST);
    }

    #[test]
    fn the_response_to_a_harmonic_load_converges_with_fourth_order() {
        // From rest, m ẍ + k x = F sin Ωt:  x = F/(m (ω² − Ω²)) (sin Ωt − Ω/ω sin ωt)
        let (omega, forcing, duration_s): (f64, f64, f64) = (50.0, 80.0, 0.1);
        let lap = decoupled(2.0 * omega * omega, 0.0);
        let integrator = LapIntegrator::new(&lap);
        let amplitude = 1e3 / (2.0 * (omega * omega - forcing * forcing));
        let expected = amplitude
            * ((forcing * duration_s).sin() - forcing / omega * (omega * duration_s).sin());
        let error = |count: u32| {
            let step_s = duration_s / f64::from(count);
            let mut state = LapState::REST;
            for n in 0..count {
                let loads = on_a(|t| 1e3 * (forcing * t).sin(), f64::from(n) * step_s, step_s);
                state = integrator.step_with_loads(&state, &loads, step_s);
            }
            ((state.a.displacement[0] - expected) / amplitude).abs()
        };
        for count in [200, 400, 800] {
            let order = (error(count) / error(2 * count)).log2();
            assert!((order - 4.0).abs() < 0.02, "{count} steps: order {order}");
        }
        assert!(error(3200) < 1e-11, "{:e}", error(3200));
    }

    #[test]
    fn equal_loads_at_all_stages_are_held_loads() {
        let mut lap = decoupled(2e4, 3.0);
        lap.joint = JointLaw {
            stiffness: [[7e3]],
            damping: [[0.3]],
            cubic: [1e9],
        };
        let integrator = LapIntegrator::new(&lap);
        let loads = LapLoads {
            a: [12.0],
            b: [-5.0],
        };
        let held = integrator.advance(&LapState::REST, &loads, 4e-3, NonZeroU32::MIN);
        let stepped = integrator.step_with_loads(&LapState::REST, &[loads; 3], 4e-3);
        assert_eq!(held, stepped);
    }

    /// ẋ of the full lap as the equations of motion stand in the textbook, with divisions: `x` has the displacements
    /// of a and b, then their velocities.
    fn textbook_rate(lap: &Lap<2>, x: &[f64; 8], loads: &LapLoads<2>) -> [f64; 8] {
        let r: [f64; 2] = from_fn(|i| x[i] - x[2 + i]);
        let s: [f64; 2] = from_fn(|i| x[4 + i] - x[6 + i]);
        let (stiffness, damping, cubic) =
            (&lap.joint.stiffness, &lap.joint.damping, &lap.joint.cubic);
        let mut rate = [0.0; 8];
        rate[..4].copy_from_slice(&x[4..]);
        for i in 0..2 {
            let mut joint = cubic[i] * r[i].powi(3);
            for j in 0..2 {
                joint += stiffness[i][j] * r[j] + damping[i][j] * s[j];
            }
            let bodies = [(&lap.a, loads.a[i], -joint), (&lap.b, loads.b[i], joint)];
            for (n, (body, load, joint)) in bodies.into_iter().enumerate() {
                let at = 2 * n + i;
                let support = body.stiffness[i] * x[at] + body.damping[i] * x[4 + at];
                rate[4 + at] = (load - support + joint) / body.inertia[i];
            }
        }
        rate
    }

    #[test]
    fn a_step_is_the_textbook_s_four_stages() {
        let body = |scale: f64| Body {
            inertia: [1.41 * scale, 1e-3 / scale],
            stiffness: [8.24e5, 1e3 * scale],
            damping: [200.0 * scale, 0.05],
        };
        let lap = Lap {
            joint: JointLaw {
                stiffness: [[5.73e5, 5.82e3], [5.82e3, 1.29e3]],
                damping: [[108.3, -0.83], [-0.83, 0.083]],
                cubic: [5e12, 1e6],
            },
            a: body(1.0),
            b: body(2.5),
        };
        let integrator = LapIntegrator::new(&lap);
        let step_s = 1e-4;
        let loads: [LapLoads<2>; 3] = from_fn(|n| {
            let n = n as f64;
            LapLoads {
                a: [300.0 - 200.0 * n, 2.0 + n],
                b: [-100.0 + 50.0 * n * n, 3.0 - 2.0 * n],
            }
        });
        let mut state = LapState::REST;
        let mut x = [0.0; 8];
        let mut largest = [0.0_f64; 8];
        for _ in 0..200 {
            state = integrator.step_with_loads(&state, &loads, step_s);
            let plus = |factor: f64, rate: &[f64; 8]| from_fn(|i| x[i] + factor * rate[i]);
            let k1 = textbook_rate(&lap, &x, &loads[0]);
            let k2 = textbook_rate(&lap, &plus(step_s / 2.0, &k1), &loads[1]);
            let k3 = textbook_rate(&lap, &plus(step_s / 2.0, &k2), &loads[1]);
            let k4 = textbook_rate(&lap, &plus(step_s, &k3), &loads[2]);
            x = from_fn(|i| x[i] + step_s / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]));
            let LapState { a, b } = state;
            let [found, other] = [a, b].map(|side| [side.displacement, side.velocity]);
            for i in 0..2 {
                for (at, value) in [
                    (i, found[0][i]),
                    (2 + i, other[0][i]),
                    (4 + i, found[1][i]),
                    (6 + i, other[1][i]),
                ] {
                    largest[at] = largest[at].max(x[at].abs());
                    let error = (value - x[at]).abs();
                    assert!(error < 1e-13 * largest[at], "{at}: {value:e}, {:e}", x[at]);
                }
            }
        }
        // the cubic springs had a share in it
        assert!(lap.joint.cubic[0] * (x[0] - x[2]).powi(2) > 0.01 * lap.joint.stiffness[0][0]);
    }

    #[test]
    fn many_steps_at_once_are_as_many_single_steps() {
        let mut lap = decoupled(2e4, 3.0);
        lap.joint = JointLaw {
            stiffness: [[7e3]],
            damping: [[0.3]],
            cubic: [1e9],
        };
        let integrator = LapIntegrator::new(&lap);
        let loads = LapLoads {
            a: [12.0],
            b: [-5.0],
        };
        let count = NonZeroU32::new(64).unwrap();
        let at_once = integrator.advance(&LapState::REST, &loads, 64e-3, count);
        let mut state = LapState::REST;
        for _ in 0..64 {
            state = integrator.advance(&state, &loads, 64e-3 / 64.0, NonZeroU32::MIN);
        }
        assert_eq!(at_once, state);
    }
}
