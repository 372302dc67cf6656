//! Which lines an estimate can use whose substructures have errors.
//!
//! Where H_jj + H_kk errs by ΔF, Q = (I + F K*)⁻¹ H_ks becomes (I + A)⁻¹ Q with A = (I + F K*)⁻¹ ΔF K*. At a sharp resonance of
//! the assembly A is large, and no linear model holds. How large it is expected to be follows from the variances and the joint
//! alone, never from the residual: leaving such lines out biases nothing.

use std::ops::Range;

use nalgebra::DVector;
use num_complex::Complex64;

use super::block::Block;
use super::group::Group;
use super::kernel::{complex_stiffness, coupled, filled, for_dofs, matrix};
use super::layout::Place;
use super::motions::{Act, place};
use super::noise::Levels;
use super::objective::Objective;
use super::weights::source_variance;

/// A line is left out where A is expected to be larger than this …
const MOST_MOVED: f64 = 0.5;
/// … unless fewer than this part of the lines would be left, with much noise: then these are used.
const LEAST_PART: f64 = 0.5;

const ZERO: Complex64 = Complex64::new(0.0, 0.0);

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
    let mut sorted = moved.to_vec();
    sorted.sort_by(f64::total_cmp);
    let least = (sorted.len() as f64 * LEAST_PART) as usize;
    let most = sorted
        .get(least)
        .map_or(MOST_MOVED, |least| least.max(MOST_MOVED));
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
/// infinite at a singular line.
fn motion<const N: usize>(
    group: &Group,
    number: usize,
    levels: Levels,
    (entries, unknowns): (&[Place], &[f64]),
) -> Vec<f64> {
    let block = &group.blocks[number];
    let dofs = filled::<N>(block.dofs);
    let motions = FreeMotions::of(group, number);
    let scale = &block.dynamic_stiffness;
    let terms = || motions.iter().flat_map(|motion| &motion.covariance);
    let mut acting: Vec<usize> = terms().map(|&(source, _)| source).collect();
    acting.sort_unstable();
    acting.dedup();
    let mut variances = vec![0.0; group.sources.len()];
    let of_line = |line: usize| {
        let stiffness = complex_stiffness::<N>(entries, unknowns, block.omega[line]);
        let free = block.free_at(line);
        let free = matrix(dofs, |i, j| free[i * dofs + j]);
        let Some(inverse) = coupled(dofs, &free, &stiffness) else {
            return f64::INFINITY;
        };
        // Of A = (I + F K*)⁻¹ E K* with ones at (i, j) of E: ⟨A_ij, A_kl⟩ = P_ik R_jl
        let mut left = [[ZERO; N]; N];
        let mut right = [[ZERO; N]; N];
        for i in 0..dofs {
            for k in 0..dofs {
                for a in 0..dofs {
                    left[i][k] += inverse[a][i].conj() * inverse[a][k] * scale[a];
                    right[i][k] += stiffness[i][a].conj() * stiffness[k][a] / scale[a];
                }
            }
        }
        let pair = |(i, j): (usize, usize), (k, l): (usize, usize)| (left[i][k] * right[j][l]).re;
        let product = |one: (usize, usize), other: (usize, usize)| -> f64 {
            let turned = |(i, j): (usize, usize)| (j, i);
            let mut sum = pair(one, other);
            if one.0 != one.1 {
                sum += pair(turned(one), other);
            }
            if other.0 != other.1 {
                sum += pair(one, turned(other));
                if one.0 != one.1 {
                    sum += pair(turned(one), turned(other));
                }
            }
            sum
        };
        for &source in &acting {
            variances[source] = source_variance(&group.sources[source], levels, line);
        }
        let mut power = 0.0;
        for motion in &motions {
            let terms = motion.covariance.iter();
            let covariance: f64 = terms
                .map(|(source, share)| share * variances[*source])
                .sum();
            power += covariance * product(motion.one, motion.other);
        }
        power.sqrt()
    };
    (0..block.lines()).map(of_line).collect()
}
