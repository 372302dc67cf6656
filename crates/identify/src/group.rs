//! Assemblies that share measured substructures, with the measured receptances whose errors they have in common.

use std::sync::Arc;

use num_complex::Complex64;

use super::block::Block;
use super::lines::Lines;
use super::motions::Motions;
use super::noise::{Floor, Noise, Of};
use super::receptances::MeasuredSubstructure;
use super::used::Chosen;

/// Which substructure a measured receptance belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Side {
    A,
    B,
}

impl Side {
    fn of(self, lines: &Lines) -> Option<&Arc<MeasuredSubstructure>> {
        match self {
            Self::A => lines.a.measured(),
            Self::B => lines.b.measured(),
        }
    }
}

/// How a measured receptance enters F = H_jj + H_kk, H_ks and H_ss of one assembly.
#[derive(Clone, Debug)]
pub(super) struct Pattern {
    /// Row by row.
    pub(super) free: Vec<f64>,
    /// A column for each point; empty if it does not enter.
    pub(super) transfer: Vec<f64>,
    /// For each entry; empty if it does not enter.
    pub(super) own: Vec<f64>,
}

/// A measured receptance of a substructure with an error of its own.
#[derive(Clone, Debug)]
pub(super) struct Source {
    pub(super) side: Side,
    /// Independent measurements that its value is the mean of.
    pub(super) count: u32,
    /// Floor of the noise of one measurement.
    pub(super) floor: Floor,
    /// The value at each line that was measured …
    pub(super) value: Arc<Vec<Complex64>>,
    /// … and which of them are used; `None` if all are.
    pub(super) used: Option<Arc<Vec<usize>>>,
    /// Variance of one measurement as a fraction of |H|² at each line; empty where it follows from a level.
    pub(super) known: Vec<f64>,
    /// For each block of the group, whether and how it enters.
    pub(super) patterns: Vec<Option<Pattern>>,
}

impl Source {
    /// Where the value at a line that is used stands.
    pub(super) fn place(&self, line: usize) -> usize {
        self.used.as_ref().map_or(line, |used| used[line])
    }

    /// Whether the values of both stand at the same places.
    pub(super) fn has_places_of(&self, other: &Self) -> bool {
        match (&self.used, &other.used) {
            (None, None) => true,
            (Some(one), Some(other)) => Arc::ptr_eq(one, other),
            _ => false,
        }
    }

    /// The value at a line that is used.
    pub(super) fn value_at(&self, line: usize) -> Complex64 {
        self.value[self.place(line)]
    }
}

/// Assemblies whose errors are not independent of each other, line by line: they share a measured substructure.
#[derive(Clone, Debug, Default)]
pub(super) struct Group {
    /// Number of each block's assembly among all.
    pub(super) assemblies: Vec<usize>,
    pub(super) blocks: Vec<Block>,
    pub(super) sources: Vec<Source>,
    /// What the sources move.
    pub(super) motions: Motions,
}

/// Assemblies of a group with the lines that are taken of them.
type Members<'l> = Vec<(&'l Lines, &'l Chosen)>;

impl Group {
    /// Groups of the assemblies `all`, each with the number of its joint, of which the `chosen` lines are taken; the measured
    /// receptances of substructures that have noise become sources. Assemblies of one group have the same lines chosen.
    pub(super) fn all(all: &[(&Lines, usize)], chosen: &[Chosen], noise: &Noise) -> Vec<Self> {
        let noisy = |side: Side| noise.acts_on(side);
        let mut groups: Vec<(Members<'_>, Self)> = Vec::new();
        for (number, (&(lines, joint), chosen)) in all.iter().zip(chosen).enumerate() {
            let mut joined: (Members<'_>, Self) = Default::default();
            // An assembly may share A with one group and B with another, and so make one of them.
            groups.retain_mut(|(members, group)| {
                let shares = members
                    .iter()
                    .any(|(member, _)| share(member, lines, &noisy));
                if shares {
                    joined.0.append(members);
                    joined.1.assemblies.append(&mut group.assemblies);
                    joined.1.blocks.append(&mut group.blocks);
                }
                !shares
            });
            joined.0.push((lines, chosen));
            joined.1.assemblies.push(number);
            joined
                .1
                .blocks
                .push(Block::new(lines, joint, chosen, noise));
            groups.push(joined);
        }
        groups
            .into_iter()
            .map(|(members, mut group)| {
                group.add_sources(&members, noise);
                group.motions = Motions::of(&group.blocks, &group.sources);
                group
            })
            .collect()
    }

    /// Its assemblies one by one, the substructures taken as measured.
    pub(super) fn with_exact_sources(&self) -> impl Iterator<Item = Self> {
        let all = self.assemblies.iter().zip(&self.blocks);
        all.map(|(&assembly, block)| Self {
            assemblies: vec![assembly],
            blocks: vec![block.clone()],
            sources: Vec::new(),
            motions: Motions::default(),
        })
    }

    fn add_sources(&mut self, members: &Members<'_>, noise: &Noise) {
        let mut seen: Vec<&Arc<MeasuredSubstructure>> = Vec::new();
        for side in [Side::A, Side::B] {
            if !noise.acts_on(side) {
                continue;
            }
            let used = |&(lines, chosen)| Some((side.of(lines)?, chosen));
            for (measured, chosen) in members.iter().filter_map(used) {
                if seen.iter().any(|other| Arc::ptr_eq(other, measured)) {
                    continue;
                }
                seen.push(measured);
                let users: Vec<bool> = members
                    .iter()
                    .map(|(lines, _)| {
                        side.of(lines)
                            .is_some_and(|other| Arc::ptr_eq(other, measured))
                    })
                    .collect();
                self.add_substructure((side, noise), measured, &users, &chosen.lines);
            }
        }
    }

    fn add_substructure(
        &mut self,
        (side, noise): (Side, &Noise),
        measured: &MeasuredSubstructure,
        users: &[bool],
        chosen: &[usize],
    ) {
        let used = (chosen.len() < measured.lines()).then(|| Arc::new(chosen.to_vec()));
        let labels = measured.transformation().ncols();
        for column in 0..labels {
            for row in 0..=column {
                let indices: Vec<usize> = measured
                    .measured()
                    .iter()
                    .enumerate()
                    .filter(|&(_, &(p, q))| (p.min(q), p.max(q)) == (row, column))
                    .map(|(index, _)| index)
                    .collect();
                if indices.is_empty() {
                    continue;
                }
                let value = measured.function(row, column);
                let known = measured.relative_variance().map(|known| {
                    let mean = |line: usize| {
                        let sum: f64 = indices.iter().map(|&index| known[index][line]).sum();
                        sum / indices.len() as f64
                    };
                    chosen.iter().map(|&line| mean(line)).collect()
                });
                let patterns = self.blocks.iter().zip(users).map(|(block, &user)| {
                    user.then(|| pattern(side, measured, (row, column), block))
                });
                let patterns = patterns.collect();
                self.sources.push(Source {
                    side,
                    count: indices.len() as u32,
                    floor: noise.floor(
                        Of::Substructure(side),
                        [row, column].map(|label| measured.is_rotation(label)),
                        || measured.floor(row, column) * (indices.len() as f64).sqrt(),
                    ),
                    value: Arc::clone(value),
                    used: used.clone(),
                    known: known.unwrap_or_default(),
                    patterns,
                });
            }
        }
    }

    pub(super) fn lines(&self) -> usize {
        self.blocks.first().map_or(0, Block::lines)
    }

    /// DOFs of its joints.
    pub(super) fn dofs(&self) -> usize {
        self.blocks.first().map_or(0, |block| block.dofs)
    }

    /// Complex entries of all blocks at one line.
    pub(super) fn entries(&self) -> usize {
        self.blocks.iter().map(|block| block.entries.len()).sum()
    }

    /// Measured complex numbers of the assemblies.
    pub(super) fn measurements(&self) -> usize {
        let of_block = |block: &Block| {
            let counts = block.entries.iter().map(|entry| entry.count as usize);
            block.used_lines() * counts.sum::<usize>()
        };
        self.blocks.iter().map(of_block).sum()
    }
}

fn share(one: &Lines, other: &Lines, noisy: &impl Fn(Side) -> bool) -> bool {
    let same = |side: Side| match (side.of(one), side.of(other)) {
        (Some(one), Some(other)) => noisy(side) && Arc::ptr_eq(one, other),
        _ => false,
    };
    same(Side::A) || same(Side::B)
}

/// dH = W dU Wᵀ for a symmetric entry of U, split into the joint's and the points' part.
fn pattern(
    side: Side,
    measured: &MeasuredSubstructure,
    (p, q): (usize, usize),
    block: &Block,
) -> Pattern {
    let change = |i: usize, j: usize| measured.share((i, j), (p, q));
    let dofs = block.dofs;
    let mut transfer = Vec::new();
    let mut own = Vec::new();
    if side == Side::B {
        let points = dofs..dofs + block.points;
        transfer = points
            .flat_map(|point| (0..dofs).map(move |i| (i, point)))
            .map(|(i, point)| change(i, point))
            .collect();
        own = block
            .entries
            .iter()
            .map(|entry| change(dofs + entry.row, dofs + entry.column))
            .collect();
        for shares in [&mut transfer, &mut own] {
            if shares.iter().all(|&share| share == 0.0) {
                shares.clear();
            }
        }
    }
    let every = (0..dofs).flat_map(|i| (0..dofs).map(move |j| (i, j)));
    let free: Vec<f64> = every.map(|(i, j)| change(i, j)).collect();
    Pattern {
        free,
        transfer,
        own,
    }
}
