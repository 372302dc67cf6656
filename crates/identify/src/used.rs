//! Which lines an estimate can use whose substructures have errors.
//!
//! Where H_jj + H_kk errs by ΔF, Q = (I + F K*)⁻¹ H_ks becomes (I + A)⁻¹ Q with A = (I + F K*)⁻¹ ΔF K*. At a sharp resonance of
//! the assembly A is large, and no linear model holds. How large it is expected to be follows from the variances and the joint
//! alone, never from the residual: leaving such lines out biases nothing.

use std::ops::Range;

use nalgebra::DVector;

use super::block::Block;
use super::group::Group;
use super::kernel::{Small, filled, for_dofs};
use super::lanes::{Complexes, LANES, Number, Reals};
use super::layout::Place;
use super::motions::{Act, place};
use super::noise::Levels;
use super::objective::Objective;
use super::strip::{Coupled, Strip};
use super::weights::source_variance_of_lanes;

/// A line is left out where A is expected to be larger than this …
const MOST_MOVED: f64 = 0.5;
/// … unless fewer than this part of the lines would be left, with much noise: then these are used.
const LEAST_PART: f64 = 0.5;

/// Lines of one assembly that an estimate goes through.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Chosen {
    /// Their indices.
    pub(super) lines: Vec<usize>,
    /// Those of them at which this assembly is left out, another one of its group being used; empty if there are none.
    pub(super) left_out: Vec<bool>,
}

impl Chosen {
    /// Consecutive lines.
    pub(super) fn of(lines: Range<usize>) -> Self {
        Self {
            lines: lines.collect(),
            left_out: Vec::new(),
        }
    }

    /// These lines of each assembly.
    pub(super) fn all_of(lines: &[Vec<usize>]) -> Vec<Self> {
        let of_assembly = |lines: &Vec<usize>| Self {
            lines: lines.clone(),
            left_out: Vec::new(),
        };
        lines.iter().map(of_assembly).collect()
    }

    /// How many of the lines are used.
    pub(super) fn count(&self) -> usize {
        self.lines.len() - self.left_out.iter().filter(|left_out| **left_out).count()
    }
}

/// Of `lines` of each assembly those that are `moved` little enough, and in each of the `groups` of assemblies those that another
/// one of them can use.
pub(super) fn chosen(
    lines: &[Vec<usize>],
    moved: &[Vec<f64>],
    groups: &[Vec<usize>],
) -> Vec<Chosen> {
    let steady: Vec<Vec<bool>> = moved.iter().map(|moved| steady(moved)).collect();
    let mut chosen = Chosen::all_of(lines);
    for group in groups {
        for &assembly in group {
            let count = lines[assembly].len();
            let used: Vec<usize> = (0..count)
                .filter(|&line| group.iter().any(|&member| steady[member][line]))
                .collect();
            let left_out: Vec<bool> = used.iter().map(|&line| !steady[assembly][line]).collect();
            chosen[assembly] = Chosen {
                lines: used.iter().map(|&line| lines[assembly][line]).collect(),
                left_out: if left_out.contains(&true) {
                    left_out
                } else {
                    Vec::new()
                },
            };
        }
    }
    chosen
}

/// Which lines move little enough.
fn steady(moved: &[f64]) -> Vec<bool> {
    let mut sizes = moved.to_vec();
    let least = (sizes.len() as f64 * LEAST_PART) as usize;
    let most = if least < sizes.len() {
        let (_, least, _) = sizes.select_nth_unstable_by(least, f64::total_cmp);
        least.max(MOST_MOVED)
    } else {
        MOST_MOVED
    };
    moved.iter().map(|moved| *moved <= most).collect()
}

impl Objective<'_> {
    /// Expected size of A at each line of each assembly: for each group.
    pub(super) fn moved(&self, levels: Levels, unknowns: &DVector<f64>) -> Vec<Vec<Vec<f64>>> {
        let of_group = |group: &Group| {
            let blocks = group.blocks.iter().enumerate();
            let of_block = |(number, block): (usize, &Block)| {
                let own = &unknowns.as_slice()[block.unknowns(self.entries)];
                let of: Option<OfBlock> = for_dofs!(block.dofs, motion);
                of.map_or_else(Vec::new, |of| {
                    of(group, number, levels, (self.entries, own))
                })
            };
            blocks.map(of_block).collect()
        };
        self.groups.iter().map(of_group).collect()
    }
}

type OfBlock = fn(&Group, usize, Levels, (&[Place], &[f64])) -> Vec<f64>;

/// Two entries of F of one block that have errors in common, or one twice.
struct FreeMotions {
    one: (usize, usize),
    other: (usize, usize),
    /// Their covariance as a sum over sources; twice that of two entries, which stand in both orders in E‖A‖².
    covariance: Vec<(usize, f64)>,
}

impl FreeMotions {
    fn of(group: &Group, number: usize) -> Vec<Self> {
        let mut all = Vec::new();
        for cluster in &group.motions.clusters {
            let entries = |motion: usize| {
                let actions = cluster.motions[motion].iter();
                let own = actions.filter(|action| action.block == number);
                own.filter_map(|action| match action.act {
                    Act::Free(i, j) => Some((i, j)),
                    Act::Transfer(..) | Act::Own(_) => None,
                })
            };
            for m in 0..cluster.motions.len() {
                for n in 0..=m {
                    let terms = &cluster.covariance[place(m, n)];
                    if terms.is_empty() {
                        continue;
                    }
                    let times = if m == n { 1.0 } else { 2.0 };
                    let covariance = terms.iter().map(|&(source, share)| (source, times * share));
                    let covariance: Vec<(usize, f64)> = covariance.collect();
                    for one in entries(m) {
                        all.extend(entries(n).map(|other| Self {
                            one,
                            other,
                            covariance: covariance.clone(),
                        }));
                    }
                }
            }
        }
        all
    }
}

/// √E‖A‖² of each line of one block, displacements in proportion to what a unit load on each DOF of the substructures does;
/// infinite where a line, or one beside it, is singular.
fn motion<const N: usize>(
    group: &Group,
    number: usize,
    levels: Levels,
    (entries, unknowns): (&[Place], &[f64]),
) -> Vec<f64> {
    let block = &group.blocks[number];
    let motions = FreeMotions::of(group, number);
    let terms = || motions.iter().flat_map(|motion| &motion.covariance);
    let mut acting: Vec<usize> = terms().map(|&(source, _)| source).collect();
    acting.sort_unstable();
    acting.dedup();
    let mut variances = vec![Reals::ZERO; group.sources.len()];
    let mut strip = Strip::<N>::new(block);
    let mut sizes = Vec::with_capacity(block.lines());
    for first in (0..block.lines()).step_by(LANES) {
        let end = block.lines().min(first + LANES);
        let Some(shares) = strip
            .couple(first, entries, unknowns)
            .map(|coupled| Shares::of(block, &coupled))
        else {
            sizes.resize(end, f64::INFINITY);
            continue;
        };
        for &source in &acting {
            let source_of = &group.sources[source];
            let places = strip.index.map(|line| source_of.place(line));
            variances[source] = source_variance_of_lanes(source_of, levels, (strip.index, places));
        }
        let mut power = Reals::ZERO;
        for motion in &motions {
            let mut covariance = Reals::ZERO;
            for &(source, share) in &motion.covariance {
                covariance += variances[source] * Reals::all(share);
            }
            power += covariance * shares.product(motion.one, motion.other);
        }
        sizes.extend(&power.sqrt().lanes()[..end - first]);
    }
    sizes
}

/// Of A = (I + F K*)⁻¹ E K* with ones at (i, j) of E: ⟨A_ij, A_kl⟩ = P_ik R_jl, at lines side by side.
struct Shares<const N: usize> {
    left: Small<N, Complexes>,
    right: Small<N, Complexes>,
}

impl<const N: usize> Shares<N> {
    fn of(block: &Block, coupled: &Coupled<N>) -> Self {
        let dofs = filled::<N>(block.dofs);
        let Coupled { inverse, stiffness } = coupled;
        let mut left = [[Complexes::ZERO; N]; N];
        let mut right = [[Complexes::ZERO; N]; N];
        for (a, &scale) in block.dynamic_stiffness.iter().enumerate() {
            let (by, compliance) = (Reals::all(scale), Reals::all(scale.recip()));
            for i in 0..dofs {
                for k in 0..dofs {
                    left[i][k] += inverse[a][i].conj_times(inverse[a][k]).scaled(by);
                    right[i][k] += stiffness[i][a]
                        .conj_times(stiffness[k][a])
                        .scaled(compliance);
                }
            }
        }
        Self { left, right }
    }

    fn pair(&self, (i, j): (usize, usize), (k, l): (usize, usize)) -> Reals {
        (self.left[i][k] * self.right[j][l]).re
    }

    /// ⟨A, A⟩ of two entries of F, each with its transpose.
    fn product(&self, one: (usize, usize), other: (usize, usize)) -> Reals {
        let turned = |(i, j): (usize, usize)| (j, i);
        let mut sum = self.pair(one, other);
        if one.0 != one.1 {
            sum += self.pair(turned(one), other);
        }
        if other.0 != other.1 {
            sum += self.pair(one, turned(other));
            if one.0 != one.1 {
                sum += self.pair(turned(one), turned(other));
            }
        }
        sum
    }
}
