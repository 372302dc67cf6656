//! One part of a step: the joints' forces at its nodes, the motion that they lead to, and the work that is done.

mod creep;
mod events;
mod look;
mod trail;

use super::{
    coordinates::Sight,
    ladder::Rung,
    lobatto::{NODES, THETA, WEIGHTS, legendre_coefficients, powers},
    preload::LawsAt,
    propagator::{Blocks, MOMENTS, POWERS},
    stages::{LATER, Stages},
    state::Underway,
    system::System,
};
pub(super) use look::Look;
use trail::Trail;

/// Sweeps over the nodes for the joints' forces, at most; five to eight are usual.
const MOST_SWEEPS: usize = 24;
/// The forces are found where a sweep changes the motion by less than this part of the tolerance, …
const SHARE_OF_SWEEPS: f64 = 3e-3;
/// … within these bounds.
const CHANGES: [f64; 2] = [1e-13, 1e-9];
/// What a sweep leaves of the change of the one before, at most: the step is too long otherwise.
const SLOWEST: f64 = 0.5;
/// Angle h ω_t or h λ_t at the beginning up to which a step is tried at all.
const STEEPEST: f64 = 3.0;

/// A degree two higher goes down faster than the one before it, by these factors at most where the forces are smooth: those of
/// e^{iωt} by a third and a fifth. What is not smooth asks for a margin.
const NEXT: f64 = 0.5;
const AFTER_NEXT: f64 = 0.3;

/// Powers of time that loads have.
const LOAD_POWERS: usize = 4;

/// What a part of a step is taken with.
#[derive(Clone, Copy)]
pub(super) struct Means<'a> {
    pub(super) system: &'a System,
    pub(super) sight: &'a Sight,
    pub(super) rung: &'a Rung,
}

/// Room for what a part of a step computes, one for each halving.
#[derive(Clone, Debug)]
pub(super) struct Scratch {
    pub(super) state: Underway,
    /// Loads, and then the preloads, as powers of time.
    pub(super) loads: [Vec<f64>; POWERS],
    /// The laws at the nodes, where joints follow a preload; else nothing.
    laws: Vec<LawsAt>,
    /// Relative motions (r, ṙ) at the nodes.
    relative: [Vec<f64>; NODES],
    /// Displacements at the loads, at the beginning and at the end.
    at_loads: [Vec<f64>; 2],
    /// The same at the later nodes without the joints' forces.
    free: Vec<f64>,
    /// Forces at the nodes.
    forces: Vec<f64>,
    /// Loads and forces as powers of time, power by power.
    powers: Vec<f64>,
    /// ∫ x dθ of the displacements under loads and of laws, and the integrals over it, place by place.
    moments: Vec<f64>,
    /// What each law that knows time remembers at the nodes, as it goes from one to the next.
    trails: Vec<Trail>,
    /// What may be missing of the forces, polynomial by polynomial of Legendre.
    missing: [Vec<f64>; NODES],
    /// ∂f/∂r and ∂f/∂ṙ of each law.
    tangents: Vec<[f64; 2]>,
    /// (r, ṙ) at a node as a sweep finds it.
    next: Vec<f64>,
    /// Largest (r, ṙ) at the nodes, and what the latest sweep changed of them.
    sizes: Vec<f64>,
    changes: Vec<f64>,
    /// Corners of a law at the beginning.
    corners: Vec<f64>,
}

/// The laws at the nodes: those that follow a preload, or those that never change.
fn at_nodes<'a>(system: &'a System, own: &'a [LawsAt]) -> [&'a LawsAt; NODES] {
    match own {
        [first, second, third, fourth, fifth] => [first, second, third, fourth, fifth],
        _ => [&system.laws; NODES],
    }
}

impl Scratch {
    pub(super) fn of(system: &System) -> Self {
        let (m, d) = (system.loads, system.forces());
        let following = system.following.len();
        Self {
            state: Underway::of_size(system.size, d),
            loads: std::array::from_fn(|_| vec![0.0; m + following]),
            laws: vec![system.laws.clone(); if following > 0 { NODES } else { 0 }],
            relative: std::array::from_fn(|_| vec![0.0; 2 * d]),
            at_loads: std::array::from_fn(|_| vec![0.0; m]),
            free: vec![0.0; LATER * 2 * d],
            forces: vec![0.0; NODES * d],
            powers: vec![0.0; POWERS * (m + d)],
            moments: vec![0.0; MOMENTS * (m + d)],
            trails: vec![Trail::AT_REST; system.timed.len()],
            missing: std::array::from_fn(|_| vec![0.0; d]),
            tangents: vec![[0.0; 2]; d],
            next: vec![0.0; 2 * d],
            sizes: vec![0.0; 2 * d],
            changes: vec![0.0; 2 * d],
            corners: Vec::new(),
        }
    }

    /// Takes the loads and preloads of a step: wₖ for the power (0 to 3) and the load or, after all loads, the preload.
    pub(super) fn take_loads(&mut self, of: impl Fn(usize, usize) -> f64) {
        for (power, loads) in self.loads.iter_mut().enumerate().take(LOAD_POWERS) {
            for (load, own) in loads.iter_mut().enumerate() {
                *own = of(power, load);
            }
        }
    }

    /// Lets the laws follow the preloads.
    pub(super) fn follow(&mut self, system: &System) {
        let [w0, w1, w2, w3, _] = &self.loads;
        for (laws, theta) in self.laws.iter_mut().zip(THETA) {
            laws.follow(system, |which| {
                let place = system.loads + which;
                let after: f64 = w2[place] + theta / 3.0 * w3[place];
                // Σ wₖ θᵏ/k!
                w0[place] + theta * (w1[place] + theta / 2.0 * after)
            });
        }
    }

    /// What friction held at the preload before a step and no longer holds slips at once, before anything moves.
    pub(super) fn let_go(&mut self, system: &System, sight: &Sight, state: &mut Underway) {
        self.follow(system);
        let Some(begin) = self.laws.first() else {
            return;
        };
        let now = &mut self.relative[0];
        sight.relative(&state.motion, now);
        let (r, velocity) = now.split_at(begin.on.len());
        let laws = begin.on.iter().zip(&mut state.memory);
        for (i, (laws, memory)) in laws.enumerate() {
            if laws.have_memory() {
                state.balance_j += laws.commit(memory, r[i], velocity[i]);
            }
        }
    }

    /// Whether a preload goes so far within the step that its joint is hardly the same one.
    pub(super) fn is_preload_far(&self, system: &System) -> bool {
        let laws = at_nodes(system, &self.laws);
        laws.windows(2)
            .any(|pair| pair[0].are_far_from(pair[1], system))
    }

    /// Finds the joints' forces at the nodes of the step from `before`. Says how large the step's error is with them, in units of
    /// what is allowed; `None` where they were not found.
    pub(super) fn find_forces(
        &mut self,
        means: Means<'_>,
        before: &Underway,
        look: &mut Look,
        tolerance: f64,
    ) -> Option<f64> {
        let Means {
            system,
            sight,
            rung,
        } = means;
        let (m, d) = (system.loads, system.forces());
        for (power, loads) in self.loads.iter().enumerate() {
            self.powers[power * (m + d)..][..m].copy_from_slice(&loads[..m]);
        }
        let Some(stages) = &rung.stages else {
            return Some(0.0);
        };
        let seen = look.at(sight, &before.motion);
        self.relative[0].copy_from_slice(&seen[..2 * d]);
        if !self.relative[0].iter().all(|own| own.is_finite()) {
            // what has grown beyond all bounds is no better in parts
            return Some(0.0);
        }
        let angle = self.angle(means, before);
        if angle > STEEPEST {
            return None;
        }
        // what is found counts over the step, or over the joints' own time where that is shorter
        let rate_per_s = angle.max(1.0) / rung.length_s;
        self.free.fill(0.0);
        stages
            .by_state
            .add_product_to(&before.motion, &mut self.free);
        for (block, power) in stages.by_loads.iter().zip(self.powers.chunks(m + d)) {
            if is_there(&power[..m]) {
                block.add_product_to(&power[..m], &mut self.free);
            }
        }
        let [finest, coarsest] = CHANGES;
        let at_rest = (SHARE_OF_SWEEPS * tolerance).clamp(finest, coarsest);
        if !self.sweep(system, stages, before, [rate_per_s, at_rest]) {
            return None;
        }
        self.take_powers(system);
        // a period of their own takes 2π such steps, or more
        Some(self.error(stages, rate_per_s) / (tolerance / std::f64::consts::TAU))
    }

    /// Holds the forces at the beginning over the step, for want of better ones.
    pub(super) fn hold_forces(&mut self, system: &System, before: &Underway) {
        let (m, d) = (system.loads, system.forces());
        let [begin, ..] = at_nodes(system, &self.laws);
        let (held, others) = self.powers.split_at_mut(m + d);
        begin.forces(system, &before.memory, &self.relative[0], &mut held[m..]);
        for power in others.chunks_mut(m + d) {
            power[m..].fill(0.0);
        }
    }

    /// The larger one of h ω_t and h λ_t at the beginning.
    fn angle(&mut self, means: Means<'_>, before: &Underway) -> f64 {
        let [begin, ..] = at_nodes(means.system, &self.laws);
        let (at, tangents) = (&self.relative[0], &mut self.tangents);
        let pace = begin.pace(means.system, &before.memory, at, tangents);
        means.rung.length_s * pace.frequency_rad_per_s.max(pace.rate_per_s)
    }

    /// Forces by motions and motions by forces, node by node, until neither changes. Says whether that ends.
    fn sweep(
        &mut self,
        system: &System,
        stages: &Stages,
        before: &Underway,
        [rate_per_s, at_rest]: [f64; 2],
    ) -> bool {
        let d = system.forces();
        let [begin, later @ ..] = at_nodes(system, &self.laws);
        let (first, others) = self.forces.split_at_mut(d);
        begin.forces(system, &before.memory, &self.relative[0], first);
        for own in others.chunks_exact_mut(d) {
            own.copy_from_slice(first);
        }
        for (trail, &i) in self.trails.iter_mut().zip(&system.timed) {
            begin.on[i].copy_memory(&before.memory[i], &mut trail.memory[0]);
        }
        let mut latest = f64::INFINITY;
        for sweep in 0..MOST_SWEEPS {
            self.changes.fill(0.0);
            for (size, own) in self.sizes.iter_mut().zip(&self.relative[0]) {
                *size = own.abs();
            }
            for (node, laws) in later.iter().enumerate() {
                let relative = &mut self.relative[node + 1];
                let free = &self.free[node * 2 * d..(node + 1) * 2 * d];
                self.next.copy_from_slice(free);
                stages.by_forces[node].add_product_to(&self.forces, &mut self.next);
                for (row, own) in relative.iter_mut().enumerate() {
                    let next = self.next[row];
                    self.changes[row] = self.changes[row].max((next - *own).abs());
                    self.sizes[row] = self.sizes[row].max(next.abs());
                    *own = next;
                }
                let forces = &mut self.forces[(node + 1) * d..(node + 2) * d];
                laws.forces(system, &before.memory, relative, forces);
                for (trail, &i) in self.trails.iter_mut().zip(&system.timed) {
                    let at = [relative[i], relative[d + i]];
                    forces[i] += trail.go_on(&laws.on[i], node + 1, at);
                }
            }
            // before the first sweep the motions were those of another step
            if sweep > 0 {
                let change = self.largest_of(&self.changes, rate_per_s);
                if change <= at_rest {
                    return true;
                }
                // nor does what is not a number
                let goes_down = change <= SLOWEST * latest;
                if sweep > 1 && !goes_down {
                    return false;
                }
                latest = change;
            }
        }
        false
    }

    /// The largest one of these (r, ṙ) as a part of the motion at the nodes, where velocities count by a rate.
    fn largest_of(&self, of: &[f64], rate_per_s: f64) -> f64 {
        let d = of.len() / 2;
        let both = |own: &[f64], i: usize| own[i] + own[d + i] / rate_per_s;
        (0..d).fold(0.0, |largest: f64, i| match both(of, i) {
            0.0 => largest,
            // what is not a number stays so
            own => match own / both(&self.sizes, i) {
                part if part <= largest || largest.is_nan() => largest,
                part => part,
            },
        })
    }

    /// The forces as powers of time, and what may be missing of them.
    ///
    /// Their coefficients go down by about the same factor with every two degrees, whatever the phase is: so those of the next
    /// degrees are guessed. At the nodes, a polynomial of degree 5, 6, 7, 8 looks like one of degree 3, 2, 1, 0.
    fn take_powers(&mut self, system: &System) {
        let (m, d) = (system.loads, system.forces());
        for i in 0..d {
            let a = legendre_coefficients(std::array::from_fn(|node| self.forces[node * d + i]));
            for (own, power) in self.powers.chunks_mut(m + d).zip(powers(a)) {
                own[m + i] = power;
            }
            let [_, a1, a2, a3, a4] = a.map(f64::abs);
            let factor = match a3 + a4 {
                0.0 => 0.0,
                high => (high / (a1 + a2)).min(1.0),
            };
            let [fifth, sixth] = [NEXT * factor * a3, NEXT * factor * a4];
            let [seventh, eighth] = [AFTER_NEXT * factor * fifth, AFTER_NEXT * factor * sixth];
            let missing = [eighth, seventh, sixth, fifth, fifth];
            for (own, missing) in self.missing.iter_mut().zip(missing) {
                own[i] = missing;
            }
        }
        let [.., at_end] = at_nodes(system, &self.laws);
        for (trail, &i) in self.trails.iter().zip(&system.timed) {
            let [.., middle, _, end] = self.relative.each_ref().map(|own| [own[i], own[d + i]]);
            // as if it lasted for the whole step
            self.missing[0][i] += trail.error(&at_end.on[i], middle, end);
        }
    }

    /// What the forces lack, in the relative motion at the end, as a part of the motion.
    fn error(&mut self, stages: &Stages, rate_per_s: f64) -> f64 {
        let mut off = std::mem::take(&mut self.changes);
        off.fill(0.0);
        for (block, missing) in stages.of_legendre.iter().zip(&self.missing) {
            block.add_product_to(missing, &mut off);
        }
        let error = self.largest_of(&off, rate_per_s);
        self.changes = off;
        error
    }

    /// The motion at the end, with the forces that were found.
    pub(super) fn go_on(&mut self, means: Means<'_>, before: &Underway, look: &mut Look) {
        let Means { sight, rung, .. } = means;
        let (whole, laws) = (&rung.whole, 2 * means.system.forces());
        let [begin_at_loads, end_at_loads] = &mut self.at_loads;
        begin_at_loads.copy_from_slice(&look.at(sight, &before.motion)[laws..]);
        let end = &mut self.state.motion;
        whole.state.go_on(&before.motion, end);
        whole.by.add_rows_to(&self.powers, end);
        // to the last digit where the next step begins, so that what slides is on its corner
        let seen = look.at(sight, end);
        self.relative[LATER].copy_from_slice(&seen[..laws]);
        end_at_loads.copy_from_slice(&seen[laws..]);
        self.count(means, before);
    }

    /// What the step supplies and turns into heat, but for what the linear part stores, and what the joints remember after it.
    fn count(&mut self, means: Means<'_>, before: &Underway) {
        let Means { system, rung, .. } = means;
        let h = rung.length_s;
        let (m, d) = (system.loads, system.forces());
        if is_there(&self.powers[m + d..]) {
            self.moments.fill(0.0);
            let Blocks {
                moments,
                moments_by,
                ..
            } = &rung.whole;
            moments.add_product_to(&before.motion, &mut self.moments);
            moments_by.add_product_to(&self.powers, &mut self.moments);
        }
        let [begin, .., end] = &self.relative;
        let ends = |p: usize| match p.checked_sub(m) {
            Some(law) => [begin[law], end[law]],
            None => self.at_loads.each_ref().map(|own| own[p]),
        };
        // ∫ wᵀ dx = [wᵀ x] − ∫ (dw/dθ)ᵀ x dθ, with ∫ θ x dθ = z₁ − z₂, ∫ θ² x dθ = z₁ − 2z₂ + 2z₃, …
        let work = |p: usize| {
            let [w0, w1, w2, w3, w4] = std::array::from_fn(|k| self.powers[k * (m + d) + p]);
            let [from, to] = ends(p);
            if [w1, w2, w3, w4] == [0.0; POWERS - 1] {
                return w0 * (to - from);
            }
            let [z1, z2, z3, z4] = std::array::from_fn(|k| self.moments[MOMENTS * p + k]);
            let end = w0 + w1 + 0.5 * w2 + w3 / 6.0 + w4 / 24.0;
            let linear = z1 - z2;
            let quadratic = z1 - 2.0 * (z2 - z3);
            let cubic = z1 - 3.0 * z2 + 6.0 * (z3 - z4);
            end * to - w0 * from - (w1 * z1 + w2 * linear + 0.5 * w3 * quadratic + w4 / 6.0 * cubic)
        };
        let supplied: f64 = (0..m).map(work).sum();
        let into_laws: f64 = (m..m + d).map(work).sum();
        // the linear part's share is that of the whole step
        let mut heat = supplied - into_laws;
        let laws = at_nodes(system, &self.laws);
        for ((laws, motion), weight) in laws.into_iter().zip(&self.relative).zip(WEIGHTS) {
            let (r, velocity) = motion.split_at(d);
            heat += weight * h * laws.viscous_power(system, r, velocity);
        }
        let [.., at_end] = laws;
        for (i, memory) in self.state.memory.iter_mut().enumerate() {
            let laws = &at_end.on[i];
            if let Some(which) = system.timed.iter().position(|&timed| timed == i) {
                let trail = &self.trails[which];
                laws.copy_memory(&trail.memory[LATER], memory);
                heat += trail.heat_j[1..].iter().sum::<f64>();
            } else if laws.have_memory() {
                laws.copy_memory(&before.memory[i], memory);
                heat += laws.commit(memory, end[i], end[d + i]);
            }
        }
        self.state.supplied_j = before.supplied_j + supplied;
        self.state.balance_j = before.balance_j + heat;
    }
}

fn is_there(x: &[f64]) -> bool {
    x.iter().any(|&own| own != 0.0)
}
