//! Time integration of the lap model, under held loads and under loads that change within a step.

use std::num::NonZeroU32;

use crate::joint::Motion;
use crate::lap::{Body, Lap, LapLoads, LapState};
use crate::rk4::{self, Linear, Stage};

impl<const D: usize> Linear for Motion<D> {
    #[inline]
    fn plus(&self, factor: f64, rate: &Self) -> Self {
        Self {
            displacement: std::array::from_fn(|i| {
                self.displacement[i] + factor * rate.displacement[i]
            }),
            velocity: std::array::from_fn(|i| self.velocity[i] + factor * rate.velocity[i]),
        }
    }
}

impl<const D: usize> Linear for LapState<D> {
    #[inline]
    fn plus(&self, factor: f64, rate: &Self) -> Self {
        Self {
            a: self.a.plus(factor, &rate.a),
            b: self.b.plus(factor, &rate.b),
        }
    }
}

/// The lap model made ready for stepping: divisions by the inertias are done once.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LapIntegrator<const D: usize> {
    lap: Lap<D>,
    mobility_a: [f64; D],
    mobility_b: [f64; D],
}

impl<const D: usize> LapIntegrator<D> {
    /// Prepares `lap` for stepping. Its inertias must be positive: [`Lap::defect`] tells.
    #[must_use]
    pub fn new(lap: &Lap<D>) -> Self {
        Self {
            lap: *lap,
            mobility_a: lap.a.inertia.map(f64::recip),
            mobility_b: lap.b.inertia.map(f64::recip),
        }
    }

    /// Whether the joint has no cubic term, so that the equations of motion are linear.
    #[inline]
    #[must_use]
    pub fn is_linear(&self) -> bool {
        self.lap.joint.cubic.iter().all(|&cubic| cubic == 0.0)
    }

    /// State after `interval_s` (s) in `substeps` equal RK4 steps, the loads held; it ends exactly at the interval's end.
    #[inline]
    #[must_use]
    pub fn advance(
        &self,
        state: &LapState<D>,
        loads: &LapLoads<D>,
        interval_s: f64,
        substeps: NonZeroU32,
    ) -> LapState<D> {
        let step_s = interval_s / f64::from(substeps.get());
        let mut state = *state;
        for _ in 0..substeps.get() {
            state = rk4::step(|_, state| self.rate(state, loads), &state, step_s);
        }
        state
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
        let [start, middle, end] = loads;
        let rate = |stage, state: &LapState<D>| {
            let loads = match stage {
                Stage::Start => start,
                Stage::Middle => middle,
                Stage::End => end,
            };
            self.rate(state, loads)
        };
        rk4::step(rate, state, step_s)
    }

    /// Rate of change of the state: velocities and accelerations.
    #[inline]
    #[must_use]
    pub fn rate(&self, state: &LapState<D>, loads: &LapLoads<D>) -> LapState<D> {
        let on_b = self.lap.joint.load_on_b(&state.a.relative_to(&state.b));
        // m_a ẍ_a = F_a − k_a x_a − c_a ẋ_a − F_joint
        // m_b ẍ_b = F_b − k_b x_b − c_b ẋ_b + F_joint   (Pirdayr's equations of motion, a = 1, b = 2)
        let on_a = on_b.map(|load| -load);
        LapState {
            a: body_rate(&self.lap.a, &self.mobility_a, &state.a, &loads.a, &on_a),
            b: body_rate(&self.lap.b, &self.mobility_b, &state.b, &loads.b, &on_b),
        }
    }
}

#[inline]
fn body_rate<const D: usize>(
    body: &Body<D>,
    reciprocal_inertia: &[f64; D],
    motion: &Motion<D>,
    external: &[f64; D],
    joint: &[f64; D],
) -> Motion<D> {
    Motion {
        displacement: motion.velocity,
        velocity: std::array::from_fn(|i| {
            let support =
                body.stiffness[i] * motion.displacement[i] + body.damping[i] * motion.velocity[i];
            (external[i] - support + joint[i]) * reciprocal_inertia[i]
        }),
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
}
