//! How far work has come, told to who asked for it.
//!
//! What takes long is deep inside: a search among several, of a model among several. Each says of its own steps how many there are,
//! as far as that is known, and which of them are done. Where nobody listens that costs nothing.

use std::cell::{Cell, RefCell};
use std::sync::Arc;

use crate::look;

thread_local! {
    /// Who is told of this thread's work, and how many steps it is in.
    static LISTENER: RefCell<Option<Arc<dyn Listener>>> = const { RefCell::new(None) };
    static DEPTH: Cell<usize> = const { Cell::new(0) };
}

/// How many pieces a step has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pieces {
    /// Nobody knows.
    Unknown,
    /// So many at most: it ends where more are not needed.
    AtMost(usize),
    /// So many, which take about as long as each other.
    Exactly(usize),
    /// So many, of which each takes about as long as it weighs.
    Weighed {
        /// How many there are.
        count: usize,
        /// What all of them weigh.
        weight: usize,
    },
}

/// Who is told. A step of depth 0 is one of the work, one of depth 1 is within that, and so on.
pub trait Listener: Send + Sync {
    /// A step begins.
    fn begun(&self, depth: usize, name: &'static str, pieces: Pieces);
    /// So many more pieces of it are done, which weigh so much.
    fn done(&self, depth: usize, pieces: usize, weight: usize);
    /// It has ended.
    fn ended(&self, depth: usize);
}

/// Somebody listens to the work of the thread that began this, until it is dropped there.
#[derive(Debug)]
#[must_use = "nobody listens any more once it is dropped"]
pub struct Told(());

/// Tells `listener` of the steps of this thread's work from now on.
pub fn tell(listener: Arc<dyn Listener>) -> Told {
    LISTENER.set(Some(listener));
    Told(())
}

impl Drop for Told {
    fn drop(&mut self) {
        LISTENER.set(None);
    }
}

/// A step of the work, until it is dropped.
#[must_use = "the step ends once it is dropped"]
pub struct Step {
    listener: Option<Arc<dyn Listener>>,
    depth: usize,
}

/// Begins a step of this thread's work.
pub fn step(name: &'static str, pieces: Pieces) -> Step {
    let listener = LISTENER.with_borrow(Clone::clone);
    let depth = DEPTH.get();
    if let Some(listener) = &listener {
        listener.begun(depth, name, pieces);
        DEPTH.set(depth + 1);
    }
    Step { listener, depth }
}

impl Step {
    /// One more piece of it is done. May be called from any thread; ends work that nobody wants any more, as [`look`].
    pub fn done(&self) {
        self.are_done(1);
    }

    /// Likewise so many pieces.
    pub fn are_done(&self, pieces: usize) {
        self.tell(pieces, pieces);
    }

    /// Likewise one that weighs so much.
    pub fn done_weighing(&self, weight: usize) {
        self.tell(1, weight);
    }

    fn tell(&self, pieces: usize, weight: usize) {
        look();
        if let Some(listener) = &self.listener {
            listener.done(self.depth, pieces, weight);
        }
    }
}

/// The same work for another thread: its steps are told to who listens to this one, which waits for it.
pub fn handed_on<R>(work: impl FnOnce() -> R) -> impl FnOnce() -> R {
    let listener = LISTENER.with_borrow(Clone::clone);
    let depth = DEPTH.get();
    move || {
        let _before = Before {
            listener: LISTENER.replace(listener),
            depth: DEPTH.replace(depth),
        };
        work()
    }
}

/// What a thread had to do with before.
struct Before {
    listener: Option<Arc<dyn Listener>>,
    depth: usize,
}

impl Drop for Before {
    fn drop(&mut self) {
        LISTENER.set(self.listener.take());
        DEPTH.set(self.depth);
    }
}

impl Drop for Step {
    fn drop(&mut self) {
        if let Some(listener) = &self.listener {
            listener.ended(self.depth);
            DEPTH.set(self.depth);
        }
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Mutex;

    use super::*;

    #[derive(Default)]
    struct Heard(Mutex<Vec<String>>);

    impl Heard {
        fn add(&self, what: String) {
            self.0.lock().unwrap().push(what);
        }

        fn taken(&self) -> Vec<String> {
            std::mem::take(&mut self.0.lock().unwrap())
        }
    }

    impl Listener for Heard {
        fn begun(&self, depth: usize, name: &'static str, pieces: Pieces) {
            self.add(format!("{depth} {name} {pieces:?}"));
        }

        fn done(&self, depth: usize, pieces: usize, weight: usize) {
            self.add(format!("{depth} done {pieces}, {weight}"));
        }

        fn ended(&self, depth: usize) {
            self.add(format!("{depth} ended"));
        }
    }

    #[test]
    fn steps_within_steps_are_told_while_somebody_listens() {
        let heard = Arc::new(Heard::default());
        let told = tell(heard.clone());
        {
            let outer = step("laws", Pieces::Exactly(2));
            {
                let inner = step("searches", Pieces::AtMost(9));
                std::thread::scope(|scope| scope.spawn(|| inner.done()).join().unwrap());
                let work = handed_on(|| step("elsewhere", Pieces::Unknown).are_done(2));
                std::thread::scope(|scope| scope.spawn(work).join().unwrap());
            }
            outer.done_weighing(7);
        }
        drop(step("another", Pieces::Unknown));
        let expected = [
            "0 laws Exactly(2)",
            "1 searches AtMost(9)",
            "1 done 1, 1",
            "2 elsewhere Unknown",
            "2 done 2, 2",
            "2 ended",
            "1 ended",
            "0 done 1, 7",
            "0 ended",
            "0 another Unknown",
            "0 ended",
        ];
        assert_eq!(heard.taken(), expected);
        drop(told);
        step("nobody hears it", Pieces::Unknown).done();
        assert!(heard.taken().is_empty());
    }

    #[test]
    fn steps_that_are_left_by_unwinding_have_ended() {
        let heard = Arc::new(Heard::default());
        let _told = tell(heard.clone());
        let left = std::panic::catch_unwind(|| {
            let _step = step("laws", Pieces::Unknown);
            std::panic::resume_unwind(Box::new(()));
        });
        assert!(left.is_err());
        assert_eq!(heard.taken(), ["0 laws Unknown", "0 ended"]);
        drop(step("next", Pieces::Unknown));
        assert_eq!(heard.taken()[0], "0 next Unknown");
    }
}
