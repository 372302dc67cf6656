//! Steps of an assembly in time: the linear part exactly, the joints' laws by Krogstad's exponential Runge–Kutta scheme.
//!
//! S. Krogstad, J. Comput. Phys. 203 (2005) 72, condensed on the relative motions of the joints: a step takes one product with the
//! whole state, its four stages take products of the joints' own size. Its order is four. What it leaves of the joints' forces is
//! the parabola of time through f₁, (f₂ + f₃)/2 and f₄.
//!
//! A step is short enough where its angles say so. They take every coordinate for a free mass, so that many a step is better than
//! they know: where they say no, two halves are compared with the whole.

use super::{
    ladder::{HALVINGS_AT_EVENTS, Ladder, Rung, Sight},
    matrix::{Matrix, dot},
    preload::LawsAt,
    propagator::{Blocks, MOMENTS, POWERS},
    system::{Assembly, System},
};
use crate::law::{Corner, DOF_AT_REST, DofMemory};

/// Angle h ω_t up to which a step is taken as it is. With ω_t, the highest frequency that the laws' tangents give the joints, the
/// scheme's error is then a millionth over a period of that frequency; and h λ_t, with the rate λ_t that those by the velocity
/// give them, …
const ANGLE_AT_A_MILLIONTH: f64 = 0.13;
/// … which is of fourth order.
const MILLIONTH: f64 = 1e-6;

/// Between the ends and the middle of a step the forces are taken as a parabola of time. A motion of the frequency ω, which may be
/// far above ω_t, makes that err by this times ((h ω_t)² (ωh)² + h λ_t (ωh)³) of itself over 1/ω: Simpson's rule leaves h⁴ f⁗/2880
/// of a force, which gives 3e-4. The rest is margin for what the stages leave beside it: with 1e-3 motions of cubic joints were
/// up to forty tolerances from SciPy's, with this up to three.
const OF_PARABOLA: f64 = 1.6e-2;
/// Two steps of half the length have a fifteenth of the error by which they differ from the whole one: 2⁴ − 1.
const BY_HALVES: f64 = 15.0;
/// Angle from which on the two are not compared: they may both be wrong.
const LARGEST_ANGLE: f64 = 1.0;
/// (ωh)⁴ is this times the distance between the middle and the cubic through the ends with their slopes (Hermite).
const HERMITE: f64 = 384.0;

/// Error of the joints' nonlinear part over a period of their own, as a part of the motion, in FMUs and histories.
pub const TOLERANCE: f64 = 1e-7;

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
    tolerance: f64,
    scratch: Vec<Scratch>,
    /// Room for a motion in other coordinates.
    room: Vec<f64>,
    is_too_long: bool,
}

/// What a part of a step is taken with.
#[derive(Clone, Copy)]
struct Means<'a> {
    system: &'a System,
    sight: &'a Sight,
    rung: &'a Rung,
}

/// Room for what a step computes, one for each halving.
#[derive(Clone, Debug)]
struct Scratch {
    state: AssemblyState,
    /// Where the first half of the step leads.
    half: AssemblyState,
    /// Loads, and then the preloads, as powers of time.
    loads: [Vec<f64>; POWERS],
    /// The laws at the beginning, in the middle and at the end, where joints follow a preload; else nothing.
    laws: Vec<LawsAt>,
    /// Relative motions (r, ṙ) at the beginning, at the stages, and at the end.
    relative: [Vec<f64>; 5],
    /// Forces of the four stages.
    forces: [Vec<f64>; 4],
    /// Loads and forces as powers of time.
    powers: [Vec<f64>; POWERS],
    /// ∫ Rq dθ and the integrals over it.
    moments: [Vec<f64>; MOMENTS],
    /// ∂f/∂r and ∂f/∂ṙ of each law.
    tangents: Vec<[f64; 2]>,
    /// Corners of a law at the beginning.
    corners: Vec<f64>,
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
            tolerance,
            room: vec![0.0; 2 * system.size],
            system,
            ladder,
            scratch,
            is_too_long: false,
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

    /// An assembly that has not moved yet.
    #[must_use]
    pub fn at_rest(&self) -> AssemblyState {
        AssemblyState::of_size(self.system.size, self.system.forces())
    }

    /// Length of the steps, s.
    #[must_use]
    pub fn length_s(&self) -> f64 {
        self.ladder.rungs.first().map_or(0.0, |rung| rung.length_s)
    }

    /// Moves the state on by one step, in which the loads go from `loads` evenly to `loads` + `change` (m numbers each, and then the
    /// preload of each joint over the preload, N·m). Where the joints ask for it the step is taken in halves, each in halves again, up to 4096 parts; where that
    /// was not enough, [`Self::was_too_long`] says so. Says how many parts it took.
    pub fn step(&mut self, state: &mut AssemblyState, loads: &[f64], change: &[f64]) -> usize {
        self.step_along(state, |power, load| match power {
            0 => loads[load],
            1 => change[load],
            _ => 0.0,
        })
    }

    /// The same with loads and preloads that are Σ wₖ θᵏ/k! over the step, θ from 0 to 1: `of` gives wₖ for the power (0 to 3) and
    /// the load or, after all loads, the preload.
    pub fn step_along(
        &mut self,
        state: &mut AssemblyState,
        of: impl Fn(usize, usize) -> f64,
    ) -> usize {
        if let Some(scratch) = self.scratch.first_mut() {
            for (power, loads) in scratch.loads.iter_mut().enumerate() {
                for (load, own) in loads.iter_mut().enumerate() {
                    *own = of(power, load);
                }
            }
        }
        if let Some(scratch) = self.scratch.first_mut() {
            scratch.let_go(&self.system, state);
        }
        self.is_too_long = false;
        let stored = self.system.linear_energy(&state.motion);
        if let Some(frame) = &self.ladder.frame {
            replace(frame.to_modes(), &mut state.motion, &mut self.room);
        }
        let parts = self.part(state, 0, HALVINGS_AT_EVENTS);
        if let Some(frame) = &self.ladder.frame {
            replace(frame.out_of_modes(), &mut state.motion, &mut self.room);
        }
        // what of the work is neither stored nor given to the laws is heat of the linear dampers
        state.dissipated_j -= self.system.linear_energy(&state.motion) - stored;
        parts
    }

    /// Whether in the latest step some of its shortest parts were still too long for the stiffness of the joints, so that the
    /// tolerance does not hold.
    #[must_use]
    pub fn was_too_long(&self) -> bool {
        self.is_too_long
    }

    /// One step of the given level, with the loads in its scratch, that may still be halved so often at events.
    fn part(&mut self, state: &mut AssemblyState, level: usize, at_events: usize) -> usize {
        let (Some(rung), Some((own, finer))) = (
            self.ladder.rungs.get(level),
            self.scratch
                .get_mut(level..)
                .and_then(<[_]>::split_first_mut),
        ) else {
            return 0;
        };
        let with = |rung| Means {
            system: &self.system,
            sight: &self.ladder.sight,
            rung,
        };
        let means = with(rung);
        own.follow(&self.system);
        own.take(means, state);
        let is_finest = finer.is_empty();
        let angles = own.angles(means, state);
        let is_far = own.is_preload_far(&self.system);
        let mut is_steep = is_far || own.is_steep(angles, self.tolerance);
        let mut parts = 1;
        if let Some(next) = finer.first_mut().filter(|_| is_steep && !is_far)
            && let Some(finer_rung) = self.ladder.rungs.get(level + 1)
            && angles.largest() < LARGEST_ANGLE
            && own.is_as_by_halves(with(finer_rung), next, state, angles, self.tolerance)
        {
            is_steep = false;
            parts = 2;
        }
        self.is_too_long |= is_finest && is_steep && self.system.forces() > 0;
        let at_events = match is_finest {
            true => None,
            false if is_steep => Some(at_events),
            false if own.has_event(means, state) => at_events.checked_sub(1),
            false => None,
        };
        let Some(at_events) = at_events else {
            if parts == 1 {
                own.count(means, state);
            }
            std::mem::swap(state, &mut own.state);
            return parts;
        };
        if let Some(next) = finer.first_mut() {
            halve(&own.loads, &mut next.loads);
        }
        let first = self.part(state, level + 1, at_events);
        if let Some(next) = self.scratch.get_mut(level + 1) {
            go_on(&mut next.loads);
        }
        first + self.part(state, level + 1, at_events)
    }

    /// Energy stored in structures and joints, J; of joints over the preload at that at which the linear part is.
    #[must_use]
    pub fn stored_energy_j(&self, state: &AssemblyState) -> f64 {
        self.system.stored_energy(state)
    }
}

/// x ← A x
fn replace(matrix: &Matrix, x: &mut Vec<f64>, room: &mut Vec<f64>) {
    room.fill(0.0);
    matrix.add_product_to(x, room);
    std::mem::swap(x, room);
}

/// Adds A x to `sum`, unless x is zero: loads are held as a rule, and no force is cubic.
fn add_product(matrix: &Matrix, x: &[f64], sum: &mut [f64]) {
    if is_there(x) {
        matrix.add_product_to(x, sum);
    }
}

fn is_there(x: &[f64]) -> bool {
    x.iter().any(|&own| own != 0.0)
}

/// h ω_t ≤ 0.13 (ε/10⁻⁶)^¼
fn largest_angle(tolerance: f64) -> f64 {
    ANGLE_AT_A_MILLIONTH * (tolerance / MILLIONTH).sqrt().sqrt()
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
fn go_on([constant, linear, quadratic, cubic]: &mut [Vec<f64>; POWERS]) {
    for (i, &w3) in cubic.iter().enumerate() {
        constant[i] += linear[i] + 0.5 * quadratic[i] + w3 / 6.0;
        linear[i] += quadratic[i] + 0.5 * w3;
        quadratic[i] += w3;
    }
}

/// The step as an angle of what the joints' laws would oscillate or decay by.
#[derive(Clone, Copy, Debug)]
struct Angles {
    /// h ω_t.
    of_stiffness: f64,
    /// h λ_t.
    of_damping: f64,
}

impl Angles {
    fn largest(self) -> f64 {
        self.of_stiffness.max(self.of_damping)
    }
}

impl AssemblyState {
    /// That of an assembly that has not moved yet.
    #[must_use]
    pub fn at_rest(assembly: &Assembly) -> Self {
        Self::of_size(assembly.size(), assembly.laws().count())
    }

    fn of_size(size: usize, laws: usize) -> Self {
        Self {
            motion: vec![0.0; 2 * size],
            memory: vec![DOF_AT_REST; laws],
            supplied_j: 0.0,
            dissipated_j: 0.0,
        }
    }
}

impl System {
    fn stored_energy(&self, state: &AssemblyState) -> f64 {
        let laws = self.laws.on.iter().zip(&state.memory).enumerate();
        let of_laws: f64 = laws
            .map(|(i, (laws, memory))| {
                let r = dot(self.rows.row(i), &state.motion[..self.size]);
                laws.stored_energy(memory, r)
            })
            .sum();
        self.linear_energy(&state.motion) + of_laws
    }
}

/// The laws at the beginning, in the middle and at the end: those that follow a preload, or those that never change.
fn three<'a>(system: &'a System, own: &'a [LawsAt]) -> [&'a LawsAt; 3] {
    match own {
        [begin, middle, end] => [begin, middle, end],
        _ => [&system.laws; 3],
    }
}

impl Scratch {
    fn of(system: &System) -> Self {
        let (m, d) = (system.loads, system.forces());
        let following = system.following.len();
        Self {
            state: AssemblyState::of_size(system.size, d),
            half: AssemblyState::of_size(system.size, d),
            loads: std::array::from_fn(|_| vec![0.0; m + following]),
            laws: vec![system.laws.clone(); if following > 0 { 3 } else { 0 }],
            relative: std::array::from_fn(|_| vec![0.0; 2 * d]),
            forces: std::array::from_fn(|_| vec![0.0; d]),
            powers: std::array::from_fn(|_| vec![0.0; m + d]),
            moments: std::array::from_fn(|_| vec![0.0; m + d]),
            tangents: vec![[0.0; 2]; d],
            corners: Vec::new(),
        }
    }

    /// Lets the laws follow the preloads.
    fn follow(&mut self, system: &System) {
        let [w0, w1, w2, w3] = &self.loads;
        for (laws, theta) in self.laws.iter_mut().zip([0.0, 0.5, 1.0]) {
            laws.follow(system, |which| {
                let place = system.loads + which;
                let after: f64 = w2[place] + theta / 3.0 * w3[place];
                // Σ wₖ θᵏ/k!
                w0[place] + theta * (w1[place] + theta / 2.0 * after)
            });
        }
    }

    /// What friction held at the preload before a step and no longer holds slips at once, before anything moves.
    fn let_go(&mut self, system: &System, state: &mut AssemblyState) {
        self.follow(system);
        let Some(begin) = self.laws.first() else {
            return;
        };
        let now = &mut self.relative[0];
        system.relative(&state.motion, now);
        let (r, velocity) = now.split_at(begin.on.len());
        let laws = begin.on.iter().zip(&mut state.memory);
        for (i, (laws, memory)) in laws.enumerate() {
            if laws.have_memory() {
                state.dissipated_j += laws.commit(memory, r[i], velocity[i]);
            }
        }
    }

    /// The motion of the step from `before` to this scratch's state.
    fn take(&mut self, means: Means<'_>, before: &AssemblyState) {
        let Means {
            system,
            sight,
            rung,
        } = means;
        let (m, d) = (system.loads, system.forces());
        let whole = &rung.whole;
        for (power, loads) in self.powers.iter_mut().zip(&self.loads) {
            power.fill(0.0);
            power[..m].copy_from_slice(&loads[..m]);
        }
        // y¹ = E y + loads
        let end = &mut self.state.motion;
        whole.state.go_on(&before.motion, end);
        for (block, power) in whole.by.iter().zip(&self.powers) {
            block.add_rows_to(0, &power[..m], end);
        }
        if let Some(middle) = &rung.middle {
            let [r0, r2, r3, r4, _] = &mut self.relative;
            let [f1, f2, f3, f4] = &mut self.forces;
            let [at_begin, at_middle, at_end] = three(system, &self.laws);
            sight.relative(&before.motion, r0);
            at_begin.forces(system, &before.memory, r0, f1);
            // y^½ = E_½ y + loads
            r2.fill(0.0);
            middle.by_state.add_product_to(&before.motion, r2);
            let mut share = 1.0;
            for (block, loads) in middle.by_loads.iter().zip(&self.loads) {
                // in half the time a power of it comes half as far, a quarter …
                for (i, r2) in r2.iter_mut().enumerate() {
                    *r2 += share * dot(block.row(i), &loads[..m]);
                }
                share *= 0.5;
            }
            r3.copy_from_slice(r2);
            sight.relative(end, r4);
            // f₂ = f(y^½ + i₁ f₁)
            middle.of_half[0].add_product_to(f1, r2);
            at_middle.forces(system, &before.memory, r2, f2);
            // f₃ = f(y^½ + (i₁ − 2i₂) f₁ + 2i₂ f₂)
            middle.of_half[1].add_product_to(f1, r3);
            middle.of_half[2].add_product_to(f2, r3);
            at_middle.forces(system, &before.memory, r3, f3);
            // f₄ = f(y¹ + (j₁ − 2j₂) f₁ + 2j₂ f₃)
            middle.of_whole[0].add_product_to(f1, r4);
            middle.of_whole[1].add_product_to(f3, r4);
            at_end.forces(system, &before.memory, r4, f4);
            // f(θ) = f₁ + (−3f₁ + 4f_m − f₄) θ + (2f₁ − 4f_m + 2f₄) θ², f_m = (f₂ + f₃)/2
            for i in 0..d {
                let middle = 0.5 * (f2[i] + f3[i]);
                self.powers[0][m + i] = f1[i];
                self.powers[1][m + i] = -3.0 * f1[i] + 4.0 * middle - f4[i];
                self.powers[2][m + i] = 2.0 * (2.0 * f1[i] - 4.0 * middle + 2.0 * f4[i]);
            }
            for (block, power) in whole.by.iter().zip(&self.powers) {
                block.add_rows_to(m, &power[m..], end);
            }
            sight.relative(end, &mut self.relative[4]);
        }
        let (h, [begin, middle, _, _, end]) = (rung.length_s, &mut self.relative);
        // the stages' own middle is no longer needed: between the ends it is that of the cubic with their slopes
        for i in 0..d {
            let [r, velocity] = [[begin[i], end[i]], [begin[d + i], end[d + i]]];
            middle[i] = 0.5 * (r[0] + r[1]) + 0.125 * h * (velocity[0] - velocity[1]);
            middle[d + i] = 1.5 * (r[1] - r[0]) / h - 0.25 * (velocity[0] + velocity[1]);
        }
    }

    /// What the step supplies and turns into heat, but for what the linear part stores, and what the joints remember after it.
    fn count(&mut self, means: Means<'_>, before: &AssemblyState) {
        let Means {
            system,
            sight,
            rung,
        } = means;
        let h = rung.length_s;
        let (m, d) = (system.loads, system.forces());
        self.moments_over(&rung.whole, &before.motion);
        let [first, second, third] = &self.moments;
        let place = |state: &[f64], p: usize| dot(sight.places.row(p), state);
        // ∫ wᵀ dx = [wᵀ x] − ∫ (dw/dθ)ᵀ x dθ, with ∫ θ x dθ = z₁ − z₂ and ∫ θ² x dθ = z₁ − 2z₂ + 2z₃
        let work = |p: usize| {
            let [w0, w1, w2, w3] = self.powers.each_ref().map(|power| power[p]);
            let (from, to) = (place(&before.motion, p), place(&self.state.motion, p));
            let end = w0 + w1 + 0.5 * w2 + w3 / 6.0;
            let [linear, quadratic] = [
                first[p] - second[p],
                first[p] - 2.0 * second[p] + 2.0 * third[p],
            ];
            end * to - w0 * from - (w1 * first[p] + w2 * linear + 0.5 * w3 * quadratic)
        };
        let supplied: f64 = (0..m).map(work).sum();
        let into_laws: f64 = (m..m + d).map(work).sum();
        // the linear part's share is that of the whole step
        let mut heat = supplied - into_laws;
        let laws = three(system, &self.laws);
        let [begin, middle, _, _, end] = &self.relative;
        // Simpson's rule
        let motions = [begin, middle, end];
        for ((laws, motion), weight) in laws.into_iter().zip(motions).zip([1.0, 4.0, 1.0]) {
            let (r, velocity) = motion.split_at(d);
            heat += weight * h / 6.0 * laws.viscous_power(system, r, velocity);
        }
        let [.., at_end] = laws;
        for (i, memory) in self.state.memory.iter_mut().enumerate() {
            let laws = &at_end.on[i];
            if laws.have_memory() {
                laws.copy_memory(&before.memory[i], memory);
                heat += laws.commit(memory, end[i], end[d + i]);
            }
        }
        self.state.supplied_j = before.supplied_j + supplied;
        self.state.dissipated_j = before.dissipated_j + heat;
    }

    fn moments_over(&mut self, whole: &Blocks, motion: &[f64]) {
        let blocks = whole.moments.iter().zip(&whole.moments_by);
        for (moment, (state, by)) in self.moments.iter_mut().zip(blocks) {
            moment.fill(0.0);
            state.add_product_to(motion, moment);
            for (block, power) in by.iter().zip(&self.powers) {
                add_product(block, power, moment);
            }
        }
    }

    /// Whether a preload goes so far within the step that its joint is hardly the same one.
    fn is_preload_far(&self, system: &System) -> bool {
        let [at_begin, at_middle, at_end] = three(system, &self.laws);
        at_begin.are_far_from(at_middle, system) || at_middle.are_far_from(at_end, system)
    }

    /// h ω_t and h λ_t of the step that was taken, the larger ones of its ends.
    fn angles(&mut self, means: Means<'_>, before: &AssemblyState) -> Angles {
        let Means { system, rung, .. } = means;
        let [begin, .., end] = &self.relative;
        let [at_begin, _, at_end] = three(system, &self.laws);
        let (h, tangents) = (rung.length_s, &mut self.tangents);
        let mut angles = Angles {
            of_stiffness: 0.0,
            of_damping: 0.0,
        };
        for (laws, at) in [(at_begin, begin), (at_end, end)] {
            let pace = laws.pace(system, &before.memory, at, tangents);
            angles.of_stiffness = angles.of_stiffness.max(h * pace.frequency_rad_per_s);
            angles.of_damping = angles.of_damping.max(h * pace.rate_per_s);
        }
        angles
    }

    /// Whether the step that was taken may be too long for the stiffness of its joints.
    fn is_steep(&self, angles: Angles, tolerance: f64) -> bool {
        if angles.largest() > largest_angle(tolerance) {
            return true;
        }
        if angles.largest() == 0.0 {
            return false;
        }
        let [begin, hermite, middle, _, end] = &self.relative;
        (0..begin.len() / 2).any(|i| {
            let size = [begin[i], middle[i], end[i]].map(f64::abs);
            let size = size[0].max(size[1]).max(size[2]);
            if size == 0.0 {
                return false;
            }
            // (ωh)²
            let square = (HERMITE * (middle[i] - hermite[i]).abs() / size).sqrt();
            let error =
                angles.of_stiffness.powi(2) * square + angles.of_damping * square * square.sqrt();
            OF_PARABOLA * error > tolerance
        })
    }

    /// Whether two halves lead where the step that was taken leads. What they differ by is 15 times the error of the halves, since
    /// that of a step is of fifth order; where it is small enough, this scratch's state becomes that of the halves.
    fn is_as_by_halves(
        &mut self,
        means: Means<'_>,
        next: &mut Self,
        before: &AssemblyState,
        angles: Angles,
        tolerance: f64,
    ) -> bool {
        let Means { system, rung, .. } = means;
        halve(&self.loads, &mut next.loads);
        next.follow(system);
        next.take(means, before);
        next.count(means, before);
        std::mem::swap(&mut self.half, &mut next.state);
        go_on(&mut next.loads);
        next.follow(system);
        next.take(means, &self.half);
        // a period of their own takes 2π such steps, or more
        let share = tolerance / std::f64::consts::TAU;
        let omega = angles.largest() / (2.0 * rung.length_s);
        let d = system.forces();
        let [begin, .., end] = &self.relative;
        let [.., halves] = &next.relative;
        let is_near = (0..d).all(|i| {
            let [r, velocity] = [i, d + i].map(|i| begin[i].abs().max(end[i].abs()));
            let off = |i: usize| (end[i] - halves[i]).abs() / BY_HALVES;
            let amplitude = r + velocity / omega;
            off(i) + off(d + i) / omega <= share * amplitude
        });
        if is_near {
            self.relative[4].copy_from_slice(halves);
            next.count(means, &self.half);
            std::mem::swap(&mut self.state, &mut next.state);
        }
        is_near
    }

    /// Whether within the step that was taken a law that remembers turns or passes a corner of its load.
    fn has_event(&mut self, means: Means<'_>, before: &AssemblyState) -> bool {
        let Means { system, rung, .. } = means;
        (0..system.forces()).any(|i| self.has_event_on(system, rung.length_s, before, i))
    }

    fn has_event_on(
        &mut self,
        system: &System,
        length_s: f64,
        before: &AssemblyState,
        i: usize,
    ) -> bool {
        let [at_begin, _, at_end] = three(system, &self.laws);
        if !at_end.on[i].have_memory() {
            return false;
        }
        let d = system.forces();
        let [begin, .., end] = &self.relative;
        if begin[d + i] * end[d + i] < 0.0 {
            return true;
        }
        self.corners.clear();
        if !self.laws.is_empty() {
            at_begin.on[i].corners(&before.memory[i], end[i], &mut |corner| {
                if let Corner::Sharp(place) = corner {
                    self.corners.push(place);
                }
            });
        }
        let mut passes = false;
        let mut first = self.corners.iter();
        at_end.on[i].corners(&before.memory[i], end[i], &mut |corner| {
            if let Corner::Sharp(place) = corner {
                passes |= (place - begin[i]) * (end[i] - place) > 0.0;
                // with the preload a corner moves: what slides is on it, and sticks where the motion falls behind
                if let Some(&was) = first.next() {
                    let rate = (place - was) / length_s;
                    passes |= (was - begin[i]) * (end[i] - place) > 0.0;
                    passes |= (begin[d + i] - rate) * (end[d + i] - rate) < 0.0;
                }
            }
        });
        passes
    }
}
