//! Progress on stderr for work that takes more than a second: how much is done and how long the rest takes, on a terminal only.

use std::io::{self, IsTerminal as _};
use std::path::Path;
use std::sync::{Mutex, PoisonError};
use std::thread;
use std::time::Duration;

use indicatif::{MultiProgress, ProgressBar, ProgressDrawTarget, ProgressStyle};

use crate::identify::Watch;

/// Work shorter than this shows nothing.
const PATIENCE: Duration = Duration::from_secs(1);
const BETWEEN_LINES: Duration = Duration::from_millis(100);
/// Characters of a file's name, so that a bar has room beside it.
const NAME: usize = 14;
/// Steps of a bar whose work is not counted in pieces.
const FINE: u32 = 1000;

const WAITING: &str = "{msg} … {elapsed}";
const COUNTING: &str = "{msg} [{wide_bar}] {pos} of {len}, {eta} left";
const SHARE: &str = "{msg} [{wide_bar}] {percent} %, {eta} left";
const READING: &str = "{msg} [{wide_bar}] {decimal_bytes} of {decimal_total_bytes}, {eta} left";

/// Says, from the second second on, how long the work has taken or how much of it is done, and how much of a file has been read.
/// However the work ends, the lines go away.
pub(super) struct Progress {
    lines: MultiProgress,
    work: ProgressBar,
    /// How the work is shown once some of it is done.
    known: &'static str,
    reading: Mutex<Option<ProgressBar>>,
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
        if io::stderr().is_terminal() {
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
        }
    }

    /// One more piece is done. May be called from any thread.
    pub(super) fn advance(&self) {
        self.has_begun();
        self.work.inc(1);
    }

    /// This part of the work is done, from 0 to 1.
    pub(super) fn reached(&self, share: f64) {
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
    use std::sync::Arc;

    use indicatif::TermLike;

    use super::*;

    /// A terminal that keeps what is written between two clearings.
    #[derive(Clone, Debug)]
    struct Screen {
        width: u16,
        written: Arc<Mutex<String>>,
    }

    impl TermLike for Screen {
        fn width(&self) -> u16 {
            self.width
        }
        fn move_cursor_up(&self, _: usize) -> io::Result<()> {
            Ok(())
        }
        fn move_cursor_down(&self, _: usize) -> io::Result<()> {
            Ok(())
        }
        fn move_cursor_right(&self, _: usize) -> io::Result<()> {
            Ok(())
        }
        fn move_cursor_left(&self, _: usize) -> io::Result<()> {
            Ok(())
        }
        fn write_line(&self, text: &str) -> io::Result<()> {
            self.write_str(&format!("{text}\n"))
        }
        fn write_str(&self, text: &str) -> io::Result<()> {
            self.written.lock().unwrap().push_str(text);
            Ok(())
        }
        fn clear_line(&self) -> io::Result<()> {
            self.written.lock().unwrap().clear();
            Ok(())
        }
        fn flush(&self) -> io::Result<()> {
            Ok(())
        }
    }

    /// What stands on a terminal of so many columns after `steps`.
    fn shown(progress: &Progress, width: u16, steps: impl Fn()) -> Vec<String> {
        let screen = Screen {
            width,
            written: Arc::default(),
        };
        let target = ProgressDrawTarget::term_like(Box::new(screen.clone()));
        progress.lines.set_draw_target(target);
        steps();
        progress.work.force_draw();
        // every line is filled up to the terminal's width
        let text: Vec<char> = screen.written.lock().unwrap().chars().collect();
        let lines = text.chunks(width.into());
        let lines = lines.map(|line| line.iter().collect::<String>().trim().to_owned());
        lines.filter(|line| !line.is_empty()).collect()
    }

    #[test]
    fn lines_fit_the_terminal() {
        let name = "a measurement with a long name, second day.csv";
        for width in [60, 100, 200] {
            let progress = Progress::new("identifying", 40);
            let waiting = shown(&progress, width, || ());
            assert!(waiting[0].starts_with("identifying … "), "{waiting:?}");
            let reading = shown(&progress, width, || {
                progress.read(Path::new(name), 99_000_000, 990_000_000);
            });
            assert_eq!(reading.len(), 2, "{reading:?}");
            assert!(reading[1].starts_with("…econd day.csv [#"), "{reading:?}");
            assert!(
                reading[1].contains("99.00 MB of 990.00 MB, "),
                "{reading:?}"
            );
            let counting = shown(&progress, width, || {
                progress.read(Path::new(name), 990_000_000, 990_000_000);
                (0..10).for_each(|_| progress.advance());
            });
            assert_eq!(counting.len(), 1, "{counting:?}");
            assert!(counting[0].contains("10 of 40, "), "{counting:?}");
            let progress = Progress::of_share("responding");
            let share = shown(&progress, width, || progress.reached(0.25));
            assert_eq!(share.len(), 1, "{share:?}");
            assert!(share[0].contains("25 %, "), "{share:?}");
            for line in [&reading[1], &counting[0], &share[0]] {
                assert!(line.ends_with(" left"), "{line}");
            }
        }
    }
}
