//! Closed loops of load over displacement: what a joint alone answers to a steady sinusoidal motion, and the heat of it.

use std::f64::consts::TAU;

use bolted_joint_dynamics::{JointLaw, JointMemory, Motion, law::DOF_AT_REST};

use super::answer::Answer;

/// Points of a loop.
const POINTS: usize = 512;
/// Cycles at most until the loop is closed: laws with a continuous state come near it as a geometric series does.
const MOST_CYCLES: usize = 200;
/// A loop is closed when its ends differ by less than this part of its largest load.
const CLOSED: f64 = 1e-12;

/// A motion of one relative DOF, the others at rest.
pub(super) struct Loop {
    pub(super) dof: usize,
    /// m, rad
    pub(super) amplitude: f64,
    /// rad/s; `None` for a motion so slow that dampers have no part in it.
    pub(super) omega: Option<f64>,
}

impl Loop {
    /// Rows of displacement, load on side b, and heat since the loop began, once around from the largest displacement.
    pub(super) fn answer<const D: usize>(&self, law: &JointLaw<D>) -> Answer<D> {
        let mut memory: JointMemory<D> = [DOF_AT_REST; D];
        // from rest to the largest displacement
        for point in 0..=POINTS / 4 {
            self.go(law, &mut memory, point as f64 - POINTS as f64 / 4.0);
        }
        let mut rows = self.once_around(law, &mut memory);
        for _ in 1..MOST_CYCLES {
            let next = self.once_around(law, &mut memory);
            let largest = next.iter().map(|row| row[1].abs()).fold(0.0, f64::max);
            let mut pairs = std::iter::zip(&rows, &next);
            let is_closed = pairs.all(|(one, other)| (one[1] - other[1]).abs() <= CLOSED * largest);
            rows = next;
            if is_closed {
                break;
            }
        }
        let mut largest = [0.0; D];
        largest[self.dof] = self.amplitude;
        Answer { rows, largest }
    }

    fn once_around<const D: usize>(
        &self,
        law: &JointLaw<D>,
        memory: &mut JointMemory<D>,
    ) -> Vec<Vec<f64>> {
        let mut heat = 0.0;
        let mut power_before = 0.0;
        let step_s = self.omega.map_or(0.0, |omega| TAU / omega / POINTS as f64);
        let rows = (0..=POINTS).map(|point| {
            let (motion, slid_j) = self.go(law, memory, point as f64);
            let power = law.viscous_power(&motion);
            if point > 0 {
                // the dampers' heat by the trapezoidal rule, which is exact over a period
                heat += slid_j + 0.5 * step_s * (power_before + power);
            }
            power_before = power;
            let load = law.load_on_b_after(memory, &motion);
            vec![motion.displacement[self.dof], load[self.dof], heat]
        });
        rows.collect()
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
        motion.velocity[self.dof] = -self.omega.unwrap_or(0.0) * self.amplitude * sin;
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
            let rows = Loop {
                dof: 0,
                amplitude: u,
                omega,
            }
            .answer(&law)
            .rows;
            let heat = rows[POINTS][2];
            assert!((heat / expected - 1.0).abs() < 1e-12, "{heat} {expected}");
            // closed, and as high as spring and slider together
            assert!((rows[0][1] - rows[POINTS][1]).abs() < 1e-9);
            assert!((rows[0][1] - (5e6 * u + h)).abs() < 1e-9);
        }
    }
}
