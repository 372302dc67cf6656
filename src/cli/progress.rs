//! A progress line on stderr for work that takes more than a second.

use std::io::{self, IsTerminal as _, Write as _};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

/// Work shorter than this needs no line.
const PATIENCE: Duration = Duration::from_secs(1);
const BETWEEN_LINES: Duration = Duration::from_millis(100);
/// Characters of the bar, and of the longest line.
const BAR: usize = 30;
const LINE: usize = 72;

/// Says on a terminal, from the second second on, how long the work has taken and how many pieces of it are done.
pub(super) struct Progress {
    state: Arc<State>,
    writer: Option<JoinHandle<()>>,
}

struct State {
    work: &'static str,
    total: usize,
    done: AtomicUsize,
    has_ended: AtomicBool,
    begun: Instant,
}

impl Progress {
    /// Begins `work`, which has `total` pieces that can be counted, or none.
    pub(super) fn new(work: &'static str, total: usize) -> Self {
        let state = Arc::new(State {
            work,
            total,
            done: AtomicUsize::new(0),
            has_ended: AtomicBool::new(false),
            begun: Instant::now(),
        });
        let writer = io::stderr().is_terminal().then(|| {
            let state = Arc::clone(&state);
            thread::spawn(move || state.write_lines())
        });
        Self { state, writer }
    }

    /// One more piece is done. May be called from any thread.
    pub(super) fn advance(&self) {
        self.state.done.fetch_add(1, Ordering::Relaxed);
    }
}

/// Takes the line away, however the work ended.
impl Drop for Progress {
    fn drop(&mut self) {
        self.state.has_ended.store(true, Ordering::Relaxed);
        if let Some(writer) = self.writer.take() {
            writer.thread().unpark();
            let _ = writer.join();
        }
    }
}

impl State {
    fn write_lines(&self) {
        let mut has_written = false;
        while !self.has_ended.load(Ordering::Relaxed) {
            let elapsed = self.begun.elapsed();
            if elapsed > PATIENCE {
                let line = self.line(elapsed);
                let _ = write!(io::stderr(), "\r{line:LINE$}");
                has_written = true;
            }
            thread::park_timeout(BETWEEN_LINES);
        }
        if has_written {
            let _ = write!(io::stderr(), "\r{:LINE$}\r", "");
        }
    }

    fn line(&self, elapsed: Duration) -> String {
        let seconds = elapsed.as_secs();
        let done = self.done.load(Ordering::Relaxed).min(self.total);
        if done == 0 {
            return format!("{} … {seconds} s", self.work);
        }
        let filled = BAR * done / self.total.max(1);
        let (full, empty) = ("#".repeat(filled), "-".repeat(BAR - filled));
        format!("[{full}{empty}] {done} of {}, {seconds} s", self.total)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line(done: usize) -> String {
        let progress = Progress::new("identifying", 40);
        (0..done).for_each(|_| progress.advance());
        progress.state.line(Duration::from_millis(2900))
    }

    #[test]
    fn the_line_tells_the_time_until_there_are_pieces_to_count() {
        assert_eq!(line(0), "identifying … 2 s");
        assert_eq!(line(10), "[#######-----------------------] 10 of 40, 2 s");
        assert_eq!(line(41), "[##############################] 40 of 40, 2 s");
    }
}
