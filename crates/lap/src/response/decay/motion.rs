//! The motion of a lap after a release, as a record has it: samples of the model itself, with what its law remembers.
//!
//! Masing's rule goes from turn to turn: as the motion decays no loop closes, so that the last turn and its load are all that the
//! law remembers. That is the lap's own motion, to rounding, and takes a quarter of the time of its steps, which count energies
//! and remember up to 64 turns.

use std::f64::consts::TAU;

use bolted_joint_dynamics::law::Law as _;

use super::recorded::{Quantity, Recorded};
use crate::response::model::Values;

/// Steps in a period, at least.
const STEPS: f64 = 64.0;
/// Steps from a release to the first sample at most: it is the last turn before that.
const STEPS_BEFORE: f64 = 32.0 * STEPS;
/// A motion beyond so many times the release is none of a decay.
const ESCAPES: f64 = 2.0;
/// Cuts of a step at most, part of the displacement of a corner that is none, and steps that find the place of a cut.
const CUTS: usize = 4;
const AT_CORNER: f64 = 1e-9;
const PLACED: usize = 12;

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

/// What a record would have of the lap with these values, without an offset; `None` where that moves as no decay does.
pub(super) fn sampled(
    values: &Values,
    release: &Release,
    record: &Recorded,
    grid: &Grid,
) -> Option<Vec<f64>> {
    let law = Law::of(values, grid);
    let mut place = law.released(release.displacement_m);
    let mut samples = Vec::with_capacity(grid.samples);
    let before = (release.time_s / record.interval_s).ceil().max(0.0) as usize;
    let before = before.min(grid.samples);
    let square = -law.acceleration(&place, [place.u, place.v]) / release.displacement_m;
    let swing = (square > 0.0).then(|| Swing {
        displacement_m: release.displacement_m,
        omega: square.sqrt(),
    })?;
    for n in 0..before {
        let way_s = record.interval_s * n as f64 - release.time_s;
        samples.push(record.share * swing.at(way_s, record.quantity));
    }
    let first_s = record.interval_s * before as f64 - release.time_s;
    let steps = (first_s / grid.step_s).ceil().max(1.0);
    if steps.is_nan() || steps > STEPS_BEFORE {
        return None;
    }
    for _ in 0..steps as u64 {
        law.advance(&mut place, first_s / steps);
    }
    let farthest = ESCAPES * release.displacement_m.abs();
    for n in before..grid.samples {
        if n > before {
            bolted_joint_wanted::look();
            for _ in 0..grid.steps {
                law.advance(&mut place, grid.step_s);
            }
        }
        if place.u.is_nan() || place.u.abs() > farthest {
            return None;
        }
        let value = match record.quantity {
            Quantity::Displacement => place.u,
            Quantity::Velocity => place.v,
            Quantity::Acceleration => law.acceleration(&place, [place.u, place.v]),
        };
        samples.push(record.share * value);
    }
    let is_finite = samples.iter().all(|value| value.is_finite());
    is_finite.then_some(samples)
}

/// Relative displacement and velocity, and place and load of the law's last turn.
#[derive(Clone, Copy)]
struct Place {
    u: f64,
    v: f64,
    turn: f64,
    at_turn: f64,
}

/// The relative motion: M ü + C u̇ + K u + … + f = 0.
struct Law<'a> {
    values: &'a Values,
    mass: f64,
    spring: f64,
    damper: f64,
    first_loading: Option<Box<dyn Fn(f64) -> f64>>,
    /// Way from a turn at which the load of the law has a corner, m.
    corner: f64,
}

impl<'a> Law<'a> {
    fn of(values: &'a Values, grid: &Grid) -> Self {
        // A step turns the phase by ωh (1 − (ωh)⁴/120) in place of ωh: a mass that is smaller by (ωh)⁴/60 gives ω back
        let slower = 1.0 - (grid.omega * grid.step_s).powi(4) / 60.0;
        let slider = values.slider.as_ref();
        Self {
            values,
            mass: 0.5 * values.mass * slower,
            spring: 0.5 * values.support_stiffness + values.spring(),
            damper: values.relative_damping(),
            first_loading: slider.map(|slider| slider.first_loading()),
            corner: slider.map_or(f64::INFINITY, |slider| 2.0 * slider.corner_m()),
        }
    }

    fn released(&self, displacement_m: f64) -> Place {
        let load = self.first_loading.as_ref();
        let load = load.map_or(0.0, |load| load(displacement_m.abs()));
        Place {
            u: displacement_m,
            v: 0.0,
            turn: displacement_m,
            at_turn: displacement_m.signum() * load,
        }
    }

    /// Load of the law that slips at a displacement behind the last turn: f_r + 2 F((u − u_r)/2), F odd.
    fn load(&self, place: &Place, u: f64) -> f64 {
        let Some(first_loading) = &self.first_loading else {
            return 0.0;
        };
        let way = u - place.turn;
        place.at_turn + 2.0 * way.signum() * first_loading(0.5 * way.abs())
    }

    fn acceleration(&self, place: &Place, [u, v]: [f64; 2]) -> f64 {
        let terms = self.values.terms.load::<f64>(&[], u, v);
        -(self.spring * u + self.damper * v + terms + self.load(place, u)) / self.mass
    }

    /// One step of the classical Runge–Kutta method behind the last turn.
    fn stepped(&self, place: &Place, h: f64) -> Place {
        let Place { u, v, .. } = *place;
        let a1 = self.acceleration(place, [u, v]);
        let v2 = v + 0.5 * h * a1;
        let a2 = self.acceleration(place, [u + 0.5 * h * v, v2]);
        let v3 = v + 0.5 * h * a2;
        let a3 = self.acceleration(place, [u + 0.5 * h * v2, v3]);
        let v4 = v + h * a3;
        let a4 = self.acceleration(place, [u + h * v3, v4]);
        Place {
            u: u + h / 6.0 * (v + 2.0 * (v2 + v3) + v4),
            v: v + h / 6.0 * (a1 + 2.0 * (a2 + a3) + a4),
            ..*place
        }
    }

    /// A step that is cut where the motion turns or the load has a corner: between them all is smooth.
    fn advance(&self, place: &mut Place, step_s: f64) {
        let mut left_s = step_s;
        for _ in 0..CUTS {
            let next = self.stepped(place, left_s);
            if self.first_loading.is_none() {
                *place = next;
                return;
            }
            let turns = place.v * next.v < 0.0;
            let turned = turns.then(|| self.placed(place, left_s, &|at| at.v * next.v.signum()));
            let end = turned.unwrap_or((left_s, next));
            let beyond = |at: &Place| (at.u - at.turn).abs() - self.corner;
            let is_cornered = beyond(place) < -AT_CORNER * self.corner
                && beyond(&end.1) > AT_CORNER * self.corner;
            if is_cornered {
                let (at_s, at) = self.placed(place, end.0, &beyond);
                *place = at;
                left_s -= at_s;
                continue;
            }
            *place = end.1;
            let Some((at_s, at)) = turned else {
                return;
            };
            *place = Place {
                u: at.u,
                v: 0.0,
                turn: at.u,
                at_turn: self.load(place, at.u),
            };
            left_s -= at_s;
        }
        *place = self.stepped(place, left_s);
    }

    /// When within a step a number of the motion passes zero upwards, and the motion then: regula falsi, after Illinois.
    fn placed(&self, from: &Place, step_s: f64, of: &dyn Fn(&Place) -> f64) -> (f64, Place) {
        let last = self.stepped(from, step_s);
        let (mut low, mut high) = ((0.0, of(from)), (step_s, of(&last)));
        let mut found = (step_s, last);
        for _ in 0..PLACED {
            let at_s = low.0 - low.1 * (high.0 - low.0) / (high.1 - low.1);
            if !(at_s > low.0 && at_s < high.0) {
                break;
            }
            let at = self.stepped(from, at_s);
            let value = of(&at);
            found = (at_s, at);
            if value < 0.0 {
                low = (at_s, value);
                high.1 *= 0.5;
            } else {
                high = (at_s, value);
                low.1 *= 0.5;
            }
        }
        found
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

#[cfg(test)]
mod tests;
