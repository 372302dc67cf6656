//! Through which few motions of the model the many errors of measured substructures act.
//!
//! H^C depends on F = H_jj + H_kk, H_ks and H_ss alone. However many measured receptances û enter these, their errors δ move
//! them as ζ = M δ, whose covariance is Σ_ζ = M Σ_H Mᵀ. Those that have errors in common form a cluster.

use super::block::{Block, Entry};
use super::group::{Pattern, Source};

/// What of one assembly's model an error moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Act {
    /// An entry of F and its transpose.
    Free(usize, usize),
    /// An entry of H_ks: a DOF of the joint and a point.
    Transfer(usize, usize),
    /// An entry of H_ss that was measured.
    Own(usize),
}

impl Act {
    /// Entries of H^C that it moves.
    fn entries(self, block: &Block) -> Vec<usize> {
        let moves = |(number, entry): &(usize, &Entry)| match self {
            Self::Free(..) => true,
            Self::Transfer(_, point) => entry.row == point || entry.column == point,
            Self::Own(own) => own == *number,
        };
        let entries = block.entries.iter().enumerate().filter(moves);
        entries.map(|(number, _)| number).collect()
    }
}

/// How a motion acts on one assembly.
#[derive(Clone, Debug)]
pub(super) struct Action {
    pub(super) block: usize,
    pub(super) act: Act,
    /// Entries of that block that it moves.
    pub(super) entries: Vec<Moved>,
}

/// An entry that a motion moves.
#[derive(Clone, Copy, Debug)]
pub(super) struct Moved {
    /// Its two points.
    pub(super) points: (usize, usize),
    /// Its place among the rows of the cluster.
    pub(super) at: usize,
}

/// Motions that have errors in common.
#[derive(Clone, Debug)]
pub(super) struct Cluster {
    /// The number of its first motion; the others follow.
    pub(super) first: usize,
    /// How each motion acts on the assemblies.
    pub(super) motions: Vec<Vec<Action>>,
    /// Entries of all blocks that it moves, ascending.
    pub(super) rows: Vec<usize>,
    /// Whether these are the first ones of all, without a gap.
    pub(super) is_dense: bool,
    /// Lower triangle of Σ_ζ, row by row: each entry is a sum over sources, with the products of their shares.
    pub(super) covariance: Vec<Vec<(usize, f64)>>,
}

/// Where an entry of a symmetric matrix stands among those of its lower triangle, row by row.
pub(super) fn place(i: usize, j: usize) -> usize {
    let (row, column) = (i.max(j), i.min(j));
    row * (row + 1) / 2 + column
}

/// All motions of a group.
#[derive(Clone, Debug, Default)]
pub(super) struct Motions {
    pub(super) clusters: Vec<Cluster>,
    /// For each motion the sources that make it, with their shares.
    pub(super) shares: Vec<Vec<(usize, f64)>>,
}

/// A motion before it belongs to a cluster.
struct Found {
    /// The sources that make it, with their shares.
    shares: Vec<(usize, f64)>,
    actions: Vec<(usize, Act)>,
}

impl Motions {
    /// Those of the sources of these assemblies.
    pub(super) fn of(blocks: &[Block], sources: &[Source]) -> Self {
        let mut found: Vec<Found> = Vec::new();
        for (number, block) in blocks.iter().enumerate() {
            for act in acts(block) {
                let share = |source: &Source| -> f64 {
                    let pattern = source.patterns[number].as_ref();
                    pattern.map_or(0.0, |pattern| pattern.share(block, act))
                };
                let shares = sources.iter().map(share).enumerate();
                let shares: Vec<(usize, f64)> = shares.filter(|(_, share)| *share != 0.0).collect();
                if shares.is_empty() {
                    continue;
                }
                match found.iter_mut().find(|known| known.shares == shares) {
                    Some(known) => known.actions.push((number, act)),
                    None => found.push(Found {
                        shares,
                        actions: vec![(number, act)],
                    }),
                }
            }
        }
        Self::clustered(blocks, sources.len(), found)
    }

    /// Sources that motions share put these into one cluster.
    fn clustered(blocks: &[Block], sources: usize, found: Vec<Found>) -> Self {
        let mut clusters: Vec<Vec<Found>> = Vec::new();
        let mut of_source: Vec<Option<usize>> = vec![None; sources];
        for motion in found {
            let own = motion.shares.iter().filter_map(|(s, _)| of_source[*s]);
            let mut joined: Vec<usize> = own.collect();
            joined.sort_unstable();
            joined.dedup();
            let into = joined.first().copied().unwrap_or(clusters.len());
            if into == clusters.len() {
                clusters.push(Vec::new());
            }
            for &other in joined.iter().skip(1) {
                let moved = std::mem::take(&mut clusters[other]);
                clusters[into].extend(moved);
            }
            clusters[into].push(motion);
            for motion in &clusters[into] {
                for (s, _) in &motion.shares {
                    of_source[*s] = Some(into);
                }
            }
        }
        let mut all = Self::default();
        for cluster in clusters.into_iter().filter(|cluster| !cluster.is_empty()) {
            let first = all.shares.len();
            all.clusters.push(Cluster::of(blocks, first, &cluster));
            all.shares
                .extend(cluster.into_iter().map(|motion| motion.shares));
        }
        all
    }

    pub(super) fn count(&self) -> usize {
        self.shares.len()
    }
}

impl Cluster {
    fn of(blocks: &[Block], first: usize, motions: &[Found]) -> Self {
        let first_row = |block: usize| -> usize {
            let before = blocks[..block].iter();
            before.map(|block| block.entries.len()).sum()
        };
        let entries = |&(block, act): &(usize, Act)| {
            let first = first_row(block);
            let own = act.entries(&blocks[block]).into_iter();
            own.map(move |entry| first + entry).collect::<Vec<_>>()
        };
        let mut rows: Vec<usize> = motions
            .iter()
            .flat_map(|motion| motion.actions.iter().flat_map(entries))
            .collect();
        rows.sort_unstable();
        rows.dedup();
        let action = |&(block, act): &(usize, Act)| {
            let first = first_row(block);
            let at = |entry: usize| rows.partition_point(|row| *row < first + entry);
            let own = act.entries(&blocks[block]).into_iter();
            Action {
                block,
                act,
                entries: own
                    .map(|entry| {
                        let Entry { row, column, .. } = blocks[block].entries[entry];
                        Moved {
                            points: (row, column),
                            at: at(entry),
                        }
                    })
                    .collect(),
            }
        };
        let pairs = (0..motions.len()).flat_map(|i| (0..=i).map(move |j| (i, j)));
        let covariance = pairs.map(|(i, j)| {
            let of_i = motions[i].shares.iter();
            let both = of_i.filter_map(|&(source, share)| {
                let of_j = &motions[j].shares;
                let other = of_j.iter().find(|(other, _)| *other == source)?;
                Some((source, share * other.1))
            });
            both.collect()
        });
        Self {
            first,
            is_dense: rows.last().is_none_or(|last| last + 1 == rows.len()),
            covariance: covariance.collect(),
            motions: motions
                .iter()
                .map(|motion| motion.actions.iter().map(action).collect())
                .collect(),
            rows,
        }
    }
}

/// Everything of an assembly's model that an error can move.
fn acts(block: &Block) -> impl Iterator<Item = Act> + use<> {
    let (dofs, points, entries) = (block.dofs, block.points, block.entries.len());
    let free = (0..dofs).flat_map(|j| (0..=j).map(move |i| Act::Free(i, j)));
    let transfer = (0..points).flat_map(move |s| (0..dofs).map(move |i| Act::Transfer(i, s)));
    free.chain(transfer).chain((0..entries).map(Act::Own))
}

impl Pattern {
    /// By how much a source with this pattern moves one part of the model.
    fn share(&self, block: &Block, act: Act) -> f64 {
        let of = |values: &[f64], at: usize| values.get(at).copied().unwrap_or(0.0);
        match act {
            Act::Free(i, j) => of(&self.free, i * block.dofs + j),
            Act::Transfer(i, point) => of(&self.transfer, point * block.dofs + i),
            Act::Own(entry) => of(&self.own, entry),
        }
    }
}
