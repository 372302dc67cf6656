//! The motion of a lap after a release, as a record has it: samples of the model itself, with what its law remembers.
//!
//! The lap's own Runge–Kutta steps are taken, which are cut where the joint turns or its load has a corner.

use std::f64::consts::TAU;

use bolted_joint_dynamics::{
    Body, DofLaws, Lap, LapLoads, LapMoment, LapState, LapStepper, Linear, Motion, law::JointLaw,
};

use super::recorded::{Quantity, Recorded};
use crate::response::model::Values;

/// Steps in a period, at least.
const STEPS: f64 = 64.0;
/// A motion beyond so many times the release is none of a decay.
const ESCAPES: f64 = 2.0;
/// Nothing acts on the bodies.
const FREE: LapLoads<1> = LapLoads { a: [0.0], b: [0.0] };

/// Where a motion begins: at rest, away from the middle, where the joint came to straight from there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Release {
    /// Displacement of the relative motion, m.
    pub(super) displacement_m: f64,
    /// Time after the first sample, s: most often it is before, and negative.
    pub(super) time_s: f64,
}

/// Which samples of a record are computed, and by how many steps: the same ones for all values, so that differences are smooth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Grid {
    /// Number of samples from the first on.
    pub(super) samples: usize,
    /// Steps from each to the next.
    steps: u32,
    /// Length of a step, s.
    step_s: f64,
    /// The frequency that the steps are made for, rad/s.
    pub(super) omega: f64,
}

impl Grid {
    /// Of a record of this frequency (rad/s).
    pub(super) fn of(record: &Recorded, samples: usize, omega: f64) -> Self {
        let longest_s = TAU / omega / STEPS;
        let steps = (record.interval_s / longest_s).ceil().max(1.0);
        Self {
            samples,
            steps: steps as u32,
            step_s: record.interval_s / steps,
            omega,
        }
    }

    /// The same of so many samples.
    pub(super) fn up_to(self, samples: usize) -> Self {
        Self {
            samples: samples.min(self.samples),
            ..self
        }
    }

    /// Steps of a whole motion.
    pub(super) fn steps(&self) -> usize {
        self.samples.saturating_mul(self.steps as usize)
    }
}

/// A lap that moves by itself.
struct Moving {
    lap: Lap<1>,
    stepper: LapStepper<1>,
    moment: LapMoment<1>,
}

/// What a record would have of the lap with these values, without an offset; `None` where that moves as no decay does.
pub(super) fn sampled(
    values: &Values,
    release: &Release,
    record: &Recorded,
    grid: &Grid,
) -> Option<Vec<f64>> {
    let mut moving = Moving::released(values, release.displacement_m, grid)?;
    let mut samples = Vec::with_capacity(grid.samples);
    let before = (release.time_s / record.interval_s).ceil().max(0.0) as usize;
    let before = before.min(grid.samples);
    let swing = moving.at_rest(release.displacement_m)?;
    for n in 0..before {
        let way_s = record.interval_s * n as f64 - release.time_s;
        samples.push(record.share * swing.at(way_s, record.quantity));
    }
    let first_s = record.interval_s * before as f64 - release.time_s;
    let steps = (first_s / grid.step_s).ceil().max(1.0);
    for _ in 0..steps as u64 {
        moving.step(first_s / steps);
    }
    let farthest = ESCAPES * release.displacement_m.abs();
    for n in before..grid.samples {
        if n > before {
            for _ in 0..grid.steps {
                moving.step(grid.step_s);
            }
        }
        let relative = moving.relative();
        if !(relative.displacement[0].abs() < farthest) {
            return None;
        }
        let value = match record.quantity {
            Quantity::Displacement => relative.displacement[0],
            Quantity::Velocity => relative.velocity[0],
            Quantity::Acceleration => moving.acceleration(),
        };
        samples.push(record.share * value);
    }
    samples
        .iter()
        .all(|value| value.is_finite())
        .then_some(samples)
}

impl Moving {
    fn released(values: &Values, displacement_m: f64, grid: &Grid) -> Option<Self> {
        // A step turns the phase by ωh (1 − (ωh)⁴/120) in place of ωh: a mass that is smaller by (ωh)⁴/60 gives ω back
        let faster = 1.0 - (grid.omega * grid.step_s).powi(4) / 60.0;
        let lap = lap(values, 1.0);
        let stepped = self::lap(values, faster);
        if lap.defect().is_some() || stepped.defect().is_some() {
            return None;
        }
        let at = |part: f64| Motion {
            displacement: [part * displacement_m],
            velocity: [0.0],
        };
        let state = LapState {
            a: at(0.5),
            b: at(-0.5),
        };
        let mut moment = LapMoment::from(state);
        stepped.joint.commit(&mut moment.memory, &state.relative());
        Some(Self {
            lap,
            stepper: LapStepper::new(&stepped),
            moment,
        })
    }

    fn step(&mut self, step_s: f64) {
        self.stepper.step(&mut self.moment, &[FREE; 3], step_s);
    }

    fn relative(&self) -> Motion<1> {
        self.moment.state.relative()
    }

    /// Of the relative motion, m/s².
    fn acceleration(&self) -> f64 {
        let LapMoment { state, memory } = &self.moment;
        let [[of_a], [of_b]] = self.lap.accelerations(memory, state, &FREE);
        of_a - of_b
    }

    /// The motion about the release; `None` where nothing draws it back.
    fn at_rest(&self, displacement_m: f64) -> Option<Swing> {
        let square = -self.acceleration() / displacement_m;
        (square > 0.0).then(|| Swing {
            displacement_m,
            omega: square.sqrt(),
        })
    }
}

/// The motion near a turn, the same before it and after it. A release that is estimated lies less than a sample behind its place.
struct Swing {
    displacement_m: f64,
    omega: f64,
}

impl Swing {
    fn at(&self, way_s: f64, quantity: Quantity) -> f64 {
        let (sine, cosine) = (self.omega * way_s).sin_cos();
        match quantity {
            Quantity::Displacement => self.displacement_m * cosine,
            Quantity::Velocity => -self.displacement_m * self.omega * sine,
            Quantity::Acceleration => -self.displacement_m * self.omega * self.omega * cosine,
        }
    }
}

/// The lap with its mass times a factor.
fn lap(values: &Values, factor: f64) -> Lap<1> {
    // free bodies: nothing but their relative motion is there, and K = k/2 + k₁₂ and C = c/2 + c₁₂ of it are between them
    let body = Body {
        inertia: [factor * values.mass],
        stiffness: [0.0],
        damping: [0.0],
    };
    let linear = Linear {
        stiffness: [[0.5 * values.support_stiffness + values.spring()]],
        damping: [[values.relative_damping()]],
    };
    let terms = DofLaws::from(values.terms);
    let laws = match &values.slider {
        Some(slider) => terms.beside(&slider.laws()),
        None => terms,
    };
    Lap {
        joint: JointLaw { linear, on: [laws] },
        a: body,
        b: body,
    }
}

#[cfg(test)]
mod tests;
