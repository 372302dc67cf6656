//! Independent pieces of work on all processors, in a result that does not depend on how many there are.

use std::cell::Cell;
use std::ops::Range;
use std::sync::Mutex;

use rayon::prelude::*;

/// Pieces of at most `length` indices, of all below `count`.
pub fn pieces(count: usize, length: usize) -> Vec<Range<usize>> {
    let starts = (0..count).step_by(length);
    starts
        .map(|start| start..count.min(start + length))
        .collect()
}

/// `work` of each item, in the order of the items.
pub fn map<T: Sync, R: Send>(items: &[T], work: impl Fn(&T) -> R + Sync) -> Vec<R> {
    by_index(items.len(), &|index| work(&items[index]))
}

/// The same with items that are handed over.
pub fn map_each<T: Send, R: Send>(items: Vec<T>, work: impl Fn(T) -> R + Sync) -> Vec<R> {
    let items: Vec<Mutex<Option<T>>> = items
        .into_iter()
        .map(|item| Mutex::new(Some(item)))
        .collect();
    let of_item = |index: usize| {
        let item = items[index].lock().ok().and_then(|mut item| item.take());
        item.map(&work)
    };
    let results = by_index(items.len(), &of_item);
    results.into_iter().flatten().collect()
}

/// `work` of each index below `count`, in order. Callers differ in their work and their results, not in how these are
/// shared out: that is compiled once, and each piece of work once, instead of into a copy of the scheduler's own.
fn by_index<R: Send>(count: usize, work: &(dyn Fn(usize) -> R + Sync)) -> Vec<R> {
    if is_alone(count) {
        return (0..count).map(work).collect();
    }
    let results: Vec<Mutex<Option<R>>> = (0..count).map(|_| Mutex::new(None)).collect();
    share(count, &|index| {
        let result = work(index);
        if let Ok(mut place) = results[index].lock() {
            *place = Some(result);
        }
    });
    let results = results.into_iter();
    results
        .filter_map(|place| place.into_inner().ok().flatten())
        .collect()
}

/// Does `work` of each index below `count` on all processors, one index at a time.
fn share(count: usize, work: &(dyn Fn(usize) + Sync)) {
    let pieces = (0..count).into_par_iter().with_max_len(1);
    pieces.for_each(|index| as_piece(|| work(index)));
}

/// Does work that has parts to share out as one of the processors that these are shared among: one that waited for them from
/// outside would have to be woken after each.
pub fn among_them<R: Send>(work: impl FnOnce() -> R + Send) -> R {
    if IS_IN_PIECE.get() {
        return work();
    }
    let work = bolted_joint_wanted::handed_on(work);
    rayon::scope(|_| work())
}

/// What two pieces of work come to, the other being done by a processor that the first one, which has parts to share out, leaves
/// idle.
pub fn beside<A: Send, B: Send>(
    one: impl FnOnce() -> A + Send,
    other: impl FnOnce() -> B + Send,
) -> (A, B) {
    if is_alone(2) {
        return (one(), other());
    }
    rayon::join(one, || as_piece(other))
}

thread_local! {
    static IS_IN_PIECE: Cell<bool> = const { Cell::new(false) };
}

/// Does a piece of shared work.
fn as_piece<R>(work: impl FnOnce() -> R) -> R {
    bolted_joint_wanted::look();
    let before = IS_IN_PIECE.replace(true);
    let result = work();
    IS_IN_PIECE.set(before);
    result
}

/// Whether there is nothing to share: within a piece of shared work all processors are busy with the others, and one that
/// waited for its parts would begin more of the others before it ends.
fn is_alone(pieces: usize) -> bool {
    pieces < 2 || IS_IN_PIECE.get()
}

#[cfg(test)]
mod tests {
    use super::{among_them, is_alone, map, map_each};

    #[test]
    fn what_is_shared_out_is_not_shared_out_again() {
        let alone = || map(&[0, 1, 2], |_| is_alone(2));
        assert!(!is_alone(2));
        assert_eq!(alone(), [true; 3]);
        assert_eq!(
            among_them(|| (is_alone(2), alone())),
            (false, vec![true; 3])
        );
        assert_eq!(map(&[0, 1], |_| among_them(alone)), [[true; 3]; 2]);
    }

    #[test]
    fn results_come_in_the_order_of_their_items() {
        let items: Vec<u64> = (0..1000).collect();
        let squares: Vec<u64> = items.iter().map(|item| item * item).collect();
        assert_eq!(map(&items, |item| item * item), squares);
        assert_eq!(map(&items[..0], |item| item * item), Vec::<u64>::new());
        assert_eq!(map_each(items, |item| item * item), squares);
    }
}
