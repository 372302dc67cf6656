//! Work on many lines on all processors, with sums that do not depend on how many there are.

use std::ops::Range;

use rayon::prelude::*;

/// Lines of one piece of work, …
const LENGTH: usize = 16;
/// … and where every line takes long, or there are no more than these.
const FEW: usize = 4;
const FEW_LINES: usize = 64;

/// Work on pieces of consecutive lines; the results in their order.
pub(crate) fn over_lines<T: Send, E: Send>(
    lines: usize,
    work: impl Fn(Range<usize>) -> Result<T, E> + Sync,
) -> Result<Vec<T>, E> {
    let length = if lines > FEW_LINES { LENGTH } else { FEW };
    in_pieces(lines, length, work)
}

/// Likewise, where every line takes long.
pub(crate) fn over_few_lines<T: Send, E: Send>(
    lines: usize,
    work: impl Fn(Range<usize>) -> Result<T, E> + Sync,
) -> Result<Vec<T>, E> {
    in_pieces(lines, FEW, work)
}

/// Work on one after the other of a few things that take long; the results in their order.
pub(crate) fn over_each<'a, T: Sync, R: Send>(
    all: &'a [T],
    work: impl Fn(&'a T) -> R + Sync,
) -> Vec<R> {
    all.par_iter().map(&work).collect()
}

fn in_pieces<T: Send, E: Send>(
    lines: usize,
    length: usize,
    work: impl Fn(Range<usize>) -> Result<T, E> + Sync,
) -> Result<Vec<T>, E> {
    bolted_joint_wanted::look();
    let pieces: Vec<Range<usize>> = (0..lines)
        .step_by(length)
        .map(|first| first..lines.min(first + length))
        .collect();
    // all results first: which error is told must not depend on who is faster
    let results: Vec<Result<T, E>> = pieces.into_par_iter().map(&work).collect();
    results.into_iter().collect()
}
