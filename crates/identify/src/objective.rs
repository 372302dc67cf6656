//! The sum that the estimator minimises, with its normal equations, over all lines of all assemblies.
//!
//! S = Σ |y − H^C(θ, û + δ)|²/σ_C² + Σ |δ|²/σ_H²: measured receptances y of the assembly with variance σ_C², measured
//! receptances û of the substructures with variance σ_H² and their corrections δ. The corrections are unknowns of their
//! own on every line. Eliminated, they leave the normal equations with Σ = Σ_C + J Σ_H Jᴴ, J = ∂H^C/∂û; so
//! S = r̃ᴴ Σ⁻¹ r̃ at the minimum over δ, with r̃ = y − H^C + Jδ.
//!
//! θ holds the unknowns of one torque after the other; each assembly has one of them. Where assemblies with different joints
//! share a substructure, δ couples these.

use std::ops::Range;
use std::sync::Arc;

use nalgebra::DVector;
use num_complex::Complex64;

use super::group::Group;
use super::independent;
use super::layout::Place;
use super::line::Line;
use super::noise::{Levels, NoiseLevel};
use super::normal::Normal;
use super::parallel;

/// Stiffness, beside the substructures' own dynamic stiffness at the joint, of a joint that is rigid for all that can be measured.
const RIGID: f64 = 1e6;
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

/// For each group, δ of each source, line by line. They take as much memory as the substructures' data.
pub(super) type Corrections = Arc<Vec<Vec<Complex64>>>;

/// A point: the unknowns, what the substructures' receptances are corrected by, and the normal equations there.
#[derive(Clone, Debug)]
pub(super) struct State {
    pub(super) unknowns: DVector<f64>,
    pub(super) corrections: Corrections,
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
    /// Unknown entries of the K* of each torque.
    pub(super) entries: &'a [Place],
}

impl<const N: usize> Objective<'_, N> {
    /// Whether no unknown is so large that the joint would be rigid whatever its value: there a search must not run away to.
    pub(super) fn is_within_reach(&self, unknowns: &DVector<f64>) -> bool {
        let Some(block) = self.groups.first().and_then(|group| group.blocks.first()) else {
            return false;
        };
        let (own, omega) = (&block.dynamic_stiffness, block.omega[block.lines() / 2]);
        let count = self.entries.len();
        let mut torques = unknowns.as_slice().chunks_exact(2 * count);
        torques.all(|unknowns| {
            self.entries.iter().enumerate().all(|(index, place)| {
                let (i, j) = place.first();
                let limit = RIGID * (own[i] * own[j]).sqrt();
                unknowns[index].abs() <= limit && omega * unknowns[count + index].abs() <= limit
            })
        })
    }

    /// The point `unknowns` with these corrections (none at all: zero).
    pub(super) fn at(
        &self,
        weights: &[Weights],
        unknowns: DVector<f64>,
        corrections: Option<Corrections>,
    ) -> Option<State> {
        let corrections = corrections.unwrap_or_else(|| self.no_corrections());
        self.walk(weights, unknowns, corrections, None)
    }

    /// The point `unknowns`, before there are weights: without normal equations.
    pub(super) fn unweighted(
        &self,
        unknowns: DVector<f64>,
        corrections: Option<Corrections>,
    ) -> State {
        let normal = Normal::zero(unknowns.len());
        State {
            unknowns,
            corrections: corrections.unwrap_or_else(|| self.no_corrections()),
            normal,
        }
    }

    /// Corrections of zero.
    pub(super) fn no_corrections(&self) -> Corrections {
        let zero = |group: &Group<N>| vec![ZERO; group.sources.len() * group.lines()];
        Arc::new(self.groups.iter().map(zero).collect())
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
            Arc::clone(&state.corrections),
            Some(&state.unknowns),
        )
    }

    fn walk(
        &self,
        weights: &[Weights],
        unknowns: DVector<f64>,
        corrections: Corrections,
        from: Option<&DVector<f64>>,
    ) -> Option<State> {
        let mut corrections = Arc::unwrap_or_clone(corrections);
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
            corrections: Arc::new(corrections),
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
        corrections: Option<Corrections>,
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
        visit: &mut dyn FnMut(usize, &Line<'_, N>),
    ) -> Option<()> {
        for (number, group) in self.groups.iter().enumerate() {
            let weights = weights.map(|weights| &weights[number]);
            if group.sources.is_empty() {
                let held = weights.map_or(Whitening::None, Whitening::Held);
                let all = 0..group.lines();
                self.visit_independent(group, held, state, all, &mut |line| visit(number, line))?;
            } else {
                self.visit_linearised(number, weights, state, &mut |line| visit(number, line))?;
            }
        }
        Some(())
    }

    /// What `visit` gathers of each group's lines as they are at `state`, whitened by the variances that `levels` give there. It begins with
    /// nothing gathered for each piece of consecutive lines.
    pub(super) fn gather_whitened<T: Default + Send>(
        &self,
        levels: Levels,
        state: &State,
        visit: impl Fn(&mut T, &Line<'_, N>) + Sync,
    ) -> Option<Vec<Vec<T>>> {
        if !self.is_independent() {
            let weights = self.weights(levels, state)?;
            let mut gathered: Vec<Vec<T>> =
                self.groups.iter().map(|_| vec![T::default()]).collect();
            self.visit(Some(&weights), state, &mut |group, line| {
                visit(&mut gathered[group][0], line);
            })?;
            return Some(gathered);
        }
        let own = Whitening::Renewed(levels.assembly);
        let of_group = |group: &Group<N>| {
            let pieces = parallel::pieces(group.lines(), independent::PIECE);
            let of_piece = |lines: &Range<usize>| {
                let mut gathered = T::default();
                self.visit_independent(group, own, state, lines.clone(), &mut |line| {
                    visit(&mut gathered, line);
                })?;
                Some(gathered)
            };
            parallel::map(&pieces, of_piece).into_iter().collect()
        };
        self.groups.iter().map(of_group).collect()
    }

    /// The same, whitened, with the derivatives by the joint.
    pub(super) fn visit_scores(
        &self,
        weights: &[Weights],
        state: &State,
        visit: &mut dyn FnMut(usize, &Line<'_, N>),
    ) -> Option<()> {
        for (number, weights) in weights.iter().enumerate() {
            self.visit_linearised(number, Some(weights), state, &mut |line| {
                visit(number, line)
            })?;
        }
        Some(())
    }

    fn visit_independent(
        &self,
        group: &Group<N>,
        whitening: Whitening<'_>,
        state: &State,
        lines: Range<usize>,
        visit: &mut dyn FnMut(&Line<'_, N>),
    ) -> Option<()> {
        let unknowns = state.unknowns.as_slice();
        let blocks = group.blocks.iter();
        let computed: Option<Vec<Vec<Complex64>>> = blocks
            .map(|block| independent::computed(block, self.entries, unknowns, lines.clone()))
            .collect();
        let computed = computed?;
        let mut line = Line::new(group, self.entries);
        let first = lines.start;
        for index in lines {
            line.take(index, first, &computed);
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
        visit: &mut dyn FnMut(&Line<'_, N>),
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
