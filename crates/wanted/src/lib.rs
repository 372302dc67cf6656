//! Whether work is still wanted. Who asked for it may give up, as at Ctrl-C in Python: then it ends itself where it next looks, and
//! does not keep the processors from what is asked for next. Who waits for it may be told how far it has come.
#![forbid(unsafe_code)]

mod steps;

use std::any::Any;
use std::cell::RefCell;
use std::io;
use std::panic::{self, AssertUnwindSafe};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

pub use steps::{Listener, Pieces, Step, Told, handed_on, step, tell};

/// As much as the first thread of a process has.
const STACK_BYTES: usize = 8 << 20;

thread_local! {
    /// Of the work that this thread does.
    static GIVEN_UP: RefCell<Option<Arc<AtomicBool>>> = const { RefCell::new(None) };
}

/// Who asks for work, and may give up.
#[derive(Clone, Debug, Default)]
pub struct Asker {
    given_up: Arc<AtomicBool>,
}

/// What ends work that is not wanted any more.
struct NotWanted;

impl Asker {
    /// One who wants the work.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// The work is not wanted any more.
    pub fn give_up(&self) {
        self.given_up.store(true, Ordering::Relaxed);
    }

    /// Does `work` on threads of its own, as many as there are processors: other work does not wait for it, and a process that is
    /// forked misses none. `None` where it ended since nobody wants it.
    ///
    /// # Errors
    /// Where the system gives no threads.
    pub fn ask<T: Send>(&self, work: impl FnOnce() -> T + Send) -> io::Result<Option<T>> {
        let given_up = self.given_up.clone();
        let pool = rayon::ThreadPoolBuilder::new()
            .stack_size(STACK_BYTES)
            .start_handler(move |_| GIVEN_UP.set(Some(given_up.clone())))
            .build()
            .map_err(io::Error::other)?;
        let result = panic::catch_unwind(AssertUnwindSafe(|| pool.install(work)));
        Ok(match result {
            Ok(result) => Some(result),
            Err(why) if why.is::<NotWanted>() => None,
            Err(why) => panic::resume_unwind(why),
        })
    }
}

/// Ends this work by unwinding, without a message, where nobody wants it any more. To be called where work takes long, often
/// enough that nobody waits for it: some times in a second.
pub fn look() {
    let is_given_up = GIVEN_UP.with_borrow(|given_up| {
        let given_up = given_up.as_ref();
        given_up.is_some_and(|given_up| given_up.load(Ordering::Relaxed))
    });
    if is_given_up {
        let why: Box<dyn Any + Send> = Box::new(NotWanted);
        panic::resume_unwind(why);
    }
}

#[cfg(test)]
mod tests {
    use std::sync::mpsc;
    use std::thread;
    use std::time::Duration;

    use super::*;

    #[test]
    fn work_that_is_given_up_ends_in_all_its_threads() {
        let asker = Asker::new();
        let (sender, receiver) = mpsc::channel();
        let for_ever = move || {
            let _ = sender.send(());
            loop {
                look();
                thread::sleep(Duration::from_millis(1));
            }
        };
        let asked = asker.clone();
        let waiting = thread::spawn(move || {
            asked
                .ask(move || rayon::join(for_ever.clone(), for_ever))
                .unwrap()
                .is_none()
        });
        receiver.recv().unwrap();
        asker.give_up();
        assert!(waiting.join().unwrap());
    }

    #[test]
    fn what_is_wanted_is_done_and_told_of() {
        let done = Asker::new().ask(|| {
            look();
            rayon::join(|| 1, || 2)
        });
        assert_eq!(done.unwrap(), Some((1, 2)));
        // outside of any such work
        look();
    }

    #[test]
    #[should_panic(expected = "a mistake")]
    fn a_mistake_is_no_end_that_was_wanted() {
        let _ = Asker::new().ask(|| panic!("a mistake"));
    }
}
