//! The sum that the estimator minimises, with its normal equations, over all lines of all assemblies.
//!
//! Σ |y − H^C(θ, û + δ)|²/σ_C² + Σ |δ|²/σ_H²: measured receptances y of the assembly with variance σ_C², measured
//! receptances û of the substructures with variance σ_H² and their corrections δ. The corrections are unknowns of their
//! own on every line. Eliminated, they leave S = r̃ᴴ Σ⁻¹ r̃ with r̃ = y − H^C + Jδ, Σ = Σ_C + J Σ_H Jᴴ and J = ∂H^C/∂û, linearised
//! at corrections δ = Σ_H Jᴴ Σ⁻¹ r̃ that follow each step of θ.
//!
//! θ holds the unknowns of one torque after the other; each assembly has one of them. Where assemblies with different joints
//! share a substructure, δ couples these.

use std::ops::Range;
use std::sync::Arc;

use nalgebra::DVector;
use num_complex::Complex64;

use super::corrected::{Piece, Variances};
use super::group::Group;
use super::independent;
use super::layout::Place;
use super::line::{self, Line};
use super::noise::{Levels, Size};
use super::normal::Normal;
use super::parallel;
use super::weights::source_variances;

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
    /// What the variances of the sources follow from, which no unknown changes.
    pub(super) levels: Levels,
    /// Σ|y − mean|²/σ² over repeated measurements: part of the cost that no joint changes.
    pub(super) scatter: f64,
}

impl Weights {
    /// σ_C² of one line.
    fn of_entries(&self, group: &Group, line: usize) -> &[f64] {
        let size = group.entries();
        &self.entries[line * size..(line + 1) * size]
    }

    /// All variances of one line; those of the sources are put into `sources`.
    fn at<'w>(
        &'w self,
        group: &Group,
        line: usize,
        sources: &'w mut Vec<f64>,
    ) -> line::Variances<'w> {
        source_variances(group, self.levels, line, sources);
        line::Variances {
            entries: self.of_entries(group, line),
            sources,
        }
    }
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
    Renewed(Size),
}

/// The model with data and weights.
#[derive(Clone, Copy)]
pub(super) struct Objective<'a> {
    pub(super) groups: &'a [Group],
    /// Unknown entries of the K* of each torque.
    pub(super) entries: &'a [Place],
}

impl Objective<'_> {
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

    /// The point `unknowns`, the corrections following from these (none at all: zero).
    pub(super) fn at(
        &self,
        weights: &[Weights],
        unknowns: DVector<f64>,
        corrections: Option<Corrections>,
    ) -> Option<State> {
        let mut corrections = self.own(corrections);
        let mut normal = Normal::zero(unknowns.len());
        let groups = self.groups.iter().zip(weights).zip(&mut corrections);
        for ((group, weights), corrections) in groups {
            if group.sources.is_empty() {
                let unknowns = unknowns.as_slice();
                independent::accumulate(group, self.entries, unknowns, weights, &mut normal)?;
            } else {
                self.settle(group, weights, &unknowns, corrections, &mut normal)?;
            }
            normal.cost += weights.scatter;
        }
        state(unknowns, corrections, normal)
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
        let zero = |group: &Group| vec![ZERO; group.sources.len() * group.lines()];
        Arc::new(self.groups.iter().map(zero).collect())
    }

    /// Corrections that can be changed.
    fn own(&self, corrections: Option<Corrections>) -> Vec<Vec<Complex64>> {
        Arc::unwrap_or_clone(corrections.unwrap_or_else(|| self.no_corrections()))
    }

    /// Adds a group whose lines have corrections, which follow the unknowns, to the normal equations.
    fn settle(
        &self,
        group: &Group,
        weights: &Weights,
        unknowns: &DVector<f64>,
        corrections: &mut [Complex64],
        normal: &mut Normal,
    ) -> Option<()> {
        let (count, size) = (group.sources.len(), group.entries());
        let variances = weights.entries.chunks(size * PIECE);
        let pieces = corrections.chunks_mut(count * PIECE).zip(variances);
        let pieces: Vec<_> = pieces.enumerate().collect();
        let sums = parallel::map_each(pieces, |(number, (corrections, variances))| {
            let mut normal = Normal::zero(unknowns.len());
            self.piece(group, weights.levels, unknowns, number).settle(
                Variances::Held(variances),
                corrections,
                &mut normal,
            )?;
            Some(normal)
        });
        for sum in sums {
            normal.add(&sum?);
        }
        Some(())
    }

    /// The lines that one processor takes at a time.
    fn piece<'p>(
        &'p self,
        group: &'p Group,
        levels: Levels,
        unknowns: &'p DVector<f64>,
        number: usize,
    ) -> Piece<'p> {
        Piece {
            group,
            entries: self.entries,
            unknowns: unknowns.as_slice(),
            levels,
            first: number * PIECE,
        }
    }

    /// The same with the variances that `levels` give at `unknowns`, which it returns.
    fn settle_renewed(
        &self,
        group: &Group,
        levels: Levels,
        unknowns: &DVector<f64>,
        corrections: &mut [Complex64],
        normal: &mut Normal,
    ) -> Option<Weights> {
        let (count, size) = (group.sources.len(), group.entries());
        let mut entries = vec![0.0; size * group.lines()];
        let pieces: Vec<_> = corrections
            .chunks_mut(count * PIECE)
            .zip(entries.chunks_mut(size * PIECE))
            .enumerate()
            .collect();
        let sums = parallel::map_each(pieces, |(piece, (corrections, entries))| {
            let mut normal = Normal::zero(unknowns.len());
            let scatter = self.piece(group, levels, unknowns, piece).settle(
                Variances::Renewed(entries),
                corrections,
                &mut normal,
            )?;
            Some((normal, scatter))
        });
        let mut all = 0.0;
        for sum in sums {
            let (sum, scatter) = sum?;
            normal.add(&sum);
            all += scatter;
        }
        Some(Weights {
            entries,
            levels,
            scatter: all,
        })
    }

    /// Variances of y − H^C with the substructures as measured, the errors of these included, for each entry of all blocks of a
    /// group that has sources, line by line.
    pub(super) fn marginal_variances(
        &self,
        group: &Group,
        levels: Levels,
        unknowns: &DVector<f64>,
    ) -> Option<Vec<f64>> {
        let pieces = parallel::pieces(group.lines(), PIECE);
        let of_piece = |lines: &Range<usize>| {
            self.piece(group, levels, unknowns, lines.start / PIECE)
                .marginal_variances(lines.len())
        };
        let all: Option<Vec<Vec<f64>>> = parallel::map(&pieces, of_piece).into_iter().collect();
        Some(all?.concat())
    }

    /// Whether all entries have errors of their own: no substructure's error is an unknown.
    pub(super) fn is_independent(&self) -> bool {
        self.groups.iter().all(|group| group.sources.is_empty())
    }

    /// The point `unknowns`, the corrections following from these, and the weights that it gives itself.
    pub(super) fn renewed(
        &self,
        levels: Levels,
        unknowns: DVector<f64>,
        corrections: Option<Corrections>,
    ) -> Option<(Vec<Weights>, State)> {
        let mut corrections = self.own(corrections);
        let mut normal = Normal::zero(unknowns.len());
        let mut all = Vec::with_capacity(self.groups.len());
        for (group, corrections) in self.groups.iter().zip(&mut corrections) {
            let weights = if group.sources.is_empty() {
                let unknowns = unknowns.as_slice();
                independent::renew(group, self.entries, unknowns, levels, &mut normal)?
            } else {
                self.settle_renewed(group, levels, &unknowns, corrections, &mut normal)?
            };
            normal.cost += weights.scatter;
            all.push(weights);
        }
        Some((all, state(unknowns, corrections, normal)?))
    }

    /// Calls `visit` with each line of each group as it is at `state`: computed and, with `weights`, whitened. Derivatives by
    /// the joint are there only where there are sources.
    pub(super) fn visit(
        &self,
        weights: Option<&[Weights]>,
        state: &State,
        visit: &mut dyn FnMut(usize, &Line<'_>),
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
        visit: impl Fn(&mut T, &Line<'_>) + Sync,
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
        let of_group = |group: &Group| {
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
        visit: &mut dyn FnMut(usize, &Line<'_>),
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
        group: &Group,
        whitening: Whitening<'_>,
        state: &State,
        lines: Range<usize>,
        visit: &mut dyn FnMut(&Line<'_>),
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
                    line.whiten_independent(weights.of_entries(group, index));
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
        visit: &mut dyn FnMut(&Line<'_>),
    ) -> Option<()> {
        let group = &self.groups[number];
        let mut line = Line::new(group, self.entries);
        let count = group.sources.len();
        let mut sources = Vec::new();
        for index in 0..group.lines() {
            let delta = &state.corrections[number][index * count..(index + 1) * count];
            line.linearise(index, state.unknowns.as_slice(), delta)?;
            if let Some(weights) = weights {
                let variances = weights.at(group, index, &mut sources);
                line.whiten(variances, delta)?;
            } else {
                line.add_corrections(delta);
            }
            visit(&line);
        }
        Some(())
    }
}

/// A point whose normal equations are complete; `None` where a sum is no number.
fn state(
    unknowns: DVector<f64>,
    corrections: Vec<Vec<Complex64>>,
    mut normal: Normal,
) -> Option<State> {
    normal.matrix.fill_upper_triangle_with_lower_triangle();
    normal.cost.is_finite().then(|| State {
        unknowns,
        corrections: Arc::new(corrections),
        normal,
    })
}
