//! Lines whose entries all have errors of their own, as where no measured substructure has: they need no corrections and no
//! covariance matrix, so several of them are computed side by side.

use std::ops::Range;

use num_complex::Complex64;

use super::block::Block;
use super::group::Group;
use super::kernel::for_dofs;
use super::lanes::{LANES, Reals};
use super::layout::Place;
use super::noise::{Levels, Size};
use super::normal::Normal;
use super::objective::Weights;
use super::parallel;
use super::strip::{
    ENTRIES_OF_FOUR, ENTRIES_OF_ONE, InCommon, MOST_ENTRIES, Strip, Sums, Vector, are_of_one,
    for_strips,
};
use super::weights::of_one;

/// Lines that one processor takes at a time. Sums are formed piece by piece, so that they do not depend on how many
/// processors there are.
pub(super) const PIECE: usize = 1024;

/// Adds all lines of `group` to the normal equations, with variances that are held.
pub(super) fn accumulate(
    group: &Group,
    entries: &[Place],
    unknowns: &[f64],
    weights: &Weights,
    normal: &mut Normal,
) -> Option<()> {
    let accumulate: Option<Accumulate> = for_strips!(group.dofs(), entries, accumulate_rows);
    accumulate?(group, entries, unknowns, weights, normal)
}

type Accumulate = fn(&Group, &[Place], &[f64], &Weights, &mut Normal) -> Option<()>;

fn accumulate_rows<const N: usize, const E: usize>(
    group: &Group,
    entries: &[Place],
    unknowns: &[f64],
    weights: &Weights,
    normal: &mut Normal,
) -> Option<()> {
    let size = group.entries();
    let mut at = 0;
    for block in &group.blocks {
        let own = block.unknowns(entries);
        let unknowns = &unknowns[own.clone()];
        let pieces: Vec<usize> = (0..block.lines()).step_by(PIECE).collect();
        let sums = parallel::map(&pieces, |&first| {
            let mut sums = Sums::<E>::new();
            let mut strip = Strip::<N>::new(block);
            let mut rows = vec![(Vector::NONE, InCommon::NONE); block.points];
            let end = block.lines().min(first + PIECE);
            for line in (first..end).step_by(LANES) {
                strip.solve(line, entries, unknowns)?;
                let strip = &strip;
                sums.add_strip(strip, entries, &mut rows, |e, _| {
                    let place = |lane: usize| strip.index[lane] * size + at + e;
                    Reals::of(|lane| weights.entries[place(lane)]).reciprocal()
                });
            }
            Some(sums)
        });
        for sums in sums {
            sums?.add_to::<N>(normal, entries, own.start);
        }
        at += block.entries.len();
    }
    Some(())
}

/// The same with variances from the computed receptances, which it returns; `None` also where one is not a number above zero.
pub(super) fn renew(
    group: &Group,
    entries: &[Place],
    unknowns: &[f64],
    levels: Levels,
    normal: &mut Normal,
) -> Option<Weights> {
    let renew: Option<Renew> = for_strips!(group.dofs(), entries, renew_rows);
    renew?(group, entries, unknowns, levels, normal)
}

type Renew = fn(&Group, &[Place], &[f64], Levels, &mut Normal) -> Option<Weights>;

fn renew_rows<const N: usize, const E: usize>(
    group: &Group,
    entries: &[Place],
    unknowns: &[f64],
    levels: Levels,
    normal: &mut Normal,
) -> Option<Weights> {
    let size = group.entries();
    let mut weights = Weights {
        entries: vec![0.0; size * group.lines()],
        levels,
        scatter: 0.0,
    };
    let mut at = 0;
    for block in &group.blocks {
        let own = block.unknowns(entries);
        let unknowns = &unknowns[own.clone()];
        let pieces: Vec<(usize, &mut [f64])> = weights
            .entries
            .chunks_mut(size * PIECE)
            .enumerate()
            .map(|(piece, variances)| (piece * PIECE, variances))
            .collect();
        let counts: Vec<f64> = block
            .entries
            .iter()
            .map(|entry| f64::from(entry.count))
            .collect();
        let sums = parallel::map_each(pieces, |(first, variances)| {
            let mut sums = Sums::<E>::new();
            let mut strip = Strip::<N>::new(block);
            let mut rows = vec![(Vector::NONE, InCommon::NONE); block.points];
            let mut scatter = Reals::ZERO;
            let mut sum = Reals::ZERO;
            for (number, variances) in variances.chunks_mut(size * LANES).enumerate() {
                strip.solve(first + number * LANES, entries, unknowns)?;
                let strip = &strip;
                sums.add_strip(strip, entries, &mut rows, |e, power| {
                    let variance = variance(strip, e, levels.assembly, power);
                    sum += variance;
                    let one = variance.reciprocal();
                    if counts[e] > 1.0 {
                        scatter += strip.real(&block.scatter, e) * strip.used * one;
                    }
                    let of_mean = variance * Reals::all(counts[e].recip());
                    let places = variances[at + e..].iter_mut().step_by(size);
                    for (place, of_mean) in places.zip(of_mean.lanes()) {
                        *place = of_mean;
                    }
                    one * Reals::all(counts[e])
                });
            }
            // A variance of zero makes the cost infinite, which is seen there.
            sum.sum().is_finite().then(|| (sums, scatter.sum()))
        });
        for sums in sums {
            let (sums, scatter) = sums?;
            sums.add_to::<N>(normal, entries, own.start);
            weights.scatter += scatter;
        }
        at += block.entries.len();
    }
    Some(weights)
}

/// H^C of one assembly at some of its lines, line by line and entry by entry.
pub(super) fn computed(
    block: &Block,
    entries: &[Place],
    unknowns: &[f64],
    lines: Range<usize>,
) -> Option<Vec<Complex64>> {
    let compute: Option<Compute> = for_dofs!(block.dofs, compute);
    compute?(block, entries, unknowns, lines)
}

type Compute = fn(&Block, &[Place], &[f64], Range<usize>) -> Option<Vec<Complex64>>;

fn compute<const N: usize>(
    block: &Block,
    entries: &[Place],
    unknowns: &[f64],
    lines: Range<usize>,
) -> Option<Vec<Complex64>> {
    let count = block.entries.len();
    let unknowns = unknowns.get(block.unknowns(entries))?;
    let mut computed = vec![Complex64::ZERO; count * lines.len()];
    let mut strip = Strip::<N>::new(block);
    for (number, values) in computed.chunks_mut(count * LANES).enumerate() {
        strip.solve(lines.start + number * LANES, entries, unknowns)?;
        for (e, &entry) in block.entries.iter().enumerate() {
            let value = strip.computed(e, entry);
            for (lane, values) in values.chunks_exact_mut(count).enumerate() {
                values[e] = value.lane(lane);
            }
        }
    }
    Some(computed)
}

/// Variance of one measurement of an entry, whose computed |H^C|² is `power`.
#[inline]
fn variance<const N: usize>(strip: &Strip<'_, N>, e: usize, level: Size, power: Reals) -> Reals {
    let floor = strip.block.entries[e].floor;
    if strip.block.known.is_empty() {
        return Reals::of(|lane| of_one(level, floor, None, power.lane(lane)));
    }
    let known = strip.real(&strip.block.known, e);
    Reals::of(|lane| of_one(level, floor, Some(known.lane(lane)), power.lane(lane)))
}
