//! What small deviations of a periodic motion do to the load of laws that remember.
//!
//! Over one period the load of a DOF depends, beside its present place, on what it remembers from the period before, the places
//! of its turns and loads that relax, and on the places of its turns since.

use std::f64::consts::TAU;

use bolted_joint_dynamics::{
    Dual, Number,
    law::{DofLaws, DofMemory},
};

use super::super::course::Course;
use super::{Changing, GROUP, Loop, Remembering};

/// The load of a DOF's laws along a steady loop, to first order in deviations.
///
/// Its inputs are deviations of: the places of the turns of the period before, loads that relax, and the places of the turns
/// of this period.
pub(in super::super) struct Deviating<'a> {
    laws: DofLaws<Changing>,
    stuck: f64,
    /// With all turns of a period.
    way: Loop<'a>,
    /// Places in the memory of the loads that relax.
    relaxing: Vec<usize>,
    /// For each group of inputs: the memory at the period's begin and after each turn.
    groups: Vec<Vec<DofMemory<Changing>>>,
}

impl Remembering {
    /// Its loop under a motion; `None` where that rests.
    pub(in super::super) fn deviating<'a>(&self, course: Course<'a>) -> Option<Deviating<'a>> {
        let half = Loop::new(course)?;
        let (steady, lasting) = self.steady(&half);
        let mut deviating = Deviating {
            laws: DofLaws::new(self.laws.parameters().map(Changing::from)),
            stuck: self.stuck,
            way: half.whole(),
            relaxing: lasting.into_iter().map(|(place, _)| place).collect(),
            groups: Vec::new(),
        };
        deviating.groups = (0..deviating.inputs())
            .step_by(GROUP)
            .map(|first| deviating.group(first, &steady))
            .collect();
        Some(deviating)
    }
}

impl Deviating<'_> {
    /// Number of inputs from the period before.
    pub(in super::super) fn memories(&self) -> usize {
        self.way.turns.len() + self.relaxing.len()
    }

    /// Number of inputs.
    pub(in super::super) fn inputs(&self) -> usize {
        self.memories() + self.way.turns.len()
    }

    /// τ of the turns.
    pub(in super::super) fn turns(&self) -> &[f64] {
        &self.way.turns
    }

    /// The memories of a period whose inputs from `first` on change.
    fn group(&self, first: usize, steady: &DofMemory) -> Vec<DofMemory<Changing>> {
        let count = self.way.turns.len();
        let input = |input: usize, value: f64| match input.checked_sub(first) {
            Some(direction) if direction < GROUP => Dual::along(value, 1 + direction),
            _ => Dual::from(value),
        };
        let mut memory = steady.map(Changing::from);
        let turn = |memory: &mut DofMemory<Changing>, n: usize, from: usize| {
            let place = input(from + n, self.way.places[n]);
            self.laws.commit(memory, place, Dual::ZERO);
        };
        for n in 0..count {
            turn(&mut memory, n, 0);
        }
        for (n, &place) in self.relaxing.iter().enumerate() {
            memory[place] = input(count + n, memory[place].value);
        }
        let mut memories = vec![memory];
        for n in 0..count {
            turn(&mut memory, n, self.memories());
            memories.push(memory);
        }
        memories
    }

    /// ∂f/∂r beyond that while all sticks, and the derivatives by the inputs, at τ.
    pub(in super::super) fn tangent(&self, phase: f64) -> (f64, Vec<f64>) {
        let branch = self.way.turns.partition_point(|&turn| turn <= phase);
        let [r, _] = self.way.course.motion(phase);
        let mut by_inputs = Vec::with_capacity(self.inputs() + GROUP);
        let mut stiffness = 0.0;
        for memories in &self.groups {
            let load = self
                .laws
                .load(&memories[branch], Dual::along(r, 0), Dual::ZERO);
            let [tangent, by @ ..] = load.change;
            stiffness = tangent - self.stuck;
            by_inputs.extend(by);
        }
        by_inputs.truncate(self.inputs());
        (stiffness, by_inputs)
    }

    /// τ of the corners of the load.
    pub(in super::super) fn corners(&self) -> Vec<f64> {
        let laws = DofLaws::new(self.laws.parameters().map(Number::value));
        let mut waves = vec![0.0; self.way.course.slots()];
        let mut corners = Vec::new();
        let turns = &self.way.turns;
        let (&first, &last) = (&turns[0], &turns[turns.len() - 1]);
        for branch in 0..=turns.len() {
            let begin = branch.checked_sub(1).map_or(last - TAU, |n| turns[n]);
            let end = turns.get(branch).copied().unwrap_or(first + TAU);
            let to = self.way.places[branch % turns.len()];
            let memory = self.groups[0][branch].map(Number::value);
            laws.corners(&memory, to, &mut |corner| {
                corners.extend(
                    self.way
                        .course
                        .passes(corner.place(), [begin, end], &mut waves),
                );
            });
        }
        corners.retain(|&phase| phase > 0.0 && phase < TAU);
        corners
    }

    /// What the next period remembers of this one.
    pub(in super::super) fn after<'d>(
        &'d self,
        deviations: &'d [f64],
    ) -> impl Iterator<Item = f64> + 'd {
        let turns = deviations[self.memories()..].iter().copied();
        let relaxed = self.relaxing.iter().map(move |&place| {
            let mut sum = 0.0;
            for (group, memories) in self.groups.iter().enumerate() {
                let end = &memories[memories.len() - 1];
                let by = &end[place].change[1..];
                let of_group = deviations.iter().skip(group * GROUP);
                sum += by.iter().zip(of_group).map(|(by, d)| by * d).sum::<f64>();
            }
            sum
        });
        turns.chain(relaxed)
    }
}
