//! Independent pieces of work on all processors, in a result that does not depend on how many there are.

use std::cell::Cell;
use std::num::NonZero;
use std::ops::Range;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, OnceLock, PoisonError};
use std::thread;

thread_local! {
    /// Whether this thread shares in work already, all processors being busy with it.
    static SHARES: Cell<bool> = const { Cell::new(false) };
}

/// Pieces of at most `length` indices, of all below `count`.
pub(crate) fn pieces(count: usize, length: usize) -> Vec<Range<usize>> {
    let starts = (0..count).step_by(length);
    starts
        .map(|start| start..count.min(start + length))
        .collect()
}

/// `work` of each item, in the order of the items.
pub(crate) fn map<T: Sync, R: Send>(items: &[T], work: impl Fn(&T) -> R + Sync) -> Vec<R> {
    share(items.len(), |index| items.get(index).map(&work))
}

/// The same with items that are handed over.
pub(crate) fn map_each<T: Send, R: Send>(items: Vec<T>, work: impl Fn(T) -> R + Sync) -> Vec<R> {
    let items: Vec<Mutex<Option<T>>> = items.into_iter().map(|item| Some(item).into()).collect();
    share(items.len(), |index| {
        let mut item = items
            .get(index)?
            .lock()
            .unwrap_or_else(PoisonError::into_inner);
        item.take().map(&work)
    })
}

/// What two pieces of work come to.
pub(crate) fn both<A: Send, B: Send>(
    one: impl FnOnce() -> A + Send,
    other: impl FnOnce() -> B + Send,
) -> (A, B) {
    if SHARES.get() || processors() == 1 {
        return (one(), other());
    }
    thread::scope(|scope| {
        let one = scope.spawn(one);
        let other = other();
        match one.join() {
            Ok(one) => (one, other),
            Err(panic) => std::panic::resume_unwind(panic),
        }
    })
}

/// Processors of this machine; asking the system takes longer than some of the work.
fn processors() -> usize {
    static PROCESSORS: OnceLock<usize> = OnceLock::new();
    *PROCESSORS.get_or_init(|| thread::available_parallelism().map_or(1, NonZero::get))
}

/// What `work` makes of each index below `count`.
fn share<R: Send>(count: usize, work: impl Fn(usize) -> Option<R> + Sync) -> Vec<R> {
    if count < 2 || SHARES.get() || processors() == 1 {
        return (0..count).filter_map(work).collect();
    }
    let next = AtomicUsize::new(0);
    let share = || {
        SHARES.set(true);
        let mut done = Vec::new();
        loop {
            let index = next.fetch_add(1, Ordering::Relaxed);
            if index >= count {
                SHARES.set(false);
                return done;
            }
            done.extend(work(index).map(|result| (index, result)));
        }
    };
    let mut results: Vec<(usize, R)> = thread::scope(|scope| {
        let handles: Vec<_> = (1..processors().min(count))
            .map(|_| scope.spawn(share))
            .collect();
        let mut results = share();
        for handle in handles {
            match handle.join() {
                Ok(done) => results.extend(done),
                Err(panic) => std::panic::resume_unwind(panic),
            }
        }
        results
    });
    results.sort_by_key(|(index, _)| *index);
    results.into_iter().map(|(_, result)| result).collect()
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
