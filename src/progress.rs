//! A progress line on stderr for work that takes more than a second.

use std::io::{self, IsTerminal as _, Write as _};
use std::path::Path;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use bolted_joint::identify::Watch;

/// From so many bytes on a size is given in MB.
const LARGE: u64 = 10_000_000;
/// Work shorter than this needs no line.
const PATIENCE: Duration = Duration::from_secs(1);
const BETWEEN_LINES: Duration = Duration::from_millis(100);
/// Characters of the bar, and of the longest line.
const BAR: usize = 30;
const LINE: usize = 78;
/// Characters of a file's name, so that the line is none too long.
const NAME: usize = 14;

/// Says on a terminal, from the second second on, how long the work has taken and how many pieces of it are done, or how much
/// of a file has been read.
pub(super) struct Progress {
    state: Arc<State>,
    writer: Option<JoinHandle<()>>,
}

struct State {
    work: &'static str,
    total: usize,
    done: AtomicUsize,
    reading: Mutex<Option<Reading>>,
    has_ended: AtomicBool,
    begun: Instant,
}

/// How much of a file has been read, bytes.
struct Reading {
    name: String,
    bytes: u64,
    of: u64,
}

impl Progress {
    /// Begins `work`, which has `total` pieces that can be counted, or none.
    pub(super) fn new(work: &'static str, total: usize) -> Self {
        let state = Arc::new(State {
            work,
            total,
            done: AtomicUsize::new(0),
            reading: Mutex::new(None),
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

impl Watch for Progress {
    fn read(&self, path: &Path, bytes: u64, of: u64) {
        let mut reading = self
            .state
            .reading
            .lock()
            .unwrap_or_else(PoisonError::into_inner);
        match &mut *reading {
            _ if bytes >= of => *reading = None,
            Some(reading) => (reading.bytes, reading.of) = (bytes, of),
            None => {
                let name = path.file_name().unwrap_or(path.as_os_str());
                let name = shortened(&name.to_string_lossy());
                *reading = Some(Reading { name, bytes, of });
            }
        }
    }

    fn drawn(&self) {
        self.advance();
    }
}

/// The end of a long name tells files apart.
fn shortened(name: &str) -> String {
    let name: Vec<char> = name.chars().filter(|c| !c.is_control()).collect();
    match name.len() {
        0..=NAME => name.into_iter().collect(),
        length => std::iter::once('…')
            .chain(name.into_iter().skip(length + 1 - NAME))
            .collect(),
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
        let reading = self.reading.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(Reading { name, bytes, of }) = &*reading {
            let bar = bar(*bytes, *of);
            let (bytes, of, unit) = match of {
                0..LARGE => (bytes / 1000, of / 1000, "kB"),
                _ => (bytes / 1_000_000, of / 1_000_000, "MB"),
            };
            return format!("{bar} {bytes} of {of} {unit} of {name}, {seconds} s");
        }
        let done = self.done.load(Ordering::Relaxed).min(self.total);
        if done == 0 {
            return format!("{} … {seconds} s", self.work);
        }
        let bar = bar(done as u64, self.total as u64);
        format!("{bar} {done} of {}, {seconds} s", self.total)
    }
}

fn bar(done: u64, total: u64) -> String {
    let share = done as f64 / total.max(1) as f64;
    let filled = ((BAR as f64 * share) as usize).min(BAR);
    let (full, empty) = ("#".repeat(filled), "-".repeat(BAR - filled));
    format!("[{full}{empty}]")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reading_comes_before_pieces_and_fits_the_line() {
        let progress = Progress::new("identifying", 40);
        let line = || progress.state.line(Duration::from_millis(2900));
        progress.advance();
        progress.read(Path::new("/data/c.uff"), 250_000_000, 1_000_000_000);
        assert_eq!(
            line(),
            "[#######-----------------------] 250 of 1000 MB of c.uff, 2 s"
        );
        progress.read(Path::new("/data/c.uff"), 1_000_000_000, 1_000_000_000);
        assert_eq!(line(), "[------------------------------] 1 of 40, 2 s");
        let name = "a measurement with a long name, second day.csv";
        progress.read(Path::new(name), 999_999, 9_999_999);
        assert_eq!(
            line(),
            "[##----------------------------] 999 of 9999 kB of …econd day.csv, 2 s"
        );
        progress.read(Path::new(name), 98_999_999_999, 99_999_999_999);
        assert!(line().chars().count() <= LINE);
    }

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
