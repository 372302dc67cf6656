//! A progress line on stderr for work that takes more than a second.

use std::io::{self, IsTerminal as _, Write as _};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};

/// Counts finished pieces of work, and says so at most ten times a second, on a terminal only.
pub(super) struct Progress {
    total: usize,
    done: AtomicUsize,
    begun: Instant,
    last_tenth: AtomicUsize,
}

impl Progress {
    pub(super) fn new(total: usize) -> Self {
        Self {
            total,
            done: AtomicUsize::new(0),
            begun: Instant::now(),
            last_tenth: AtomicUsize::new(0),
        }
    }

    /// One more piece is done. May be called from any thread.
    pub(super) fn advance(&self) {
        let done = self.done.fetch_add(1, Ordering::Relaxed) + 1;
        let elapsed = self.begun.elapsed();
        let tenth = (elapsed.as_millis() / 100) as usize;
        let is_due = elapsed > Duration::from_secs(1)
            && self.last_tenth.fetch_max(tenth, Ordering::Relaxed) < tenth;
        if is_due && io::stderr().is_terminal() {
            const WIDTH: usize = 30;
            let filled = WIDTH * done / self.total.max(1);
            let (full, empty) = ("#".repeat(filled), "-".repeat(WIDTH - filled));
            let _ = write!(io::stderr(), "\r[{full}{empty}] {done} of {}", self.total);
        }
    }

    /// Takes the line away.
    pub(super) fn finish(&self) {
        if self.last_tenth.load(Ordering::Relaxed) > 0 && io::stderr().is_terminal() {
            let _ = write!(io::stderr(), "\r{:60}\r", "");
        }
    }
}
