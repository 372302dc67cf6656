//! The motion of a lap after a release, as a record has it: samples of the model itself, with what its law remembers.
//!
//! Masing's rule goes from turn to turn: as the motion decays no loop closes, so that the last turn and its load are all that the
//! law remembers. That is the lap's own motion, to rounding, and takes a quarter of the time of its steps, which count energies
//! and remember up to 64 turns.
//!
//! It is computed in real numbers, or in those that carry how they change with the unknowns and with the release: one motion then
//! has all derivatives, where differences take two for each.

mod law;

use std::f64::consts::TAU;

use bolted_joint_dynamics::{Dual, Number};
use nalgebra::DMatrix;

use self::law::Law;
use super::recorded::{Quantity, Recorded};
use crate::response::model::{ResponseUnknown, Values};

/// Steps in a period, at least.
const STEPS: f64 = 64.0;
/// Steps from a release to the first sample at most: it is the last turn before that.
const STEPS_BEFORE: f64 = 32.0 * STEPS;
/// A motion beyond so many times the release is none of a decay.
const ESCAPES: f64 = 2.0;
/// Directions that one motion changes along.
const FEW: usize = 6;
const MORE: usize = 8;
const MOST: usize = 10;

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

/// What a motion changes with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Direction {
    /// A number of the model, as it is searched.
    Unknown(ResponseUnknown),
    /// Displacement of the release, m.
    Displacement,
    /// Time of the release, s.
    Time,
}

/// What a record would have of the lap with these values, without an offset; `None` where that moves as no decay does.
pub(super) fn sampled(
    values: &Values,
    release: &Release,
    record: &Recorded,
    grid: &Grid,
) -> Option<Vec<f64>> {
    let mut samples = Vec::with_capacity(grid.samples);
    let law = Law::of(values, grid, |_, value| value);
    let begin = [release.displacement_m, release.time_s];
    followed(&law, begin, record, grid, |sample| samples.push(sample))?;
    Some(samples)
}

/// How these samples change along each direction, a column for each. An instant at which the joint turns moves as well, which does
/// not matter: the load goes on without a jump.
pub(super) fn changes(
    values: &Values,
    release: &Release,
    record: &Recorded,
    grid: &Grid,
    directions: &[Direction],
) -> Option<DMatrix<f64>> {
    let mut columns = DMatrix::zeros(grid.samples, directions.len());
    let mut first = 0;
    for part in directions.chunks(MOST) {
        let mut own = columns.columns_mut(first, part.len());
        let mut row = 0;
        let mut take = |change: &[f64]| {
            for (entry, change) in own.row_mut(row).iter_mut().zip(change) {
                *entry = *change;
            }
            row += 1;
        };
        let count = part.len();
        let followed = if count <= FEW {
            along::<FEW>(values, release, record, grid, part, |n| take(&n.change))
        } else if count <= MORE {
            along::<MORE>(values, release, record, grid, part, |n| take(&n.change))
        } else {
            along::<MOST>(values, release, record, grid, part, |n| take(&n.change))
        };
        followed?;
        first += part.len();
    }
    Some(columns)
}

/// The samples with their changes along at most so many directions.
fn along<const K: usize>(
    values: &Values,
    release: &Release,
    record: &Recorded,
    grid: &Grid,
    directions: &[Direction],
    take: impl FnMut(Dual<K>),
) -> Option<()> {
    let number = |direction: Direction, value: f64| {
        let place = directions.iter().position(|own| *own == direction);
        place.map_or(Dual::from(value), |place| Dual::along(value, place))
    };
    let law = Law::of(values, grid, |unknown, value| {
        number(Direction::Unknown(unknown), value)
    });
    let begin = [
        number(Direction::Displacement, release.displacement_m),
        number(Direction::Time, release.time_s),
    ];
    followed(&law, begin, record, grid, take)
}

/// The samples of a motion that begins at this displacement (m) and time (s), one after the other.
fn followed<N: Number>(
    law: &Law<N>,
    [displacement, time]: [N; 2],
    record: &Recorded,
    grid: &Grid,
    mut take: impl FnMut(N),
) -> Option<()> {
    let mut give = |sample: N| {
        let sample = sample.chain(record.share * sample.value(), record.share);
        take(sample);
        sample.is_finite().then_some(())
    };
    let mut place = law.released(displacement);
    let before = (time.value() / record.interval_s).ceil().max(0.0) as usize;
    let before = before.min(grid.samples);
    let square = -law.acceleration(&place, [place.u, place.v]) / displacement;
    let swing = (square.value() > 0.0).then(|| Swing {
        displacement,
        omega: root(square),
    })?;
    for n in 0..before {
        let way = N::from(record.interval_s * n as f64) - time;
        give(swing.at(way, record.quantity))?;
    }
    let first_s = record.interval_s * before as f64 - time.value();
    let steps = (first_s / grid.step_s).ceil().max(1.0);
    if steps.is_nan() || steps > STEPS_BEFORE {
        return None;
    }
    for _ in 0..steps as u64 {
        law.advance(&mut place, first_s / steps);
    }
    place = law.later(&place, time - N::from(time.value()));
    let farthest = ESCAPES * displacement.value().abs();
    for n in before..grid.samples {
        if n > before {
            bolted_joint_wanted::look();
            for _ in 0..grid.steps {
                law.advance(&mut place, grid.step_s);
            }
        }
        if place.u.value().is_nan() || place.u.value().abs() > farthest {
            return None;
        }
        give(match record.quantity {
            Quantity::Displacement => place.u,
            Quantity::Velocity => place.v,
            Quantity::Acceleration => law.acceleration(&place, [place.u, place.v]),
        })?;
    }
    Some(())
}

/// √x
fn root<N: Number>(x: N) -> N {
    let root = x.value().sqrt();
    x.chain(root, 0.5 / root)
}

/// The motion near a turn, the same before it and after it. A release that is estimated lies less than a sample behind its place.
struct Swing<N> {
    displacement: N,
    omega: N,
}

impl<N: Number> Swing<N> {
    /// So long behind its middle, s.
    fn at(&self, way: N, quantity: Quantity) -> N {
        let angle = self.omega * way;
        let (sine, cosine) = angle.value().sin_cos();
        let (sine, cosine) = (angle.chain(sine, cosine), angle.chain(cosine, -sine));
        match quantity {
            Quantity::Displacement => self.displacement * cosine,
            Quantity::Velocity => -self.displacement * self.omega * sine,
            Quantity::Acceleration => -self.displacement * self.omega * self.omega * cosine,
        }
    }
}

#[cfg(test)]
mod tests;
