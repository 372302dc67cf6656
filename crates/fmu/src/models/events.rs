//! Events of Model Exchange: where a joint that remembers turns, and where its load has a corner. An importer that places them
//! completes a step there, so that the joint is committed at the very point.
//!
//! Both indicators are positive where the joint moves on. They change by themselves only while they are; one that has fallen
//! to zero stays there until the event is entered. So none is ever zero at rest.

use bolted_joint_dynamics::{DofLaws, DofMemory, JointLaw, Motion};

use crate::{interface::Values, values::Ahead};

/// Velocity against the direction of motion below which no turn is told, m/s or rad/s: a billionth of what is usual.
const MARGIN: f64 = 1e-10;

/// The same as a part of the largest velocity up to now. What the joint goes beyond its turn meanwhile is the square of that.
const MARGIN_PART: f64 = 1e-7;

/// Indicator where no corner is ahead, m or rad.
const NO_CORNER: f64 = 1.0;

/// Nothing has moved yet.
const AT_REST: Ahead = [0.0, 0.0, f64::MAX];

/// Indicators of a DOF at this relative displacement and rate: of a turn, and of a corner ahead.
pub(super) fn indicators_on(
    &[direction, speed, corner]: &Ahead,
    r: f64,
    velocity: f64,
) -> [f64; 2] {
    let ahead = match corner {
        f64::MAX => NO_CORNER,
        corner => direction * (corner - r),
    };
    [direction * velocity + MARGIN + MARGIN_PART * speed, ahead]
}

/// Their first-order changes with those of the motion.
pub(super) fn change_on(&[direction, _, corner]: &Ahead, r: f64, velocity: f64) -> [f64; 2] {
    let ahead = match corner {
        f64::MAX => 0.0,
        _ => -direction * r,
    };
    [direction * velocity, ahead]
}

/// Begins to look for events on a DOF.
pub(super) fn begin_on(
    ahead: &mut Ahead,
    (laws, memory): (&DofLaws, &DofMemory),
    r: f64,
    velocity: f64,
) {
    *ahead = AT_REST;
    look_ahead_on(ahead, (laws, memory), [r, velocity], true);
}

/// Looks ahead on a DOF from its relative displacement and rate, which are committed: at an event the joint may have turned.
pub(super) fn look_ahead_on(
    ahead: &mut Ahead,
    (laws, memory): (&DofLaws, &DofMemory),
    [r, velocity]: [f64; 2],
    is_event: bool,
) {
    let [turning, corner_ahead] = indicators_on(ahead, r, velocity);
    let [direction, speed, corner] = ahead;
    *speed = speed.max(velocity.abs()).min(f64::MAX);
    let is_ahead = turning > 0.0 && corner_ahead > 0.0;
    if !(is_ahead || is_event) {
        return;
    }
    let has_turned = is_event && velocity * *direction < 0.0;
    if has_turned || *direction == 0.0 && velocity.abs() > MARGIN {
        *direction = velocity.signum();
    }
    let next = (*direction != 0.0)
        .then(|| laws.next_corner(memory, r, *direction))
        .flatten();
    *corner = next.unwrap_or(f64::MAX);
}

/// Begins to look for events at the present motion.
pub(super) fn begin<const D: usize>(values: &mut Values, law: &JointLaw<D>, relative: &Motion<D>) {
    values.set_ahead(&[AT_REST; D]);
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
    let mut all = values.ahead::<D>();
    let memory = values.joint::<D>();
    for (i, ahead) in all.iter_mut().enumerate() {
        let motion = [relative.displacement[i], relative.velocity[i]];
        look_ahead_on(ahead, (&law.on[i], &memory[i]), motion, is_event);
    }
    values.set_ahead(&all);
}

/// Values of the indicators at this motion: of turns, and of corners ahead; `None` where there are none.
pub(super) fn indicators<const D: usize>(
    values: &Values,
    relative: &Motion<D>,
) -> Option<[[f64; D]; 2]> {
    let all = || values.ahead::<D>();
    values
        .have_events()
        .then(|| by_kind(&all(), relative, indicators_on))
}

/// Their first-order changes with that of the motion.
pub(super) fn change<const D: usize>(values: &Values, relative: &Motion<D>) -> [[f64; D]; 2] {
    by_kind(&values.ahead::<D>(), relative, change_on)
}

/// What `of` gives on each DOF, of turns and of corners.
fn by_kind<const D: usize>(
    all: &[Ahead; D],
    relative: &Motion<D>,
    of: impl Fn(&Ahead, f64, f64) -> [f64; 2],
) -> [[f64; D]; 2] {
    let on = |i: usize| of(&all[i], relative.displacement[i], relative.velocity[i]);
    [0, 1].map(|kind: usize| std::array::from_fn(|i| on(i)[kind]))
}
