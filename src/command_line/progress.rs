//! Progress on stderr for work that takes more than a second: how much is done and how long the rest takes, on a terminal only.

mod steps;

use std::fmt;
use std::io::{self, IsTerminal as _};
use std::path::Path;
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use bolted_joint_wanted::Told;
use indicatif::{MultiProgress, ProgressBar, ProgressDrawTarget, ProgressState, ProgressStyle};

use self::steps::Steps;
use bolted_joint::identify::Watch;

/// Work shorter than this shows nothing.
const PATIENCE: Duration = Duration::from_secs(1);
const BETWEEN_LINES: Duration = Duration::from_millis(100);
/// Characters of a file's name, so that a bar has room beside it.
const NAME: usize = 14;
/// Steps of a bar whose work is not counted in pieces.
const FINE: u32 = 1000;

const WAITING: &str = "{msg} … {elapsed}{steps}";
const COUNTING: &str = "{msg} [{wide_bar}] {pos} of {len}, {eta} left";
const SHARE: &str = "{msg} [{wide_bar}] {percent} %, {eta} left";
const READING: &str = "{msg} [{wide_bar}] {decimal_bytes} of {decimal_total_bytes}, {eta} left";

/// Says, from the second second on, how long the work has taken or how much of it is done, which steps it is in, and how much of a
/// file has been read. However the work ends, the lines go away.
pub(super) struct Progress {
    lines: MultiProgress,
    work: ProgressBar,
    /// How the work is shown once some of it is done.
    known: &'static str,
    reading: Mutex<Option<ProgressBar>>,
    /// Steps of the work of the thread that began this.
    _told: Option<Told>,
}

impl Progress {
    /// Begins `work`, which has `total` pieces that can be counted, or none.
    pub(super) fn new(work: &'static str, total: usize) -> Self {
        Self::begin(work, total as u64, COUNTING)
    }

    /// Begins `work` that tells which part of it is done.
    pub(super) fn of_share(work: &'static str) -> Self {
        Self::begin(work, FINE.into(), SHARE)
    }

    fn begin(work: &'static str, total: u64, known: &'static str) -> Self {
        let lines = MultiProgress::with_draw_target(ProgressDrawTarget::hidden());
        let bar = line(&lines, total, WAITING, work.to_owned());
        let mut told = None;
        if io::stderr().is_terminal() {
            let steps = Arc::new(Steps::default());
            bar.set_style(with_steps(Arc::clone(&steps)));
            told = Some(bolted_joint_wanted::tell(steps));
            bar.enable_steady_tick(BETWEEN_LINES);
            let (lines, bar) = (lines.clone(), bar.downgrade());
            thread::spawn(move || {
                thread::sleep(PATIENCE);
                if bar.upgrade().is_some() {
                    lines.set_draw_target(ProgressDrawTarget::stderr());
                }
            });
        }
        Self {
            lines,
            work: bar,
            known,
            reading: Mutex::new(None),
            _told: told,
        }
    }

    /// One more piece is done. May be called from any thread.
    pub(super) fn advance(&self) {
        bolted_joint_wanted::look();
        self.has_begun();
        self.work.inc(1);
    }

    /// This part of the work is done, from 0 to 1.
    pub(super) fn reached(&self, share: f64) {
        bolted_joint_wanted::look();
        self.has_begun();
        self.work.set_position((share * f64::from(FINE)) as u64);
    }

    /// What came before the first piece says nothing of how long the others take.
    fn has_begun(&self) {
        if self.work.position() == 0 {
            self.work.set_style(style(self.known));
            self.work.reset_eta();
        }
    }
}

/// Does work of which nothing is counted, beside a line that says how long it has taken.
pub(super) fn watched<T>(work: &'static str, result: impl FnOnce() -> T) -> T {
    let progress = Progress::new(work, 0);
    let result = result();
    drop(progress);
    result
}

impl Watch for Progress {
    fn read(&self, path: &Path, bytes: u64, of: u64) {
        let mut reading = self.reading.lock().unwrap_or_else(PoisonError::into_inner);
        if bytes >= of {
            if let Some(done) = reading.take() {
                self.lines.remove(&done);
            }
            return;
        }
        let bar = reading.get_or_insert_with(|| {
            let name = path.file_name().unwrap_or(path.as_os_str());
            line(&self.lines, of, READING, shortened(&name.to_string_lossy()))
        });
        bar.set_position(bytes);
    }

    fn drawn(&self) {
        self.advance();
    }
}

fn line(lines: &MultiProgress, total: u64, template: &str, text: String) -> ProgressBar {
    let bar = ProgressBar::with_draw_target(Some(total), ProgressDrawTarget::hidden());
    lines.add(bar.with_style(style(template)).with_message(text))
}

fn style(template: &str) -> ProgressStyle {
    ProgressStyle::with_template(template)
        .unwrap_or_else(|_| ProgressStyle::default_bar())
        .progress_chars("#-")
}

/// Before the first piece is done, and of work that is not counted.
fn with_steps(steps: Arc<Steps>) -> ProgressStyle {
    style(WAITING).with_key(
        "steps",
        move |_: &ProgressState, out: &mut dyn fmt::Write| {
            let _ = out.write_str(&steps.words(Instant::now()));
        },
    )
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_bar_fills_the_terminal_and_says_how_long_the_rest_takes() {
        for template in [COUNTING, SHARE, READING] {
            assert!(template.contains("{wide_bar}") && template.ends_with("{eta} left"));
        }
        for template in [WAITING, COUNTING, SHARE, READING] {
            assert!(ProgressStyle::with_template(template).is_ok(), "{template}");
        }
    }

    #[test]
    fn files_come_and_go_beside_the_work() {
        let progress = Progress::new("identifying", 40);
        let name = "a measurement with a long name,\u{7} second day.csv";
        progress.read(Path::new(name), 250, 1000);
        let shown = |progress: &Progress| progress.reading.lock().unwrap().clone();
        let bar = shown(&progress).unwrap();
        assert_eq!((bar.position(), bar.length()), (250, Some(1000)));
        assert_eq!(bar.message(), "…econd day.csv");
        progress.read(Path::new(name), 1000, 1000);
        assert!(shown(&progress).is_none());
        (0..10).for_each(|_| progress.advance());
        assert_eq!(progress.work.position(), 10);
    }
}
