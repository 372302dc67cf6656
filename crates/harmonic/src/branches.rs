//! What laws that remember answer to a periodic motion of one DOF, branch by branch.
//!
//! These laws do not know time: from one turn to the next their load follows from the place alone, and what they remember from
//! the places of the turns. So the motion is cut at its turns, the steady state is found by moving on from turn to turn, and the
//! harmonics of the load are integrals over the branches, which are smooth between their corners. The derivatives by the
//! coefficients are exact: a load changes with the present place and with the places of the turns, and these with the
//! coefficients.

use bolted_joint_dynamics::{
    Dual, Number,
    law::{DOF_AT_REST, DofLaws, DofMemory, FORGETFUL_PARAMETER_COUNT, RememberedAs, remembered},
};
use nalgebra::DMatrix;

use super::Harmonics;
use super::course::Course;
use super::quadrature::nodes;

mod deviating;

pub(super) use deviating::Deviating;

/// Turns by whose places loads are differentiated in one go.
const GROUP: usize = 2;
/// A number with its changes by the present place and by the places of as many turns.
type Changing = Dual<3>;
/// Most periods until a load that relaxes is steady.
const MOST_PERIODS: usize = 50;
/// Relative change of such a load in a period below which it is steady as soon as the next one changes it no less.
const NEARLY_STEADY: f64 = 1e-12;

/// Laws that remember, on one DOF: what they answer to its periodic motion.
///
/// ```
/// use bolted_joint_dynamics::law::{DofLaws, Jenkins};
/// use bolted_joint_harmonic::{Harmonics, Remembering};
/// use nalgebra::DMatrix;
///
/// # fn main() -> Result<(), bolted_joint_harmonic::HarmonicError> {
/// let slider = DofLaws::from(Jenkins { stiffness: 2.0, slip_force: 1.0 });
/// let laws = Remembering::of(&slider).expect("a slider remembers");
/// // r = cos τ: it slips half of the way, and its load turns 4 F (1 − F/k) into heat
/// let (mut load, mut by_motion) = (vec![0.0; 2], DMatrix::zeros(2, 2));
/// laws.add_harmonics(&Harmonics::odd(1)?, &[1.0, 0.0], &mut load, &mut by_motion);
/// assert!((-std::f64::consts::PI * load[1] - 2.0).abs() < 1e-12);
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Remembering {
    laws: DofLaws,
    /// ∂f/∂r before the first motion: N/m, N·m/rad.
    stuck: f64,
}

/// The branches of a steady loop.
struct Loop<'a> {
    course: Course<'a>,
    /// τ of each turn.
    turns: Vec<f64>,
    /// Place of each turn, m or rad.
    places: Vec<f64>,
}

impl Remembering {
    /// Those of the laws on a DOF that remember, `None` where none does. LuGre's law must not be among them,
    /// whose load depends on how fast it slips.
    #[must_use]
    pub fn of(laws: &DofLaws) -> Option<Self> {
        let mut parameters = *laws.parameters();
        parameters[..FORGETFUL_PARAMETER_COUNT].fill(0.0);
        let laws = DofLaws::new(parameters);
        (!laws.are_none()).then(|| Self::new(laws))
    }

    pub(super) fn new(laws: DofLaws) -> Self {
        let changing = DofLaws::new(laws.parameters().map(Dual::<1>::from));
        let at_rest = changing.load(&DOF_AT_REST, Dual::along(0.0, 0), Dual::ZERO);
        Self {
            laws,
            stuck: at_rest.change[0],
        }
    }

    /// Stiffness while all sticks, N/m or N·m/rad.
    pub(super) fn stuck(&self) -> f64 {
        self.stuck
    }

    /// Adds the harmonics of the load at a motion r(t) = a₀ + Σ (a_h cos hωt + b_h sin hωt), and their derivatives by its
    /// coefficients, all in the order of the [`Harmonics`].
    ///
    /// # Panics
    /// Where a list or the matrix has another size than the harmonics have coefficients.
    pub fn add_harmonics(
        &self,
        harmonics: &Harmonics,
        motion: &[f64],
        load: &mut [f64],
        by_motion: &mut DMatrix<f64>,
    ) {
        for (n, (load, coefficient)) in load.iter_mut().zip(motion).enumerate() {
            *load += self.stuck * coefficient;
            by_motion[(n, n)] += self.stuck;
        }
        self.add(Course::new(harmonics, motion), 0, load, by_motion);
    }

    /// Adds the harmonics of the load beyond that of the stiffness while all sticks, and their derivatives by the coefficients,
    /// which begin at `from` in both.
    pub(super) fn add(
        &self,
        course: Course<'_>,
        from: usize,
        residual: &mut [f64],
        jacobian: &mut DMatrix<f64>,
    ) {
        let Some(way) = Loop::new(course) else {
            return;
        };
        let slots = course.slots();
        let (steady, lasting) = self.steady(&way);
        let changing = DofLaws::new(self.laws.parameters().map(Changing::from));
        for first in (0..way.turns.len()).step_by(GROUP) {
            let group = first..(first + GROUP).min(way.turns.len());
            let memories = memories(&changing, &way, &steady, &lasting, group.clone());
            let mut sums = Sums::new(slots);
            for (branch, memory) in memories.iter().enumerate() {
                self.integrate(&way, branch, &changing, memory, first == 0, &mut sums);
            }
            sums.add(&way, group, from, residual, jacobian);
        }
    }

    /// The memory at the end of a steady period, and by how much of its change each number in it that relaxes still changes
    /// after a [part](Loop::part) of a period.
    fn steady(&self, way: &Loop<'_>) -> (DofMemory, Vec<(usize, f64)>) {
        let mut memory = DOF_AT_REST;
        way.period(&self.laws, &mut memory, &way.places);
        // Masing's laws have come to their loop. A load that relaxes comes to it by Newton's method.
        let relaxing: Vec<usize> = remembered()
            .filter(|(_, _, of)| of.quantity == RememberedAs::Load)
            .map(|(place, _, _)| place)
            .filter(|&place| memory[place] != 0.0)
            .collect();
        let mut lasting: Vec<(usize, f64)> = Vec::new();
        if relaxing.is_empty() {
            return (memory, lasting);
        }
        let laws = DofLaws::new(self.laws.parameters().map(Dual::<1>::from));
        let places: Vec<Dual<1>> = way.places.iter().map(|&place| place.into()).collect();
        let mut last = f64::INFINITY;
        for _ in 0..MOST_PERIODS {
            let mut after = memory.map(Dual::<1>::from);
            for &place in &relaxing {
                after[place] = Dual::along(memory[place], 0);
            }
            let begun: Vec<f64> = relaxing.iter().map(|&place| memory[place]).collect();
            way.part(&laws, &mut after, &places);
            let parted: Vec<Dual<1>> = relaxing.iter().map(|&place| after[place]).collect();
            way.rest(&laws, &mut after, &places);
            memory = after.map(|number| number.value);
            lasting.clear();
            let mut moves: f64 = 0.0;
            for ((&place, before), parted) in relaxing.iter().zip(begun).zip(parted) {
                // s = ±g(s), with the upper sign where the part is all of the period
                let (reached, lasts) = (way.sign() * parted.value, way.sign() * parted.change[0]);
                let step = (reached - before) / (1.0 - lasts);
                moves = moves.max(step.abs() / (reached.abs() + before.abs()));
                memory[place] = before + step;
                lasting.push((place, lasts));
            }
            if moves.is_nan()
                || moves < 4.0 * f64::EPSILON
                || moves < NEARLY_STEADY && moves >= last
            {
                break;
            }
            last = moves;
        }
        (memory, lasting)
    }

    /// Adds the integrals over a branch.
    fn integrate(
        &self,
        way: &Loop<'_>,
        branch: usize,
        changing: &DofLaws<Changing>,
        memory: &DofMemory<Changing>,
        is_first: bool,
        sums: &mut Sums,
    ) {
        let [begin, end] = way.ends(branch);
        let mut stops = vec![begin, end];
        let plain = memory.map(Number::value);
        self.laws
            .corners(&plain, way.place_after(branch), &mut |corner| {
                stops.extend(
                    way.course
                        .passes(corner.place(), [begin, end], &mut sums.waves),
                );
            });
        stops.sort_by(f64::total_cmp);
        for panel in stops.windows(2) {
            let length = panel[1] - panel[0];
            if length <= 0.0 {
                continue;
            }
            // products of two harmonics are the fastest
            for &(part, weight) in nodes(2.0 * way.course.highest() * length) {
                way.course.waves(panel[0] + length * part, &mut sums.waves);
                let r = way.course.place(&sums.waves);
                let load = changing.load(memory, Dual::along(r, 0), Dual::ZERO);
                let [tangent, by_turns @ ..] = load.change;
                let weight = length * weight;
                if is_first {
                    let (load, tangent) = (load.value - self.stuck * r, tangent - self.stuck);
                    sums.add_present(weight * load, weight * tangent);
                }
                sums.add_turns(weight, by_turns);
            }
        }
    }
}

/// The memory at the begin of each branch of the steady loop, with its changes by the places of a group of turns.
fn memories(
    laws: &DofLaws<Changing>,
    way: &Loop<'_>,
    steady: &DofMemory,
    lasting: &[(usize, f64)],
    group: std::ops::Range<usize>,
) -> Vec<DofMemory<Changing>> {
    let places: Vec<Changing> = way
        .places
        .iter()
        .enumerate()
        .map(|(n, &place)| {
            if group.contains(&n) {
                Dual::along(place, 1 + n - group.start)
            } else {
                place.into()
            }
        })
        .collect();
    let mut memory = steady.map(Changing::from);
    way.period(laws, &mut memory, &places);
    if !lasting.is_empty() {
        // again, now that the place where a period begins changes too
        for &(place, _) in lasting {
            memory[place] = Dual::from(steady[place]);
        }
        way.part(laws, &mut memory, &places);
        // s = ±g(s, u): ds = ±(∂g/∂u)/(1 ∓ ∂g/∂s) du
        let by_turns = |&(place, lasts): &(usize, f64)| {
            let change = memory[place].change;
            change.map(|change| way.sign() * change / (1.0 - lasts))
        };
        let by_turns: Vec<[f64; 3]> = lasting.iter().map(by_turns).collect();
        way.rest(laws, &mut memory, &places);
        for (&(place, _), change) in lasting.iter().zip(by_turns) {
            memory[place] = Dual::new(steady[place], change);
        }
    }
    let mut begins = Vec::with_capacity(places.len());
    for &place in &places {
        laws.commit(&mut memory, place, Dual::ZERO);
        begins.push(memory);
    }
    begins
}

impl<'a> Loop<'a> {
    /// That of a motion; `None` where it rests.
    fn new(course: Course<'a>) -> Option<Self> {
        let turns = course.turns();
        let places = turns.iter().map(|&turn| course.motion(turn)[0]).collect();
        (!turns.is_empty()).then_some(Self {
            course,
            turns,
            places,
        })
    }

    /// The same with the turns of the whole period.
    fn whole(mut self) -> Self {
        if self.course.is_odd() {
            for n in 0..self.turns.len() {
                self.turns.push(self.turns[n] + self.course.span());
                self.places.push(-self.places[n]);
            }
        }
        self
    }

    /// Moves a memory on over one period.
    fn period<N: Number>(&self, laws: &DofLaws<N>, memory: &mut DofMemory<N>, places: &[N]) {
        self.part(laws, memory, places);
        self.rest(laws, memory, places);
    }

    /// Over the part of it whose motion tells all: half of it where the motion is odd. What is steady is there what it was, or
    /// the opposite of that.
    fn part<N: Number>(&self, laws: &DofLaws<N>, memory: &mut DofMemory<N>, places: &[N]) {
        for &place in places {
            laws.commit(memory, place, N::ZERO);
        }
    }

    /// Over what is left of it then.
    fn rest<N: Number>(&self, laws: &DofLaws<N>, memory: &mut DofMemory<N>, places: &[N]) {
        if self.course.is_odd() {
            for &place in places {
                laws.commit(memory, -place, N::ZERO);
            }
        }
    }

    /// What a steady load is after the part to what it was before: 1, and −1 where the motion is odd.
    fn sign(&self) -> f64 {
        if self.course.is_odd() { -1.0 } else { 1.0 }
    }

    /// τ of a branch's ends.
    fn ends(&self, branch: usize) -> [f64; 2] {
        let end = match self.turns.get(branch + 1) {
            Some(&next) => next,
            None => self.turns[0] + self.course.span(),
        };
        [self.turns[branch], end]
    }

    /// Place of the turn at which a branch ends.
    fn place_after(&self, branch: usize) -> f64 {
        match self.places.get(branch + 1) {
            Some(&next) => next,
            None if self.course.is_odd() => -self.places[0],
            None => self.places[0],
        }
    }
}

/// Integrals of the load and of its derivatives times each harmonic.
struct Sums {
    load: Vec<f64>,
    /// By the place of each turn of the group.
    by_turns: [Vec<f64>; GROUP],
    /// ∂f/∂r times two harmonics: the rows at and above the diagonal.
    products: DMatrix<f64>,
    /// The harmonics at the present moment.
    waves: Vec<f64>,
}

impl Sums {
    fn new(slots: usize) -> Self {
        let list = || vec![0.0; slots];
        Self {
            load: list(),
            by_turns: [list(), list()],
            products: DMatrix::zeros(slots, slots),
            waves: list(),
        }
    }

    fn add_present(&mut self, load: f64, tangent: f64) {
        for (column, &wave) in self.waves.iter().enumerate() {
            self.load[column] += load * wave;
            let by = tangent * wave;
            let mut rows = self.products.column_mut(column);
            for (row, &other) in self.waves[..=column].iter().enumerate() {
                rows[row] += by * other;
            }
        }
    }

    fn add_turns(&mut self, weight: f64, by_turns: [f64; GROUP]) {
        for (sums, change) in self.by_turns.iter_mut().zip(by_turns) {
            if change != 0.0 {
                for (sum, &wave) in sums.iter_mut().zip(&self.waves) {
                    *sum += weight * change * wave;
                }
            }
        }
    }

    /// Makes harmonics of them.
    fn add(
        mut self,
        way: &Loop<'_>,
        group: std::ops::Range<usize>,
        from: usize,
        residual: &mut [f64],
        jacobian: &mut DMatrix<f64>,
    ) {
        let slots = self.load.len();
        // (2/T) ∫ f cos hτ dτ, and (1/T) ∫ f dτ
        let norm = |slot: usize| way.course.norm(slot) / way.course.span();
        for row in 0..slots {
            residual[from + row] += norm(row) * self.load[row];
            for column in 0..slots {
                let (low, high) = (row.min(column), row.max(column));
                jacobian[(from + row, from + column)] += norm(row) * self.products[(low, high)];
            }
        }
        for (turn, sums) in group.zip(&self.by_turns) {
            // the place of a turn changes as the motion there, which rests
            way.course.waves(way.turns[turn], &mut self.waves);
            for (column, &wave) in self.waves.iter().enumerate() {
                for row in 0..slots {
                    jacobian[(from + row, from + column)] += norm(row) * sums[row] * wave;
                }
            }
        }
    }
}

#[cfg(test)]
mod tests;
