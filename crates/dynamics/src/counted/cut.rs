//! Steps of a joint that remembers, cut where it turns or where its load has a corner: between the cuts all is smooth, so that
//! the Runge–Kutta method keeps its order.

use super::{CountedState, LapConditions};
use crate::{
    lap::LapLoads,
    law::{Corner, DofLaws, DofMemory, JointLaw, JointMemory},
    motion::Motion,
};

/// Most cuts of a step; what is beyond is committed at its end.
const MOST_CUTS: usize = 8;
/// Part of a step at its ends in which nothing is cut: the error that stays is that part's square.
const NEAR_AN_END: f64 = 1e-5;
/// Bisections of a part of a step.
const BISECTIONS: usize = 50;

/// The motion of one DOF over a step: the cubic through displacements and velocities at its ends.
#[derive(Clone, Copy, Debug)]
struct Course {
    /// Displacements, m or rad.
    places: [f64; 2],
    /// Velocities times the length of the step.
    ways: [f64; 2],
}

impl<const D: usize> LapConditions<D> {
    /// One step, cut where it must be.
    pub(super) fn cut_step(
        conditions: [&Self; 3],
        counted: &CountedState<D>,
        memory: &mut JointMemory<D>,
        step_s: f64,
    ) -> CountedState<D> {
        let [start, _, end] = conditions;
        let law = &start.lap.joint;
        let mut counted = *counted;
        // part of the step that is behind
        let mut done = 0.0;
        for cuts in 0..=MOST_CUTS {
            let left_s = step_s * (1.0 - done);
            let next = if done == 0.0 {
                Self::plain_step(conditions, &counted, memory, step_s)
            } else {
                let parts = [done, 0.5 * (done + 1.0), 1.0];
                let stages = parts.map(|part| Self::within(conditions, part));
                Self::plain_step(stages.each_ref(), &counted, memory, left_s)
            };
            let (before, after) = (counted.state.relative(), next.state.relative());
            let cut = law.first_cut(memory, [&before, &after], left_s);
            let Some(cut) = cut.filter(|_| cuts < MOST_CUTS) else {
                counted = next;
                break;
            };
            let at = done + cut * (1.0 - done);
            let stages = [done, 0.5 * (done + at), at].map(|part| Self::within(conditions, part));
            let part_s = step_s * (at - done);
            counted = Self::plain_step(stages.each_ref(), &counted, memory, part_s);
            counted.passed.dissipated += law.commit(memory, &counted.state.relative());
            done = at;
        }
        counted.passed.dissipated += end.lap.joint.commit(memory, &counted.state.relative());
        counted
    }

    /// The conditions at a part of the step: the loads as the parabola through the three, the rest as where it is nearest.
    fn within([start, middle, end]: [&Self; 3], part: f64) -> Self {
        let nearest = match part {
            part if part < 0.25 => start,
            part if part > 0.75 => end,
            _ => middle,
        };
        // Lagrange's polynomials of the three
        let weights = [
            (1.0 - part) * (1.0 - 2.0 * part),
            4.0 * part * (1.0 - part),
            part * (2.0 * part - 1.0),
        ];
        let loads = [start, middle, end].map(|at| &at.loads);
        let sum = |of: fn(&LapLoads<D>) -> &[f64; D]| {
            std::array::from_fn(|i| (0..3).map(|n| weights[n] * of(loads[n])[i]).sum())
        };
        Self {
            loads: LapLoads {
                a: sum(|loads| &loads.a),
                b: sum(|loads| &loads.b),
            },
            ..*nearest
        }
    }
}

impl<const D: usize> JointLaw<D> {
    /// Moves what the joint remembers on from one relative motion to another, `step_s` (s) later, as a step of a lap does: with
    /// a commit where it turns or its load has a corner, on the cubic through both motions, and one at the end.
    pub fn follow(
        &self,
        memory: &mut JointMemory<D>,
        [before, after]: [&Motion<D>; 2],
        step_s: f64,
    ) {
        let whole: [Course; D] = std::array::from_fn(|i| Course::of(i, [before, after], step_s));
        let at = |part: f64| Motion {
            displacement: whole.map(|course| course.place(part)),
            velocity: whole.map(|course| course.way(part) / step_s),
        };
        let mut done = 0.0;
        for _ in 0..MOST_CUTS {
            let left_s = step_s * (1.0 - done);
            let from = if done == 0.0 { *before } else { at(done) };
            let Some(cut) = self.first_cut(memory, [&from, after], left_s) else {
                break;
            };
            done += cut * (1.0 - done);
            self.commit(memory, &at(done));
        }
        self.commit(memory, after);
    }

    /// The first part of a step at which the joint turns or its load has a corner, if it is not near the step's ends.
    fn first_cut(
        &self,
        memory: &JointMemory<D>,
        motions: [&Motion<D>; 2],
        step_s: f64,
    ) -> Option<f64> {
        (0..D)
            .filter(|&i| self.on[i].have_memory())
            .filter_map(|i| Course::of(i, motions, step_s).first_event(&self.on[i], &memory[i]))
            .min_by(f64::total_cmp)
            .filter(|&part| part < 1.0 - NEAR_AN_END)
    }
}

impl Course {
    fn of<const D: usize>(i: usize, [before, after]: [&Motion<D>; 2], step_s: f64) -> Self {
        Self {
            places: [before.displacement[i], after.displacement[i]],
            ways: [before.velocity[i] * step_s, after.velocity[i] * step_s],
        }
    }

    /// Displacement at a part of the step.
    fn place(&self, part: f64) -> f64 {
        let ([from, to], [first, last]) = (self.places, self.ways);
        // Hermite: r₀ + s (h v₀ + s (3Δ − 2 h v₀ − h v₁ + s (h v₀ + h v₁ − 2Δ))), Δ = r₁ − r₀
        let gone = to - from;
        let second = 3.0 * gone - 2.0 * first - last;
        from + part * (first + part * (second + part * (first + last - 2.0 * gone)))
    }

    /// Its derivative by that part.
    fn way(&self, part: f64) -> f64 {
        let ([from, to], [first, last]) = (self.places, self.ways);
        let gone = to - from;
        let second = 3.0 * gone - 2.0 * first - last;
        first + part * (2.0 * second + 3.0 * part * (first + last - 2.0 * gone))
    }

    /// The first part of the step, not near its start, at which the DOF turns or its load has a corner.
    fn first_event(&self, laws: &DofLaws, memory: &DofMemory) -> Option<f64> {
        let turns = self.ways[0] * self.ways[1] < 0.0;
        let turn = turns.then(|| bisected(|part| self.way(part) * self.ways[1].signum()));
        let is_turn = turn.filter(|&part| part > NEAR_AN_END);
        // after a turn near the start the way goes on from there
        let (begin, end) = match turn {
            Some(part) if part <= NEAR_AN_END => (self.place(part), 1.0),
            Some(part) => (self.places[0], part),
            None => (self.places[0], 1.0),
        };
        let to = self.place(end);
        let mut first = is_turn;
        laws.corners(memory, to, &mut |corner| {
            let Corner::Sharp(corner) = corner else {
                return;
            };
            if (corner - begin) * (to - corner) > 0.0 {
                let direction = (to - begin).signum();
                let part = end * bisected(|part| (self.place(part * end) - corner) * direction);
                if part > NEAR_AN_END && first.is_none_or(|first| part < first) {
                    first = Some(part);
                }
            }
        });
        first
    }
}

/// Where between 0 and 1 a function that goes up passes zero.
fn bisected(of: impl Fn(f64) -> f64) -> f64 {
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..BISECTIONS {
        let middle = 0.5 * (low + high);
        if of(middle) < 0.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}
