//! The sum that the estimator minimises, with its normal equations, over all lines of all assemblies.
//!
//! Σ |y − H^C(θ, û + δ)|²/σ_C² + Σ |δ|²/σ_H²: measured receptances y of the assembly with variance σ_C², measured
//! receptances û of the substructures with variance σ_H² and their corrections δ. The corrections are unknowns of their
//! own on every line. Eliminated, they leave S = r̃ᴴ Σ⁻¹ r̃ with r̃ = y − H^C + Jδ, Σ = Σ_C + J Σ_H Jᴴ and J = ∂H^C/∂û, linearised
//! at corrections δ = Σ_H Jᴴ Σ⁻¹ r̃ that follow each step of θ.
//!
//! A search may hold the corrections (`holds`): they are zero then, and Σ alone follows θ.
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
use super::noise::Levels;
use super::normal::Normal;
use super::parallel;

/// Stiffness, beside the substructures' own dynamic stiffness at the joint, of a joint that is rigid for all that can be measured.
const RIGID: f64 = 1e6;
const DOFS_OF_TWO_BOLTS: usize = 4;
/// Lines with corrections that one processor takes at a time. Sums are formed piece by piece, so that they do not depend on
/// how many processors there are.
pub(super) const PIECE: usize = 128;
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
    /// σ_C² of some lines.
    pub(super) fn of_entries(&self, group: &Group, lines: Range<usize>) -> &[f64] {
        let size = group.entries();
        &self.entries[lines.start * size..lines.end * size]
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

/// The model with data and weights.
#[derive(Clone, Copy)]
pub(super) struct Objective<'a> {
    pub(super) groups: &'a [Group],
    /// Unknown entries of the K* of each torque.
    pub(super) entries: &'a [Place],
    /// Whether the substructures' receptances are held as they were measured: their errors act through Σ alone.
    pub(super) holds: bool,
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
    pub(super) fn piece<'p>(
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
            holds: self.holds,
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

    /// The same as a search goes through it: between many bolts with the substructures' receptances held as they were measured.
    /// Their corrections have more freedom than few lines tell, and a search that they follow fits the noise, little by little.
    pub(super) fn as_searched(self) -> Self {
        Self {
            holds: self.is_of_many_bolts(),
            ..self
        }
    }

    /// Whether corrections follow more bolts with joints of their own than two.
    pub(super) fn is_of_many_bolts(&self) -> bool {
        self.has_many_joints() && !self.is_independent()
    }

    /// Whether more bolts than two have joints of their own: some of their unknowns are told by noise alone, nearly.
    pub(super) fn has_many_joints(&self) -> bool {
        let mut groups = self.groups.iter();
        let has_many = groups.any(|group| group.dofs() > DOFS_OF_TWO_BOLTS);
        has_many && self.entries.iter().all(|place| place.is_single())
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
