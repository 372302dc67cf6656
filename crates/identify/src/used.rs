//! Which lines an estimate can use whose substructures have errors.
//!
//! Where H_jj + H_kk errs by ΔF, Q = (I + F K*)⁻¹ H_ks becomes (I + A)⁻¹ Q with A = (I + F K*)⁻¹ ΔF K*. At a sharp resonance of
//! the assembly A is large, and no linear model holds. How large it is expected to be follows from the variances and the joint
//! alone, never from the residual: leaving such lines out biases nothing.

use nalgebra::DVector;
use num_complex::Complex64;

use super::block::Block;
use super::group::{Group, Source};
use super::kernel::{Small, complex_stiffness, coupled, filled, for_dofs, matrix, product};
use super::layout::Place;
use super::noise::Levels;
use super::objective::Objective;
use super::weights::source_variance;

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
    /// The first so many lines.
    pub(super) fn every(lines: usize) -> Self {
        Self {
            lines: (0..lines).collect(),
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
    let sources = || {
        group.sources.iter().filter_map(|source| {
            let pattern = source.patterns[number].as_ref()?;
            (!pattern.entries_of_free.is_empty()).then_some((source, pattern))
        })
    };
    let real = |value: f64| Complex64::from(value);
    let patterns: Vec<(&Source, Small<N>)> = sources()
        .map(|(source, pattern)| {
            (
                source,
                matrix(dofs, |i, j| real(pattern.free[i * dofs + j])),
            )
        })
        .collect();
    let scale = &block.dynamic_stiffness;
    let of_line = |line: usize| {
        let stiffness = complex_stiffness::<N>(entries, unknowns, block.omega[line]);
        let free = block.free_at(line);
        let free = matrix(dofs, |i, j| free[i * dofs + j]);
        let Some(inverse) = coupled(dofs, &free, &stiffness) else {
            return f64::INFINITY;
        };
        let mut power = 0.0;
        for (source, free) in &patterns {
            let variance = source_variance(source, levels, line);
            let a = product(dofs, &product(dofs, &inverse, free), &stiffness);
            for i in 0..dofs {
                for j in 0..dofs {
                    power += variance * scale[i] / scale[j] * a[i][j].norm_sqr();
                }
            }
        }
        power.sqrt()
    };
    (0..block.lines()).map(of_line).collect()
}
