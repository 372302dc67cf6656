//! The sum that the estimator minimises, with its normal equations, over all lines of all assemblies.
//!
//! S = Σ |y − H^C(θ, û + δ)|²/σ_C² + Σ |δ|²/σ_H²: measured receptances y of the assembly with variance σ_C², measured
//! receptances û of the substructures with variance σ_H² and their corrections δ. The corrections are unknowns of their
//! own on every line. Eliminated, they leave the normal equations with Σ = Σ_C + J Σ_H Jᴴ, J = ∂H^C/∂û; so
//! S = r̃ᴴ Σ⁻¹ r̃ at the minimum over δ, with r̃ = y − H^C + Jδ.

use nalgebra::DVector;
use num_complex::Complex64;

use super::group::Group;
use super::independent;
use super::kernel::{Kernel, complex_stiffness};
use super::noise::{Levels, NoiseLevel};
use super::normal::Normal;
use super::parallel;
use super::weights::of_one;

/// Entries of K* on and above the diagonal that can be unknown.
pub(super) const MAX_ENTRIES: usize = 3;
/// Stiffness, beside the substructures' own dynamic stiffness at the joint, of a joint that is rigid for all that can be measured.
const RIGID: f64 = 1e6;
/// Gauss–Newton steps of one line's corrections for each step of the unknowns …
const CORRECTION_ROUNDS: usize = 40;
/// … as long as they promise to lower its cost by this fraction …
const CORRECTION_GAIN: f64 = 1e-3;
/// … each shortened to a quarter at most so many times …
const CORRECTION_QUARTERINGS: usize = 8;
/// … until it lowers the cost by this part of what the linear model promises of it. At a sharp resonance a step can end beyond
/// the pole, where the receptance is next to nothing and from where no small step leads back.
const CORRECTION_KEPT_PROMISE: f64 = 0.1;
/// Lines with corrections that one processor takes at a time. Sums are formed piece by piece, so that they do not depend on
/// how many processors there are.
const PIECE: usize = 64;
const ZERO: Complex64 = Complex64::new(0.0, 0.0);

/// Variances of one group.
#[derive(Clone, Debug)]
pub(super) struct Weights {
    /// σ_C² of the mean of each entry of all blocks, line by line.
    pub(super) entries: Vec<f64>,
    /// σ_H² of each source, line by line.
    pub(super) sources: Vec<f64>,
    /// Σ|y − mean|²/σ² over repeated measurements: part of the cost that no joint changes.
    pub(super) scatter: f64,
}

/// A point: the unknowns, what the substructures' receptances are corrected by, and the normal equations there.
#[derive(Clone, Debug)]
pub(super) struct State {
    pub(super) unknowns: DVector<f64>,
    /// For each group, δ of each source, line by line.
    pub(super) corrections: Vec<Vec<Complex64>>,
    pub(super) normal: Normal,
}

/// How lines whose entries have errors of their own are divided by σ.
#[derive(Clone, Copy)]
enum Whitening<'w> {
    None,
    Held(&'w Weights),
    /// By what the level makes of the computed receptance.
    Renewed(NoiseLevel),
}

/// The model with data and weights.
#[derive(Clone, Copy)]
pub(super) struct Objective<'a, const N: usize> {
    pub(super) groups: &'a [Group<N>],
    /// Unknown entries of K*.
    pub(super) entries: &'a [(usize, usize)],
}

impl<const N: usize> Objective<'_, N> {
    /// Whether no unknown is so large that the joint would be rigid whatever its value: there a search must not run away to.
    pub(super) fn is_within_reach(&self, unknowns: &DVector<f64>) -> bool {
        let Some(block) = self.groups.first().and_then(|group| group.blocks.first()) else {
            return false;
        };
        let (own, omega) = (&block.dynamic_stiffness, block.omega[block.lines() / 2]);
        let count = self.entries.len();
        self.entries.iter().enumerate().all(|(index, &(i, j))| {
            let limit = RIGID * (own[i] * own[j]).sqrt();
            unknowns[index].abs() <= limit && omega * unknowns[count + index].abs() <= limit
        })
    }

    /// The point `unknowns` with these corrections (none at all: zero).
    pub(super) fn at(
        &self,
        weights: &[Weights],
        unknowns: DVector<f64>,
        corrections: Option<Vec<Vec<Complex64>>>,
    ) -> Option<State> {
        let corrections = corrections.unwrap_or_else(|| self.no_corrections());
        self.walk(weights, unknowns, corrections, None)
    }

    /// The point `unknowns`, before there are weights: without normal equations.
    pub(super) fn unweighted(
        &self,
        unknowns: DVector<f64>,
        corrections: Option<Vec<Vec<Complex64>>>,
    ) -> State {
        let normal = Normal::zero(unknowns.len());
        State {
            unknowns,
            corrections: corrections.unwrap_or_else(|| self.no_corrections()),
            normal,
        }
    }

    fn no_corrections(&self) -> Vec<Vec<Complex64>> {
        let zero = |group: &Group<N>| vec![ZERO; group.sources.len() * group.lines()];
        self.groups.iter().map(zero).collect()
    }

    /// The point to which a step takes from `state`, the corrections following.
    pub(super) fn step(
        &self,
        weights: &[Weights],
        state: &State,
        unknowns: DVector<f64>,
    ) -> Option<State> {
        self.walk(
            weights,
            unknowns,
            state.corrections.clone(),
            Some(&state.unknowns),
        )
    }

    fn walk(
        &self,
        weights: &[Weights],
        unknowns: DVector<f64>,
        mut corrections: Vec<Vec<Complex64>>,
        from: Option<&DVector<f64>>,
    ) -> Option<State> {
        let mut normal = Normal::zero(unknowns.len());
        let groups = self.groups.iter().zip(weights).zip(&mut corrections);
        for ((group, weights), corrections) in groups {
            if group.sources.is_empty() {
                let unknowns = unknowns.as_slice();
                independent::accumulate(group, self.entries, unknowns, weights, &mut normal)?;
            } else {
                self.settle(group, weights, (from, &unknowns), corrections, &mut normal)?;
            }
            normal.cost += weights.scatter;
            normal.linearised_cost += weights.scatter;
        }
        normal.matrix.fill_upper_triangle_with_lower_triangle();
        normal.cost.is_finite().then_some(State {
            unknowns,
            corrections,
            normal,
        })
    }

    /// Adds a group whose lines have corrections, which follow the unknowns, to the normal equations.
    fn settle(
        &self,
        group: &Group<N>,
        weights: &Weights,
        (from, to): (Option<&DVector<f64>>, &DVector<f64>),
        corrections: &mut [Complex64],
        normal: &mut Normal,
    ) -> Option<()> {
        let count = group.sources.len();
        let pieces: Vec<(usize, &mut [Complex64])> = corrections
            .chunks_mut(count * PIECE)
            .enumerate()
            .map(|(piece, corrections)| (piece * PIECE, corrections))
            .collect();
        let sums = parallel::map_each(pieces, |(first, corrections)| {
            let mut line = Line::new(group, self.entries);
            let mut normal = Normal::zero(to.len());
            for (index, delta) in (first..).zip(corrections.chunks_mut(count)) {
                let variances = line.weights(weights, index);
                line.settle(index, variances, from, to, delta)?;
                line.whiten(variances, delta)?;
                line.add_to(&mut normal);
            }
            Some(normal)
        });
        for sum in sums {
            normal.add(&sum?);
        }
        Some(())
    }

    /// Whether all entries have errors of their own: no substructure's error is an unknown.
    pub(super) fn is_independent(&self) -> bool {
        self.groups.iter().all(|group| group.sources.is_empty())
    }

    /// The point `unknowns` with these corrections, and the weights that it gives itself.
    pub(super) fn renewed(
        &self,
        levels: Levels,
        unknowns: DVector<f64>,
        corrections: Option<Vec<Vec<Complex64>>>,
    ) -> Option<(Vec<Weights>, State)> {
        if !self.is_independent() {
            let state = self.unweighted(unknowns, corrections);
            let weights = self.weights(levels, &state)?;
            let state = self.at(&weights, state.unknowns, Some(state.corrections))?;
            return Some((weights, state));
        }
        let mut normal = Normal::zero(unknowns.len());
        let all: Option<Vec<Weights>> = self
            .groups
            .iter()
            .map(|group| {
                let unknowns = unknowns.as_slice();
                independent::renew(group, self.entries, unknowns, levels.assembly, &mut normal)
            })
            .collect();
        let all = all?;
        let scatter: f64 = all.iter().map(|weights| weights.scatter).sum();
        normal.cost += scatter;
        normal.linearised_cost += scatter;
        normal.matrix.fill_upper_triangle_with_lower_triangle();
        let state = State {
            corrections: self.no_corrections(),
            unknowns,
            normal,
        };
        state.normal.cost.is_finite().then_some((all, state))
    }

    /// Calls `visit` with each line of each group as it is at `state`: computed and, with `weights`, whitened. Derivatives by
    /// the joint are there only where there are sources.
    pub(super) fn visit(
        &self,
        weights: Option<&[Weights]>,
        state: &State,
        mut visit: impl FnMut(usize, &Line<'_, N>),
    ) -> Option<()> {
        for (number, group) in self.groups.iter().enumerate() {
            let weights = weights.map(|weights| &weights[number]);
            if group.sources.is_empty() {
                let held = weights.map_or(Whitening::None, Whitening::Held);
                self.visit_independent(group, held, state, |line| visit(number, line))?;
            } else {
                self.visit_linearised(number, weights, state, |line| visit(number, line))?;
            }
        }
        Some(())
    }

    /// The same, whitened by the variances that `levels` give there.
    pub(super) fn visit_whitened(
        &self,
        levels: Levels,
        state: &State,
        mut visit: impl FnMut(usize, &Line<'_, N>),
    ) -> Option<()> {
        if !self.is_independent() {
            let weights = self.weights(levels, state)?;
            return self.visit(Some(&weights), state, visit);
        }
        for (number, group) in self.groups.iter().enumerate() {
            let own = Whitening::Renewed(levels.assembly);
            self.visit_independent(group, own, state, |line| visit(number, line))?;
        }
        Some(())
    }

    /// The same, whitened, with the derivatives by the joint.
    pub(super) fn visit_scores(
        &self,
        weights: &[Weights],
        state: &State,
        mut visit: impl FnMut(usize, &Line<'_, N>),
    ) -> Option<()> {
        for (number, weights) in weights.iter().enumerate() {
            self.visit_linearised(number, Some(weights), state, |line| visit(number, line))?;
        }
        Some(())
    }

    fn visit_independent(
        &self,
        group: &Group<N>,
        whitening: Whitening<'_>,
        state: &State,
        mut visit: impl FnMut(&Line<'_, N>),
    ) -> Option<()> {
        let unknowns = state.unknowns.as_slice();
        let blocks = group.blocks.iter();
        let computed: Option<Vec<Vec<Complex64>>> = blocks
            .map(|block| independent::computed(block, self.entries, unknowns))
            .collect();
        let computed = computed?;
        let mut line = Line::new(group, self.entries);
        for index in 0..group.lines() {
            line.take(index, &computed);
            match whitening {
                Whitening::None => {}
                Whitening::Held(weights) => {
                    let (variances, _) = line.weights(weights, index);
                    line.whiten_independent(variances);
                }
                Whitening::Renewed(level) => line.whiten_by(level),
            }
            visit(&line);
        }
        Some(())
    }

    fn visit_linearised(
        &self,
        number: usize,
        weights: Option<&Weights>,
        state: &State,
        mut visit: impl FnMut(&Line<'_, N>),
    ) -> Option<()> {
        let group = &self.groups[number];
        let mut line = Line::new(group, self.entries);
        let sources = group.sources.len();
        for index in 0..group.lines() {
            let delta = &state.corrections[number][index * sources..(index + 1) * sources];
            line.linearise(index, state.unknowns.as_slice(), delta)?;
            if let Some(weights) = weights {
                let variances = line.weights(weights, index);
                line.whiten(variances, delta)?;
            } else {
                line.add_corrections(delta);
            }
            visit(&line);
        }
        Some(())
    }
}

/// One line of a group, linearised: everything that the normal equations need of it. Reused from line to line.
pub(super) struct Line<'g, const N: usize> {
    group: &'g Group<N>,
    joint_entries: &'g [(usize, usize)],
    kernel: Kernel<N>,
    transfer: Vec<[Complex64; N]>,
    pub(super) index: usize,
    pub(super) omega: f64,
    /// H^C at each entry of all blocks.
    pub(super) computed: Vec<Complex64>,
    /// y − H^C, then r̃, then whitened.
    pub(super) residual: Vec<Complex64>,
    /// ∂H^C/∂K*, then whitened: for each entry of all blocks one of each unknown entry of K*.
    by_joint: Vec<[Complex64; MAX_ENTRIES]>,
    /// J: for each source, every entry of all blocks.
    pub(super) by_source: Vec<Complex64>,
    /// Σ, then its Cholesky factor.
    factor: Vec<Complex64>,
    /// Σ|r̃|²/|H^C|², before whitening.
    pub(super) relative_power: f64,
    cost: f64,
    /// The cost that is left once the corrections have followed, as linearised.
    residual_cost: f64,
    signal: f64,
    log_determinant: f64,
    trial: Vec<Complex64>,
}

impl<'g, const N: usize> Line<'g, N> {
    fn new(group: &'g Group<N>, joint_entries: &'g [(usize, usize)]) -> Self {
        let size = group.entries();
        Self {
            group,
            joint_entries,
            kernel: Kernel::new(),
            transfer: Vec::new(),
            index: 0,
            omega: 0.0,
            computed: vec![ZERO; size],
            residual: vec![ZERO; size],
            by_joint: vec![[ZERO; MAX_ENTRIES]; size],
            by_source: vec![ZERO; size * group.sources.len()],
            factor: vec![
                ZERO;
                if group.sources.is_empty() {
                    0
                } else {
                    size * size
                }
            ],
            relative_power: 0.0,
            cost: 0.0,
            residual_cost: 0.0,
            signal: 0.0,
            log_determinant: 0.0,
            trial: Vec::new(),
        }
    }

    fn weights<'w>(&self, weights: &'w Weights, index: usize) -> (&'w [f64], &'w [f64]) {
        let (size, sources) = (self.computed.len(), self.group.sources.len());
        (
            &weights.entries[index * size..(index + 1) * size],
            &weights.sources[index * sources..(index + 1) * sources],
        )
    }

    /// H^C of one line as computed before, and the residual.
    fn take(&mut self, index: usize, computed: &[Vec<Complex64>]) {
        self.index = index;
        let mut at = 0;
        for (block, computed) in self.group.blocks.iter().zip(computed) {
            let count = block.entries.len();
            let place = index * count..(index + 1) * count;
            self.computed[at..at + count].copy_from_slice(&computed[place.clone()]);
            for (e, measured) in (at..).zip(&block.measured[place]) {
                self.residual[e] = measured - self.computed[e];
            }
            at += count;
        }
    }

    /// H^C, the residual and the derivatives at this line.
    fn linearise(&mut self, index: usize, unknowns: &[f64], delta: &[Complex64]) -> Option<()> {
        self.compute(index, unknowns, delta, true)
    }

    /// The same, the derivatives being left as they are unless they are wanted.
    fn compute(
        &mut self,
        index: usize,
        unknowns: &[f64],
        delta: &[Complex64],
        derivatives: bool,
    ) -> Option<()> {
        self.index = index;
        self.omega = self.group.blocks.first()?.omega[index];
        let stiffness = complex_stiffness::<N>(self.joint_entries, unknowns, self.omega);
        let size = self.computed.len();
        let mut at = 0;
        for (number, block) in self.group.blocks.iter().enumerate() {
            let columns = index * block.points..(index + 1) * block.points;
            let count = block.entries.len();
            let own = &block.own[index * count..(index + 1) * count];
            let measured = &block.measured[index * count..(index + 1) * count];
            let mut free = block.free[index];
            self.transfer.clear();
            self.transfer.extend_from_slice(&block.transfer[columns]);
            for (source, &delta) in self.group.sources.iter().zip(delta) {
                if let Some(pattern) = &source.patterns[number] {
                    if pattern.acts_on_free {
                        for i in 0..N {
                            for j in 0..N {
                                free[i][j] += delta * pattern.free[i][j];
                            }
                        }
                    }
                    for (column, change) in self.transfer.iter_mut().zip(&pattern.transfer) {
                        for i in 0..N {
                            column[i] += delta * change[i];
                        }
                    }
                }
            }
            let transfer = self.transfer.iter().copied();
            self.kernel.solve(&free, transfer, &stiffness)?;
            for (e, &entry) in block.entries.iter().enumerate() {
                let mut own = own[e];
                for (source, &delta) in self.group.sources.iter().zip(delta) {
                    if let Some(pattern) = &source.patterns[number]
                        && let Some(&share) = pattern.own.get(e)
                    {
                        own += delta * share;
                    }
                }
                let computed = self.kernel.receptance(own, entry);
                self.computed[at + e] = computed;
                self.residual[at + e] = measured[e] - computed;
                if !derivatives {
                    continue;
                }
                for (t, &place) in self.joint_entries.iter().enumerate() {
                    self.by_joint[at + e][t] = self.kernel.by_stiffness(entry, place);
                }
                for (s, source) in self.group.sources.iter().enumerate() {
                    self.by_source[s * size + at + e] =
                        source.patterns[number].as_ref().map_or(ZERO, |pattern| {
                            let own = pattern.own.get(e).copied().unwrap_or(0.0);
                            let free = pattern.acts_on_free.then_some(&pattern.free);
                            self.kernel.by_source(entry, free, &pattern.transfer, own)
                        });
                }
            }
            at += count;
        }
        Some(())
    }

    /// Divides by σ where every entry has an error of its own.
    fn whiten_independent(&mut self, variances: &[f64]) {
        self.measure();
        for (e, variance) in variances.iter().enumerate() {
            let weight = variance.recip().sqrt();
            self.residual[e] *= weight;
            for value in &mut self.by_joint[e][..self.joint_entries.len()] {
                *value *= weight;
            }
        }
    }

    /// The same with the variances that `level` gives for the computed receptances.
    fn whiten_by(&mut self, level: NoiseLevel) {
        self.measure();
        let mut at = 0;
        for block in &self.group.blocks {
            let count = block.entries.len();
            let known = block
                .known
                .get(self.index * count..(self.index + 1) * count);
            for (e, entry) in block.entries.iter().enumerate() {
                let known = known.map(|known| known[e]);
                let variance = of_one(level, known, self.computed[at + e].norm_sqr());
                self.residual[at + e] *= (f64::from(entry.count) / variance).sqrt();
            }
            at += count;
        }
    }

    fn measure(&mut self) {
        let pairs = self.residual.iter().zip(&self.computed);
        self.relative_power = pairs.map(|(r, h)| r.norm_sqr() / h.norm_sqr()).sum();
    }

    /// y − H^C + Jδ: the residual as if the substructures' receptances were those measured.
    fn add_corrections(&mut self, delta: &[Complex64]) {
        let size = self.residual.len();
        for (s, delta) in delta.iter().enumerate() {
            for e in 0..size {
                self.residual[e] += self.by_source[s * size + e] * delta;
            }
        }
    }

    /// Σ = Σ_C + J Σ_H Jᴴ = L Lᴴ, and L⁻¹ before residual and derivatives.
    fn whiten(
        &mut self,
        (variances, of_sources): (&[f64], &[f64]),
        delta: &[Complex64],
    ) -> Option<()> {
        if self.group.sources.is_empty() {
            self.whiten_independent(variances);
            return Some(());
        }
        let size = self.residual.len();
        let powers = self.computed.iter().zip(variances);
        self.signal = powers.map(|(h, variance)| h.norm_sqr() / variance).sum();
        self.cost = self.whole_cost((variances, of_sources), delta);
        self.add_corrections(delta);
        self.measure();
        self.factorise(variances, of_sources)?;
        forward(&self.factor, size, &mut self.residual);
        for t in 0..self.joint_entries.len() {
            for row in 0..size {
                let mut value = self.by_joint[row][t];
                for column in 0..row {
                    value -= self.factor[row * size + column] * self.by_joint[column][t];
                }
                self.by_joint[row][t] = value / self.factor[row * size + row].re;
            }
        }
        Some(())
    }

    fn factorise(&mut self, variances: &[f64], of_sources: &[f64]) -> Option<()> {
        let size = self.residual.len();
        self.factor.fill(ZERO);
        for (e, variance) in variances.iter().enumerate() {
            self.factor[e * size + e] = Complex64::from(*variance);
        }
        for (s, &variance) in of_sources.iter().enumerate() {
            let column = &self.by_source[s * size..(s + 1) * size];
            for row in 0..size {
                let left = column[row] * variance;
                for other in 0..=row {
                    self.factor[row * size + other] += left * column[other].conj();
                }
            }
        }
        self.log_determinant = 0.0;
        for row in 0..size {
            for column in 0..=row {
                let mut value = self.factor[row * size + column];
                for k in 0..column {
                    value -= self.factor[row * size + k] * self.factor[column * size + k].conj();
                }
                if row == column {
                    if !(value.re.is_finite() && value.re > 0.0) {
                        return None;
                    }
                    self.log_determinant += value.re.ln();
                    self.factor[row * size + row] = Complex64::from(value.re.sqrt());
                } else {
                    self.factor[row * size + column] =
                        value / self.factor[column * size + column].re;
                }
            }
        }
        Some(())
    }

    /// Lets the corrections follow the unknowns, and linearises the line there: δ first as the step's own linear model says,
    /// then by Gauss–Newton on this line alone, no step of which may raise its cost. Near a resonance the errors of the
    /// substructures act far from linearly.
    fn settle(
        &mut self,
        index: usize,
        variances: (&[f64], &[f64]),
        from: Option<&DVector<f64>>,
        to: &DVector<f64>,
        delta: &mut [Complex64],
    ) -> Option<()> {
        let mut trial = std::mem::take(&mut self.trial);
        if let Some(from) = from {
            trial.clear();
            trial.extend_from_slice(delta);
            if self.linearise(index, from.as_slice(), &trial).is_some() {
                self.follow(variances, from, to, &mut trial)?;
            }
            let before = self.cost_at(index, variances, to, delta);
            let after = self.cost_at(index, variances, to, &trial);
            if after <= before {
                delta.copy_from_slice(&trial);
            }
        }
        for _ in 0..CORRECTION_ROUNDS {
            self.linearise(index, to.as_slice(), delta)?;
            let before = self.whole_cost(variances, delta);
            trial.clear();
            trial.extend_from_slice(delta);
            self.follow(variances, to, to, &mut trial)?;
            let promised = before - self.residual_cost;
            if promised <= CORRECTION_GAIN * before {
                break;
            }
            let mut accepted = false;
            let mut share = 1.0;
            for _ in 0..CORRECTION_QUARTERINGS {
                let gained = before - self.cost_at(index, variances, to, &trial);
                // Along a step S falls by (2α − α²) of what the whole step promises.
                if gained >= CORRECTION_KEPT_PROMISE * share * (2.0 - share) * promised {
                    accepted = true;
                    break;
                }
                share *= 0.25;
                for (trial, delta) in trial.iter_mut().zip(delta.iter()) {
                    *trial = *delta + (*trial - *delta) * 0.25;
                }
            }
            if !accepted {
                break;
            }
            delta.copy_from_slice(&trial);
        }
        self.trial = trial;
        self.linearise(index, to.as_slice(), delta)
    }

    /// What this line adds to the cost with these corrections; infinite where it cannot be computed.
    fn cost_at(
        &mut self,
        index: usize,
        variances: (&[f64], &[f64]),
        unknowns: &DVector<f64>,
        delta: &[Complex64],
    ) -> f64 {
        if self
            .compute(index, unknowns.as_slice(), delta, false)
            .is_none()
        {
            return f64::INFINITY;
        }
        let cost = self.whole_cost(variances, delta);
        if cost.is_finite() {
            cost
        } else {
            f64::INFINITY
        }
    }

    /// Σ|y − H^C|²/σ_C² + Σ|δ|²/σ_H²
    fn whole_cost(&self, (variances, of_sources): (&[f64], &[f64]), delta: &[Complex64]) -> f64 {
        let residuals = self.residual.iter().zip(variances);
        let mut cost: f64 = residuals.map(|(r, variance)| r.norm_sqr() / variance).sum();
        for (delta, variance) in delta.iter().zip(of_sources) {
            if *variance > 0.0 {
                cost += delta.norm_sqr() / variance;
            }
        }
        cost
    }

    /// δ ← Σ_H Jᴴ Σ⁻¹ (r̃ − ∂H^C/∂θ Δθ): the corrections that go with a step of the unknowns.
    fn follow(
        &mut self,
        (variances, of_sources): (&[f64], &[f64]),
        from: &DVector<f64>,
        to: &DVector<f64>,
        delta: &mut [Complex64],
    ) -> Option<()> {
        let size = self.residual.len();
        self.add_corrections(delta);
        let step = to - from;
        let count = self.joint_entries.len();
        for e in 0..size {
            for t in 0..count {
                let change = Complex64::new(step[t], self.omega * step[count + t]);
                self.residual[e] -= self.by_joint[e][t] * change;
            }
        }
        self.factorise(variances, of_sources)?;
        forward(&self.factor, size, &mut self.residual);
        self.residual_cost = self.residual.iter().map(|r| r.norm_sqr()).sum();
        backward(&self.factor, size, &mut self.residual);
        for (s, delta) in delta.iter_mut().enumerate() {
            let column = &self.by_source[s * size..(s + 1) * size];
            let pairs = column.iter().zip(&self.residual);
            *delta = of_sources[s] * pairs.map(|(j, r)| j.conj() * r).sum::<Complex64>();
        }
        Some(())
    }

    /// Adds the whitened line to the normal equations (lower triangle).
    fn add_to(&self, normal: &mut Normal) {
        let count = self.joint_entries.len();
        normal.cost += self.cost;
        normal.signal += self.signal;
        let mut sums = Sums::default();
        for (residual, row) in self.residual.iter().zip(&self.by_joint) {
            sums.cost += residual.norm_sqr();
            sums.add(*residual, row, count);
        }
        normal.linearised_cost += sums.cost;
        sums.add_to(normal, self.omega, count);
    }

    /// Jᵀr of this whitened line by the unknowns: what it adds to the gradient.
    pub(super) fn score(&self) -> Vec<f64> {
        let count = self.joint_entries.len();
        let mut score = vec![0.0; 2 * count];
        for (residual, row) in self.residual.iter().zip(&self.by_joint) {
            for t in 0..count {
                let product = row[t].conj() * residual;
                score[t] += product.re;
                score[count + t] += self.omega * product.im;
            }
        }
        score
    }

    /// ln det Σ of the whitened line.
    pub(super) fn log_determinant(&self) -> f64 {
        self.log_determinant
    }
}

/// Sums over the entries of one whitened line.
#[derive(Default)]
struct Sums {
    cost: f64,
    /// Σ conj(∂H/∂K*_i) ∂H/∂K*_j for j ≤ i
    products: [[Complex64; MAX_ENTRIES]; MAX_ENTRIES],
    /// Σ conj(∂H/∂K*_i) r
    right: [Complex64; MAX_ENTRIES],
}

impl Sums {
    #[inline]
    fn add(&mut self, residual: Complex64, row: &[Complex64; MAX_ENTRIES], count: usize) {
        // Rows beyond `count` are zero, so that the loops can be unrolled.
        debug_assert!(count <= MAX_ENTRIES);
        for i in 0..MAX_ENTRIES {
            let conjugate = row[i].conj();
            self.right[i] += conjugate * residual;
            for j in 0..=i {
                self.products[i][j] += conjugate * row[j];
            }
        }
    }

    /// ∂K*/∂k = E, ∂K*/∂c = jωE
    fn add_to(&self, normal: &mut Normal, omega: f64, count: usize) {
        for i in 0..count {
            normal.gradient[i] += self.right[i].re;
            normal.gradient[count + i] += omega * self.right[i].im;
            for j in 0..=i {
                let product = self.products[i][j];
                normal.matrix[(i, j)] += product.re;
                normal.matrix[(count + i, count + j)] += omega * omega * product.re;
                normal.matrix[(count + i, j)] += omega * product.im;
                if i != j {
                    normal.matrix[(count + j, i)] -= omega * product.im;
                }
            }
        }
    }
}

/// x ← L⁻¹ x
fn forward(factor: &[Complex64], size: usize, x: &mut [Complex64]) {
    for row in 0..size {
        let mut value = x[row];
        for column in 0..row {
            value -= factor[row * size + column] * x[column];
        }
        x[row] = value / factor[row * size + row].re;
    }
}

/// x ← L⁻ᴴ x
fn backward(factor: &[Complex64], size: usize, x: &mut [Complex64]) {
    for row in (0..size).rev() {
        let mut value = x[row];
        for other in row + 1..size {
            value -= factor[other * size + row].conj() * x[other];
        }
        x[row] = value / factor[row * size + row].re;
    }
}
