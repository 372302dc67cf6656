//! Steps of an assembly in time: the linear part exactly, the joints' laws by Krogstad's exponential Runge–Kutta scheme.
//!
//! S. Krogstad, J. Comput. Phys. 203 (2005) 72, condensed on the relative motions of the joints: a step takes one product with the
//! whole state, its four stages take products of the joints' own size. Its order is four. What it leaves of the joints' forces is
//! the parabola of time through f₁, (f₂ + f₃)/2 and f₄.

use super::{
    ladder::{Ladder, Rung},
    matrix::dot,
    propagator::{Blocks, POWERS},
    system::{Assembly, System},
};
use crate::law::{Corner, DOF_AT_REST, DofMemory};

/// Angle h ω_t, with ω_t the highest frequency that the laws' tangents give the joints, up to which the scheme's error is a
/// millionth over a period of that frequency, …
const ANGLE_AT_A_MILLIONTH: f64 = 0.13;
/// … which is of fourth order.
const MILLIONTH: f64 = 1e-6;

/// Motion of an assembly, what its joints remember, and the energies that have passed.
#[derive(Clone, Debug, PartialEq)]
pub struct AssemblyState {
    /// Coordinates q, and then their rates, 2n of them.
    pub motion: Vec<f64>,
    /// What the laws remember on each DOF that has any, joint by joint.
    pub memory: Vec<DofMemory>,
    /// Work of the loads, J.
    pub supplied_j: f64,
    /// Heat of structures and joints, J.
    pub dissipated_j: f64,
}

/// An assembly made ready for steps of one length.
#[derive(Clone, Debug)]
pub struct AssemblySteps {
    system: System,
    ladder: Ladder,
    largest_angle: f64,
    scratch: Vec<Scratch>,
}

/// Room for what a step computes, one for each halving.
#[derive(Clone, Debug)]
struct Scratch {
    state: AssemblyState,
    loads: Vec<f64>,
    change: Vec<f64>,
    /// Relative motions (r, ṙ) at the beginning, at the stages, and at the end.
    relative: [Vec<f64>; 5],
    /// Forces of the four stages.
    forces: [Vec<f64>; 4],
    /// Loads and forces as powers of time.
    powers: [Vec<f64>; POWERS],
    /// ∫ Rq dt and its integral.
    moments: [Vec<f64>; 2],
    /// ∂f/∂r of each law.
    tangents: Vec<f64>,
}

impl AssemblySteps {
    /// Prepares steps of `length_s` (s) in which the error of the joints' nonlinear part stays below `tolerance` of the motion
    /// over a period of their own. `None` where the assembly's motion grows beyond all bounds within a step.
    #[must_use]
    pub fn new(assembly: &Assembly, length_s: f64, tolerance: f64) -> Option<Self> {
        let system = System::of(assembly);
        let ladder = Ladder::new(&system, length_s)?;
        let scratch = vec![Scratch::of(&system); ladder.rungs.len()];
        Some(Self {
            // h ω_t ≤ 0.13 (ε/10⁻⁶)^¼
            largest_angle: ANGLE_AT_A_MILLIONTH * (tolerance / MILLIONTH).sqrt().sqrt(),
            system,
            ladder,
            scratch,
        })
    }

    /// An assembly that has not moved yet.
    #[must_use]
    pub fn at_rest(&self) -> AssemblyState {
        AssemblyState::at_rest(&self.system)
    }

    /// Length of the steps, s.
    #[must_use]
    pub fn length_s(&self) -> f64 {
        self.ladder.rungs.first().map_or(0.0, |rung| rung.length_s)
    }

    /// Moves the state on by one step, in which the loads go from `loads` evenly to `loads` + `change` (m numbers each). Where the
    /// joints ask for it the step is taken in halves, each in halves again, up to 256 parts. Says how many parts it took.
    pub fn step(&mut self, state: &mut AssemblyState, loads: &[f64], change: &[f64]) -> usize {
        if let Some(scratch) = self.scratch.first_mut() {
            scratch.loads.copy_from_slice(loads);
            scratch.change.copy_from_slice(change);
        }
        self.part(state, 0)
    }

    /// One step of the given level, with the loads in its scratch.
    fn part(&mut self, state: &mut AssemblyState, level: usize) -> usize {
        let (Some(rung), Some((own, finer))) = (
            self.ladder.rungs.get(level),
            self.scratch
                .get_mut(level..)
                .and_then(<[_]>::split_first_mut),
        ) else {
            return 0;
        };
        own.take(&self.system, rung, state);
        let is_finest = finer.is_empty();
        if is_finest || !own.asks_for_halves(&self.system, rung, state, self.largest_angle) {
            std::mem::swap(state, &mut own.state);
            return 1;
        }
        if let Some(next) = finer.first_mut() {
            next.loads.copy_from_slice(&own.loads);
            for (half, whole) in next.change.iter_mut().zip(&own.change) {
                *half = 0.5 * whole;
            }
        }
        let first = self.part(state, level + 1);
        if let Some(next) = self.scratch.get_mut(level + 1) {
            for (load, half) in next.loads.iter_mut().zip(&next.change) {
                *load += half;
            }
        }
        first + self.part(state, level + 1)
    }

    /// Energy stored in structures and joints, J.
    #[must_use]
    pub fn stored_energy_j(&self, state: &AssemblyState) -> f64 {
        self.system.stored_energy(state)
    }
}

impl AssemblyState {
    fn at_rest(system: &System) -> Self {
        Self {
            motion: vec![0.0; 2 * system.size],
            memory: vec![DOF_AT_REST; system.laws.len()],
            supplied_j: 0.0,
            dissipated_j: 0.0,
        }
    }
}

impl System {
    fn stored_energy(&self, state: &AssemblyState) -> f64 {
        let laws = self.laws.iter().zip(&state.memory).enumerate();
        let of_laws: f64 = laws
            .map(|(i, (laws, memory))| {
                let r = dot(self.rows.row(i), &state.motion[..self.size]);
                laws.stored_energy(memory, r)
            })
            .sum();
        self.linear_energy(&state.motion) + of_laws
    }

    /// f of every law, at relative motions and from what they remember.
    fn forces(&self, memory: &[DofMemory], relative: &[f64], forces: &mut [f64]) {
        let (r, velocity) = relative.split_at(self.laws.len());
        for (i, force) in forces.iter_mut().enumerate() {
            *force = self.laws[i].load(&memory[i], r[i], velocity[i]);
        }
    }
}

impl Scratch {
    fn of(system: &System) -> Self {
        let (m, d) = (system.loads, system.laws.len());
        Self {
            state: AssemblyState::at_rest(system),
            loads: vec![0.0; m],
            change: vec![0.0; m],
            relative: std::array::from_fn(|_| vec![0.0; 2 * d]),
            forces: std::array::from_fn(|_| vec![0.0; d]),
            powers: std::array::from_fn(|_| vec![0.0; m + d]),
            moments: std::array::from_fn(|_| vec![0.0; m + d]),
            tangents: vec![0.0; d],
        }
    }

    /// The step from `before` to this scratch's state.
    fn take(&mut self, system: &System, rung: &Rung, before: &AssemblyState) {
        let (m, d) = (system.loads, system.laws.len());
        let whole = &rung.whole;
        self.powers.iter_mut().for_each(|power| power.fill(0.0));
        self.powers[0][..m].copy_from_slice(&self.loads);
        self.powers[1][..m].copy_from_slice(&self.change);
        // y¹ = E y + loads
        let end = &mut self.state.motion;
        end.fill(0.0);
        whole.state.add_product_to(&before.motion, end);
        for (block, power) in whole.by.iter().zip(&self.powers).take(2) {
            block.add_product_to(power, end);
        }
        if let Some(middle) = &rung.middle {
            let [r0, r2, r3, r4, _] = &mut self.relative;
            let [f1, f2, f3, f4] = &mut self.forces;
            system.relative(&before.motion, r0);
            system.forces(&before.memory, r0, f1);
            // y^½ = E_½ y + loads
            r2.fill(0.0);
            middle.by_state.add_product_to(&before.motion, r2);
            middle.by_loads[0].add_product_to(&self.loads, r2);
            // at half the step half of the change has come
            for (i, r2) in r2.iter_mut().enumerate() {
                *r2 += 0.5 * dot(middle.by_loads[1].row(i), &self.change);
            }
            r3.copy_from_slice(r2);
            system.relative(end, r4);
            // f₂ = f(y^½ + i₁ f₁)
            middle.of_half[0].add_product_to(f1, r2);
            system.forces(&before.memory, r2, f2);
            // f₃ = f(y^½ + (i₁ − 2i₂) f₁ + 2i₂ f₂)
            middle.of_half[1].add_product_to(f1, r3);
            middle.of_half[2].add_product_to(f2, r3);
            system.forces(&before.memory, r3, f3);
            // f₄ = f(y¹ + (j₁ − 2j₂) f₁ + 2j₂ f₃)
            middle.of_whole[0].add_product_to(f1, r4);
            middle.of_whole[1].add_product_to(f3, r4);
            system.forces(&before.memory, r4, f4);
            // f(θ) = f₁ + (−3f₁ + 4f_m − f₄) θ + (2f₁ − 4f_m + 2f₄) θ², f_m = (f₂ + f₃)/2
            for i in 0..d {
                let middle = 0.5 * (f2[i] + f3[i]);
                self.powers[0][m + i] = f1[i];
                self.powers[1][m + i] = -3.0 * f1[i] + 4.0 * middle - f4[i];
                self.powers[2][m + i] = 2.0 * (2.0 * f1[i] - 4.0 * middle + 2.0 * f4[i]);
            }
            for (block, power) in whole.by.iter().zip(&self.powers) {
                block.add_product_of_tail_to(&power[m..], end);
            }
            system.relative(end, &mut self.relative[4]);
        }
        self.count(system, rung, before);
    }

    /// What the step supplies and turns into heat, and what the joints remember after it.
    fn count(&mut self, system: &System, rung: &Rung, before: &AssemblyState) {
        let h = rung.length_s;
        let (m, d) = (system.loads, system.laws.len());
        self.moments_over(&rung.whole, &before.motion);
        let [first, second] = &self.moments;
        let place = |state: &[f64], p: usize| match p.checked_sub(m) {
            None => dot(system.load_rows.row(p), &state[..system.size]),
            Some(law) => dot(system.rows.row(law), &state[..system.size]),
        };
        // ∫ wᵀ ẋ dt = [wᵀ x] − ∫ ẇᵀ x dt, with w = w₀ + w₁ θ + w₂ θ²/2, θ = t/h, and ∫ θ x dt = ∫ x dt − ∬ x dt²/h
        let work = |p: usize| {
            let [w0, w1, w2] = [0, 1, 2].map(|power: usize| self.powers[power][p]);
            let (from, to) = (place(&before.motion, p), place(&self.state.motion, p));
            let moment = first[p] - second[p] / h;
            (w0 + w1 + 0.5 * w2) * to - w0 * from - (w1 * first[p] + w2 * moment) / h
        };
        let supplied: f64 = (0..m).map(work).sum();
        let into_laws: f64 = (m..m + d).map(work).sum();
        let stored =
            system.linear_energy(&self.state.motion) - system.linear_energy(&before.motion);
        // what of the work is neither stored nor given to the laws is heat of the linear dampers
        let mut heat = supplied - into_laws - stored;
        let [begin, .., end] = &self.relative;
        for i in 0..d {
            let (laws, memory) = (&system.laws[i], &mut self.state.memory[i]);
            let [r, velocity] = [[begin[i], end[i]], [begin[d + i], end[d + i]]];
            let middle = 0.5 * (r[0] + r[1]) + 0.125 * h * (velocity[0] - velocity[1]);
            let rate = 1.5 * (r[1] - r[0]) / h - 0.25 * (velocity[0] + velocity[1]);
            // Simpson's rule
            let ends =
                laws.viscous_power(r[0], velocity[0]) + laws.viscous_power(r[1], velocity[1]);
            heat += h / 6.0 * (ends + 4.0 * laws.viscous_power(middle, rate));
            if laws.have_memory() {
                laws.copy_memory(&before.memory[i], memory);
                heat += laws.commit(memory, r[1], velocity[1]);
            }
        }
        self.state.supplied_j = before.supplied_j + supplied;
        self.state.dissipated_j = before.dissipated_j + heat;
    }

    fn moments_over(&mut self, whole: &Blocks, motion: &[f64]) {
        let [first, second] = &mut self.moments;
        for (moment, state, by) in [
            (first, &whole.once, &whole.once_by),
            (second, &whole.twice, &whole.twice_by),
        ] {
            moment.fill(0.0);
            state.add_product_to(motion, moment);
            for (block, power) in by.iter().zip(&self.powers) {
                block.add_product_to(power, moment);
            }
        }
    }

    /// Whether the step that was taken is too long for its joints: their stiffness is high for it, or within it one that remembers
    /// turns or passes a corner of its load.
    fn asks_for_halves(
        &mut self,
        system: &System,
        rung: &Rung,
        before: &AssemblyState,
        largest_angle: f64,
    ) -> bool {
        let d = system.laws.len();
        let [begin, .., end] = &self.relative;
        let tangents = &mut self.tangents;
        let is_steep = [begin, end].into_iter().any(|at| {
            for (i, tangent) in tangents.iter_mut().enumerate() {
                *tangent = System::tangent(&system.laws[i], &before.memory[i], at[i], at[d + i]);
            }
            rung.length_s * system.tangent_frequency(tangents) > largest_angle
        });
        is_steep || (0..d).any(|i| self.has_event(system, before, i))
    }

    /// Whether a law that remembers turns or passes a corner.
    fn has_event(&self, system: &System, before: &AssemblyState, i: usize) -> bool {
        let laws = &system.laws[i];
        if !laws.have_memory() {
            return false;
        }
        let d = system.laws.len();
        let [begin, .., end] = &self.relative;
        if begin[d + i] * end[d + i] < 0.0 {
            return true;
        }
        let mut passes = false;
        laws.corners(&before.memory[i], end[i], &mut |corner| {
            if let Corner::Sharp(place) = corner {
                passes |= (place - begin[i]) * (end[i] - place) > 0.0;
            }
        });
        passes
    }
}
