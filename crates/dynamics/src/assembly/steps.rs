//! Steps of an assembly in time: the linear part exactly, the joints' forces by collocation at Lobatto's nodes.
//!
//! The forces of a step are a polynomial of time of fourth degree through what the laws give at five nodes, where the motion is
//! that under just these forces (see `stages`). The error of a step is of ninth order in its length. Where it is too large, the
//! step is taken in halves, each in halves again.

use super::{
    coordinates::{AssemblyCoordinates, Parts},
    ladder::{HALVINGS_AT_EVENTS, Ladder},
    propagator::POWERS,
    scratch::{Look, Means, Scratch},
    state::{AssemblyState, Underway},
    system::Assembly,
};

/// Error of a part, in units of what is allowed, up to which one of twice the length is tried next: that has 2⁹ times as much.
const EASY: f64 = 1.0 / 1024.0;

/// Error of the joints' nonlinear part over a period of their own, as a part of the motion, in FMUs and histories.
pub const TOLERANCE: f64 = 1e-7;

/// An assembly made ready for steps of one length.
#[derive(Clone, Debug)]
pub struct AssemblySteps {
    coordinates: AssemblyCoordinates,
    ladder: Ladder,
    tolerance: f64,
    scratch: Vec<Scratch>,
    look: Look,
    is_too_long: bool,
    /// The longest level that is worth a trial, by the latest part.
    longest: usize,
}

impl AssemblySteps {
    /// Prepares steps of `length_s` (s) in which the error of the joints' nonlinear part stays below `tolerance` of the motion
    /// over a period of their own. `None` where the assembly's motion grows beyond all bounds within a step.
    #[must_use]
    pub fn new(assembly: &Assembly, length_s: f64, tolerance: f64) -> Option<Self> {
        Self::within(&AssemblyCoordinates::of(assembly), length_s, tolerance)
    }

    /// The same in coordinates that are known already, which takes less time.
    #[must_use]
    pub fn within(
        coordinates: &AssemblyCoordinates,
        length_s: f64,
        tolerance: f64,
    ) -> Option<Self> {
        let ladder = Ladder::new(&coordinates.0, length_s)?;
        Some(Self {
            tolerance,
            scratch: vec![Scratch::of(&coordinates.0.system); ladder.rungs.len()],
            look: Look::of(&coordinates.0.system),
            ladder,
            coordinates: coordinates.clone(),
            is_too_long: false,
            longest: 0,
        })
    }

    /// The same steps with another tolerance.
    #[must_use]
    pub fn with_tolerance(&self, tolerance: f64) -> Self {
        Self {
            tolerance,
            ..self.clone()
        }
    }

    /// The coordinates in which they go on.
    #[must_use]
    pub fn coordinates(&self) -> &AssemblyCoordinates {
        &self.coordinates
    }

    /// An assembly that has not moved yet.
    #[must_use]
    pub fn at_rest(&self) -> Underway {
        let system = &self.coordinates.0.system;
        Underway::of_size(system.size, system.forces())
    }

    /// Length of the steps, s.
    #[must_use]
    pub fn length_s(&self) -> f64 {
        self.ladder.rungs.first().map_or(0.0, |rung| rung.length_s)
    }

    /// Moves on by one step, in which the loads go from `loads` evenly to `loads` + `change` (m numbers each, and then the
    /// preload of each joint over the preload, N·m). Where the joints ask for it the step is taken in halves, each in halves again,
    /// up to 4096 parts; where that was not enough, [`Self::was_too_long`] says so. Says how many parts it took.
    pub fn step(&mut self, underway: &mut Underway, loads: &[f64], change: &[f64]) -> usize {
        self.step_along(underway, |power, load| match power {
            0 => loads[load],
            1 => change[load],
            _ => 0.0,
        })
    }

    /// The same with loads and preloads that are Σ wₖ θᵏ/k! over the step, θ from 0 to 1: `of` gives wₖ for the power (0 to 3) and
    /// the load or, after all loads, the preload.
    pub fn step_along(
        &mut self,
        underway: &mut Underway,
        of: impl Fn(usize, usize) -> f64,
    ) -> usize {
        let Parts { system, sight, .. } = &*self.coordinates.0;
        if let Some(scratch) = self.scratch.first_mut() {
            scratch.take_loads(of);
            scratch.let_go(system, sight, underway);
        }
        self.is_too_long = false;
        self.longest = 0;
        self.part(underway, 0, HALVINGS_AT_EVENTS)
    }

    /// Moves on by a small part of a step (s), to first order: z + δ ż. Loads and preloads are those of [`Self::step_along`] at its
    /// end.
    pub fn creep(
        &mut self,
        underway: &mut Underway,
        rest_s: f64,
        of: impl Fn(usize, usize) -> f64,
    ) {
        if let Some(scratch) = self.scratch.first_mut() {
            scratch.take_loads(of);
            scratch.creep(&self.coordinates.0, underway, rest_s);
        }
    }

    /// Whether in the latest step one of its shortest parts was still too long for the stiffness of the joints. The step ends there:
    /// the state is not that of its end.
    #[must_use]
    pub fn was_too_long(&self) -> bool {
        self.is_too_long
    }

    /// One step of the given level, with the loads in its scratch, that may still be halved so often at events.
    fn part(&mut self, state: &mut Underway, level: usize, at_events: usize) -> usize {
        if self.is_too_long {
            // nothing holds any more
            return 0;
        }
        let (Some(rung), Some(own)) = (self.ladder.rungs.get(level), self.scratch.get_mut(level))
        else {
            return 0;
        };
        let Parts { system, sight, .. } = &*self.coordinates.0;
        let is_finest = level + 1 == self.ladder.rungs.len();
        let means = Means {
            system,
            sight,
            rung,
        };
        own.follow(system);
        let is_tried = is_finest || level >= self.longest && !own.is_preload_far(system);
        let error = match is_tried {
            true => own.find_forces(means, state, &mut self.look, self.tolerance),
            false => None,
        };
        let is_steep = !error.is_some_and(|error| error <= 1.0);
        let has_event = !is_steep && own.has_event(means, state);
        let at_events = match is_finest {
            true => None,
            false if is_steep => Some(at_events),
            false if has_event => at_events.checked_sub(1),
            false => None,
        };
        let Some(at_events) = at_events else {
            self.is_too_long |= is_steep;
            if error.is_none() {
                own.hold_forces(system, state);
            }
            let is_easy = error.is_some_and(|error| error < EASY);
            self.longest = self.longest.min(level.saturating_sub(usize::from(is_easy)));
            own.go_on(means, state, &mut self.look);
            std::mem::swap(state, &mut own.state);
            return 1;
        };
        if is_tried && is_steep {
            self.longest = level + 1;
        }
        if let [own, next, ..] = &mut self.scratch[level..] {
            halve(&own.loads, &mut next.loads);
        }
        let first = self.part(state, level + 1, at_events);
        if let Some(next) = self.scratch.get_mut(level + 1) {
            go_on(&mut next.loads);
        }
        let second = self.part(state, level + 1, at_events);
        first + second
    }

    /// Energy stored in structures and joints, J; of joints over the preload at that at which the linear part is.
    #[must_use]
    pub fn stored_energy_j(&self, state: &AssemblyState) -> f64 {
        self.coordinates.0.system.stored_energy(state)
    }
}

/// Powers of time of the first half.
fn halve(whole: &[Vec<f64>; POWERS], half: &mut [Vec<f64>; POWERS]) {
    let mut share = 1.0;
    for (half, whole) in half.iter_mut().zip(whole) {
        for (half, whole) in half.iter_mut().zip(whole) {
            *half = share * whole;
        }
        share *= 0.5;
    }
}

/// Powers of time of the part that follows: w(θ + 1) = w₀ + w₁ + w₂/2 + w₃/6 + …
fn go_on([constant, linear, quadratic, cubic, _]: &mut [Vec<f64>; POWERS]) {
    for (i, &w3) in cubic.iter().enumerate() {
        constant[i] += linear[i] + 0.5 * quadratic[i] + w3 / 6.0;
        linear[i] += quadratic[i] + 0.5 * w3;
        quadratic[i] += w3;
    }
}
