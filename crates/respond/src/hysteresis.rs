//! Closed loops of load over displacement: what a joint alone answers to a steady sinusoidal motion, and the heat of it.

use std::f64::consts::TAU;

use bolted_joint_dynamics::{JointLaw, JointMemory, Motion, law::DOF_AT_REST};

/// Points of a loop.
const POINTS: usize = 512;
/// Cycles at most until the loop is closed: laws with a continuous state come near it as a geometric series does.
const MOST_CYCLES: usize = 200;
/// A loop is closed when its ends differ by less than this part of its largest load.
const CLOSED: f64 = 1e-12;

/// A sinusoidal motion of one relative DOF, the others at rest, that has gone on until the loop of the load is closed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HysteresisLoop {
    /// Index of the DOF.
    pub dof: usize,
    /// Of the displacement: m, rad.
    pub amplitude: f64,
    /// rad/s; `None` for a motion so slow that dampers have no part in it.
    pub omega_rad_per_s: Option<f64>,
}

/// A moment of the motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LoopPoint {
    /// Relative displacement: m, rad.
    pub displacement: f64,
    /// Its rate: m/s, rad/s; zero in a motion that is as slow as can be.
    pub velocity: f64,
    /// Load on side b: N, N·m.
    pub load: f64,
    /// Heat since the largest displacement, J.
    pub heat_j: f64,
}

impl HysteresisLoop {
    /// The closed loop, once around from the largest displacement; at its last point the heat is that of a cycle.
    #[must_use]
    pub fn points<const D: usize>(&self, law: &JointLaw<D>) -> Vec<LoopPoint> {
        let mut memory: JointMemory<D> = [DOF_AT_REST; D];
        // from rest to the largest displacement
        for point in 0..=POINTS / 4 {
            self.go(law, &mut memory, point as f64 - POINTS as f64 / 4.0);
        }
        let mut points = self.once_around(law, &mut memory);
        for _ in 1..MOST_CYCLES {
            let next = self.once_around(law, &mut memory);
            let largest = next.iter().map(|of| of.load.abs()).fold(0.0, f64::max);
            let mut pairs = std::iter::zip(&points, &next);
            let is_closed =
                pairs.all(|(one, other)| (one.load - other.load).abs() <= CLOSED * largest);
            points = next;
            if is_closed {
                break;
            }
        }
        points
    }

    fn once_around<const D: usize>(
        &self,
        law: &JointLaw<D>,
        memory: &mut JointMemory<D>,
    ) -> Vec<LoopPoint> {
        let mut heat = 0.0;
        let mut power_before = 0.0;
        let step_s = self
            .omega_rad_per_s
            .map_or(0.0, |omega| TAU / omega / POINTS as f64);
        let points = (0..=POINTS).map(|point| {
            let (motion, slid_j) = self.go(law, memory, point as f64);
            let power = law.viscous_power(&motion);
            if point > 0 {
                // the dampers' heat by the trapezoidal rule, which is exact over a period
                heat += slid_j + 0.5 * step_s * (power_before + power);
            }
            power_before = power;
            let load = law.load_on_b_after(memory, &motion);
            LoopPoint {
                displacement: motion.displacement[self.dof],
                velocity: motion.velocity[self.dof],
                load: load[self.dof],
                heat_j: heat,
            }
        });
        points.collect()
    }

    /// Moves the joint on to a point of the period; returns the motion there and what sliders turned into heat on the way, J.
    fn go<const D: usize>(
        &self,
        law: &JointLaw<D>,
        memory: &mut JointMemory<D>,
        point: f64,
    ) -> (Motion<D>, f64) {
        let (sin, cos) = (TAU * point / POINTS as f64).sin_cos();
        let mut motion = Motion {
            displacement: [0.0; D],
            velocity: [0.0; D],
        };
        // r = U cos τ, ṙ = −ωU sin τ
        motion.displacement[self.dof] = self.amplitude * cos;
        motion.velocity[self.dof] = -self.omega_rad_per_s.unwrap_or(0.0) * self.amplitude * sin;
        let slid_j = law.commit(memory, &motion);
        (motion, slid_j)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use bolted_joint_dynamics::{
        Linear,
        law::{DofLaws, Jenkins},
    };

    /// D = 4h(U − h/k) of a slider, πcωU² of a damper; the spring turns nothing into heat.
    #[test]
    fn the_heat_of_a_loop_is_that_of_slider_and_damper() {
        let (k, h, c, omega, u) = (2e6, 300.0, 40.0, 500.0, 4e-4);
        let slider = Jenkins {
            stiffness: k,
            slip_force: h,
        };
        let law = JointLaw::<1> {
            linear: Linear {
                stiffness: [[5e6]],
                damping: [[c]],
            },
            on: [DofLaws::from(slider)],
        };
        let slid = 4.0 * h * (u - h / k);
        for (omega, expected) in [
            (None, slid),
            (Some(omega), slid + std::f64::consts::PI * c * omega * u * u),
        ] {
            let points = HysteresisLoop {
                dof: 0,
                amplitude: u,
                omega_rad_per_s: omega,
            }
            .points(&law);
            let heat = points[POINTS].heat_j;
            assert!((heat / expected - 1.0).abs() < 1e-12, "{heat} {expected}");
            // closed, and as high as spring and slider together
            assert!((points[0].load - points[POINTS].load).abs() < 1e-9);
            assert!((points[0].load - (5e6 * u + h)).abs() < 1e-9);
        }
    }
}
