//! Events of Model Exchange: where a joint that remembers turns, and where its load has a corner. An importer that places them
//! completes a step there, so that the joint is committed at the very point.
//!
//! Both indicators are positive where the joint moves on. They change by themselves only while they are; one that has fallen
//! to zero stays there until the event is entered. So none is ever zero at rest.

use bolted_joint_dynamics::{JointLaw, Motion};

use crate::interface::Values;

/// Velocity against the direction of motion below which no turn is told, m/s or rad/s: a billionth of what is usual.
const MARGIN: f64 = 1e-10;

/// The same as a part of the largest velocity up to now. What the joint goes beyond its turn meanwhile is the square of that.
const MARGIN_PART: f64 = 1e-7;

/// Indicator where no corner is ahead, m or rad.
const NO_CORNER: f64 = 1.0;

/// What is remembered for the indicators.
struct Ahead<const D: usize> {
    direction: [f64; D],
    speed: [f64; D],
    corner: [f64; D],
}

impl<const D: usize> Ahead<D> {
    fn of(values: &Values) -> Self {
        let all = values.ahead::<D>();
        let number = |place: usize| all.map(|ahead| ahead[place]);
        Self {
            direction: number(0),
            speed: number(1),
            corner: number(2),
        }
    }

    fn write(&self, values: &mut Values) {
        let all: [_; D] =
            std::array::from_fn(|i| [self.direction[i], self.speed[i], self.corner[i]]);
        values.set_ahead(&all);
    }

    /// Indicators at this motion: of turns, and of corners ahead.
    fn indicators(&self, relative: &Motion<D>) -> [[f64; D]; 2] {
        [
            std::array::from_fn(|i| {
                self.direction[i] * relative.velocity[i] + MARGIN + MARGIN_PART * self.speed[i]
            }),
            std::array::from_fn(|i| match self.corner[i] {
                f64::MAX => NO_CORNER,
                corner => self.direction[i] * (corner - relative.displacement[i]),
            }),
        ]
    }
}

/// Begins to look for events at the present motion.
pub(super) fn begin<const D: usize>(values: &mut Values, law: &JointLaw<D>, relative: &Motion<D>) {
    Ahead {
        direction: [0.0; D],
        speed: [0.0; D],
        corner: [f64::MAX; D],
    }
    .write(values);
    look_ahead(values, law, relative, true);
}

/// Looks ahead from the present motion, which is committed: at an event the joint may have turned.
pub(super) fn look_ahead<const D: usize>(
    values: &mut Values,
    law: &JointLaw<D>,
    relative: &Motion<D>,
    is_event: bool,
) {
    if !values.have_events() {
        return;
    }
    let mut ahead = Ahead::<D>::of(values);
    let [turning, corners] = ahead.indicators(relative);
    for i in 0..D {
        let velocity = relative.velocity[i];
        ahead.speed[i] = ahead.speed[i].max(velocity.abs()).min(f64::MAX);
        let is_ahead = turning[i] > 0.0 && corners[i] > 0.0;
        if !(is_ahead || is_event) {
            continue;
        }
        let has_turned = is_event && velocity * ahead.direction[i] < 0.0;
        if has_turned || ahead.direction[i] == 0.0 && velocity.abs() > MARGIN {
            ahead.direction[i] = velocity.signum();
        }
        let direction = ahead.direction[i];
        let place = relative.displacement[i];
        let corner = (direction != 0.0)
            .then(|| law.on[i].next_corner(&values.joint::<D>()[i], place, direction))
            .flatten();
        ahead.corner[i] = corner.unwrap_or(f64::MAX);
    }
    ahead.write(values);
}

/// Values of the indicators at this motion: of turns, and of corners ahead; `None` where there are none.
pub(super) fn indicators<const D: usize>(
    values: &Values,
    relative: &Motion<D>,
) -> Option<[[f64; D]; 2]> {
    let ahead = || Ahead::of(values).indicators(relative);
    values.have_events().then(ahead)
}

/// Their first-order changes with that of the motion.
pub(super) fn change<const D: usize>(values: &Values, relative: &Motion<D>) -> [[f64; D]; 2] {
    let ahead = Ahead::<D>::of(values);
    [
        std::array::from_fn(|i| ahead.direction[i] * relative.velocity[i]),
        std::array::from_fn(|i| match ahead.corner[i] {
            f64::MAX => 0.0,
            _ => -ahead.direction[i] * relative.displacement[i],
        }),
    ]
}
