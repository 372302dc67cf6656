//! An oscillator with a law that slips, by Masing's rule from turn to turn; turns and corners of the law are placed by bisection.
//! It shares nothing with the program under test.

use nalgebra::DVector;

use crate::loops::FirstLoading;

/// M of the relative motion, kg.
pub(crate) const MASS: f64 = 1.0;
/// Distance of samples, and steps of the integrator from sample to sample: 530 in a period of 8.9 ms.
pub(crate) const INTERVAL_S: f64 = 1.35e-4;
const STEPS: usize = 8;

/// What moves: M ü + c u̇ + k u + k₃ u³ + f = 0 with a law f that slips.
pub(crate) struct Oscillator {
    spring: f64,
    cubic: f64,
    damper: f64,
    first_loading: Box<FirstLoading>,
    /// Displacement at which the curve of first loading has a corner.
    corner_m: f64,
}

/// Displacement, velocity, and place and load of the last turn.
#[derive(Clone, Copy)]
struct Motion {
    u: f64,
    v: f64,
    turn: f64,
    at_turn: f64,
}

impl Oscillator {
    fn load(&self, u: f64, motion: &Motion) -> f64 {
        let way = u - motion.turn;
        motion.at_turn + 2.0 * way.signum() * (self.first_loading)(0.5 * way.abs())
    }

    fn acceleration(&self, u: f64, v: f64, motion: &Motion) -> f64 {
        let springs = self.spring * u + self.cubic * u.powi(3) + self.load(u, motion);
        -(springs + self.damper * v) / MASS
    }

    /// One step of the classical Runge–Kutta method on one branch.
    fn stepped(&self, motion: &Motion, h: f64) -> Motion {
        let Motion { u, v, .. } = *motion;
        let a1 = self.acceleration(u, v, motion);
        let (v2, u2) = (v + 0.5 * h * a1, u + 0.5 * h * v);
        let a2 = self.acceleration(u2, v2, motion);
        let (v3, u3) = (v + 0.5 * h * a2, u + 0.5 * h * v2);
        let a3 = self.acceleration(u3, v3, motion);
        let (v4, u4) = (v + h * a3, u + h * v3);
        let a4 = self.acceleration(u4, v4, motion);
        Motion {
            u: u + h / 6.0 * (v + 2.0 * (v2 + v3) + v4),
            v: v + h / 6.0 * (a1 + 2.0 * (a2 + a3) + a4),
            ..*motion
        }
    }

    /// The motion after `left`, cut at turns and corners.
    fn advanced(&self, motion: &mut Motion, mut left: f64) {
        let beyond = |motion: &Motion| (motion.u - motion.turn).abs() - 2.0 * self.corner_m;
        let rounding = 1e-9 * self.corner_m;
        while left > 0.0 {
            let turns = |next: &Motion| motion.v * next.v < 0.0;
            let corners = |next: &Motion| beyond(motion) < -rounding && beyond(next) > 0.0;
            let next = self.stepped(motion, left);
            if !turns(&next) && !corners(&next) {
                *motion = next;
                return;
            }
            let (mut low, mut high) = (0.0, left);
            for _ in 0..60 {
                let middle = 0.5 * (low + high);
                let next = self.stepped(motion, middle);
                if turns(&next) || corners(&next) {
                    high = middle;
                } else {
                    low = middle;
                }
            }
            let mut next = self.stepped(motion, high);
            if turns(&next) {
                (next.at_turn, next.turn) = (self.load(next.u, motion), next.u);
            }
            *motion = next;
            left -= high;
        }
    }

    /// Displacements from `before_s` after a release on, to which the law has come straight from rest.
    pub(crate) fn decay(&self, released_m: f64, before_s: f64, samples: usize) -> DVector<f64> {
        let mut motion = Motion {
            u: released_m,
            v: 0.0,
            turn: released_m,
            at_turn: (self.first_loading)(released_m),
        };
        let advance = |duration_s: f64, steps: usize, motion: &mut Motion| {
            for _ in 0..steps {
                self.advanced(motion, duration_s / steps as f64);
            }
        };
        advance(before_s, 12 * STEPS, &mut motion);
        let values = (0..samples).map(|_| {
            let u = motion.u;
            advance(INTERVAL_S, STEPS, &mut motion);
            u
        });
        DVector::from_iterator(samples, values)
    }
}

pub(crate) fn of_cubic(numbers: &[f64]) -> Oscillator {
    Oscillator {
        spring: numbers[0],
        damper: numbers[1],
        cubic: numbers[2],
        first_loading: Box::new(|_| 0.0),
        corner_m: f64::INFINITY,
    }
}

pub(crate) fn of_one_slider(numbers: &[f64]) -> Oscillator {
    let (k, h) = (numbers[2], numbers[3]);
    Oscillator {
        spring: numbers[0] - k,
        damper: numbers[1],
        cubic: 0.0,
        first_loading: Box::new(move |u| (k * u).min(h)),
        corner_m: h / k,
    }
}

/// Segalman's law: F = K_T u − R u^(χ+2)/((χ+1)(χ+2)) up to φ_max, with φ_max and R of F_S, K_T, χ and β.
pub(crate) fn of_many_sliders(numbers: &[f64]) -> Oscillator {
    let (slip_force, stiffness, exponent, ratio) = (numbers[2], numbers[3], numbers[4], numbers[5]);
    let g = ratio + (exponent + 1.0) / (exponent + 2.0);
    let span = slip_force * (1.0 + ratio) / (stiffness * g);
    let density = slip_force * (exponent + 1.0) / (span.powf(exponent + 2.0) * g);
    let part = density / ((exponent + 1.0) * (exponent + 2.0));
    Oscillator {
        spring: numbers[0] - stiffness,
        damper: numbers[1],
        cubic: 0.0,
        first_loading: Box::new(move |u| {
            if u < span {
                stiffness * u - part * u.powf(exponent + 2.0)
            } else {
                slip_force
            }
        }),
        corner_m: span,
    }
}
