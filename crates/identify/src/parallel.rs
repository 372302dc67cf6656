//! Independent pieces of work on all processors, in a result that does not depend on how many there are.

use std::ops::Range;

use rayon::prelude::*;

/// Pieces of at most `length` indices, of all below `count`.
pub fn pieces(count: usize, length: usize) -> Vec<Range<usize>> {
    let starts = (0..count).step_by(length);
    starts
        .map(|start| start..count.min(start + length))
        .collect()
}

/// `work` of each item, in the order of the items.
pub fn map<T: Sync, R: Send>(items: &[T], work: impl Fn(&T) -> R + Send + Sync) -> Vec<R> {
    if is_alone(items.len()) {
        return items.iter().map(work).collect();
    }
    items.par_iter().with_max_len(1).map(work).collect()
}

/// The same with items that are handed over.
pub fn map_each<T: Send, R: Send>(items: Vec<T>, work: impl Fn(T) -> R + Send + Sync) -> Vec<R> {
    if is_alone(items.len()) {
        return items.into_iter().map(work).collect();
    }
    items.into_par_iter().with_max_len(1).map(work).collect()
}

/// What two pieces of work come to.
pub fn both<A: Send, B: Send>(
    one: impl FnOnce() -> A + Send,
    other: impl FnOnce() -> B + Send,
) -> (A, B) {
    if is_alone(2) {
        return (one(), other());
    }
    rayon::join(one, other)
}

/// Whether there is nothing to share: within a piece of shared work all processors are busy with the others, and one that
/// waited for its parts would begin more of the others before it ends.
fn is_alone(pieces: usize) -> bool {
    pieces < 2 || rayon::current_thread_index().is_some()
}

#[cfg(test)]
mod tests {
    use super::{map, map_each};

    #[test]
    fn results_come_in_the_order_of_their_items() {
        let items: Vec<u64> = (0..1000).collect();
        let squares: Vec<u64> = items.iter().map(|item| item * item).collect();
        assert_eq!(map(&items, |item| item * item), squares);
        assert_eq!(map(&items[..0], |item| item * item), Vec::<u64>::new());
        assert_eq!(map_each(items, |item| item * item), squares);
    }
}
