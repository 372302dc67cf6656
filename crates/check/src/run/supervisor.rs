//! Starts the child process, waits for it, and reads its journal, whatever became of it.

use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::time::{Duration, Instant};

use super::script::{Entry, Script};

/// How often the child is looked after.
const PATIENCE: Duration = Duration::from_millis(5);

/// Which program runs the library, and for how long at most.
#[derive(Debug, Clone)]
pub struct Runner {
    /// Executable; it is called with `arguments`, the path of the script and that of the journal, and must call
    /// [`super::execute_script`] with them.
    pub program: PathBuf,
    /// Arguments before the two paths.
    pub arguments: Vec<String>,
    /// The child is ended after this time.
    pub time_limit: Duration,
}

/// What became of a script.
pub(super) struct Ran {
    /// What its actions reported, in their order.
    pub(super) values: Vec<Vec<f64>>,
    /// What the FMU logged.
    pub(super) messages: Vec<String>,
    /// Why it was not carried out to its end, if so.
    pub(super) failure: Option<String>,
    /// Bytes that the library wrote to standard output.
    pub(super) printed: usize,
}

impl Runner {
    /// Carries out the script on the FMU in `unpacked`; files go to `folder`.
    pub(super) fn run(&self, script: &Script, folder: &Path, unpacked: &Path) -> io::Result<Ran> {
        let path = |name: &str| folder.join(name);
        fs::write(path("script.json"), serde_json::to_vec(script)?)?;
        let mut child = Command::new(&self.program)
            .args(&self.arguments)
            .arg(path("script.json"))
            .arg(path("journal.jsonl"))
            .stdin(Stdio::null())
            .stdout(File::create(path("stdout"))?)
            .stderr(File::create(path("stderr"))?)
            .spawn()?;
        let end = self.wait(&mut child)?;
        // none if the child did not even come to its first line
        let journal = fs::read_to_string(path("journal.jsonl")).unwrap_or_default();
        let mut ran = Ran {
            values: Vec::new(),
            messages: Vec::new(),
            failure: None,
            printed: fs::read(path("stdout"))?.len(),
        };
        let mut at = "the start of the child process".to_owned();
        let mut is_finished = false;
        // paths in the FMU, without the folder that it happens to be in
        let inside = format!("{}{}", unpacked.display(), std::path::MAIN_SEPARATOR);
        let shown = |text: String| text.replace(&inside, "");
        // the last line may be cut
        for entry in journal
            .lines()
            .map_while(|line| serde_json::from_str(line).ok())
        {
            match entry {
                Entry::Loading => at = "loading the library".to_owned(),
                Entry::Began(index) => {
                    at = script
                        .actions
                        .get(index)
                        .map_or_else(String::new, ToString::to_string);
                }
                Entry::Logged(message) => ran.messages.push(shown(message)),
                Entry::Values(values) => ran.values.push(
                    values
                        .into_iter()
                        .map(|value| value.unwrap_or(f64::NAN))
                        .collect(),
                ),
                Entry::Refused(refused) => {
                    ran.failure = Some(shown(format!("{refused} (during {at})")))
                }
                Entry::Finished => is_finished = true,
            }
        }
        if ran.failure.is_none() {
            ran.failure = match end {
                None => Some(format!(
                    "the library had not come to an end after {} s, during {at}",
                    self.time_limit.as_secs_f64()
                )),
                Some(status) if is_finished && status.success() => None,
                Some(status) => {
                    let stderr = String::from_utf8_lossy(&fs::read(path("stderr"))?)
                        .trim()
                        .to_owned();
                    let said = if stderr.is_empty() {
                        String::new()
                    } else {
                        format!("; it said: {}", shortened(&stderr))
                    };
                    Some(format!(
                        "the library ended its process ({}) during {at}{said}",
                        how(status)
                    ))
                }
            };
        }
        Ok(ran)
    }

    /// Status of the child, or `None` if it had to be ended.
    fn wait(&self, child: &mut Child) -> io::Result<Option<ExitStatus>> {
        let began = Instant::now();
        loop {
            if let Some(status) = child.try_wait()? {
                return Ok(Some(status));
            }
            if began.elapsed() > self.time_limit {
                child.kill()?;
                child.wait()?;
                return Ok(None);
            }
            std::thread::sleep(PATIENCE);
        }
    }
}

/// One line of at most 200 characters.
fn shortened(text: &str) -> String {
    text.chars()
        .map(|c| if c.is_control() { ' ' } else { c })
        .take(200)
        .collect()
}

/// How a process ended.
fn how(status: ExitStatus) -> String {
    #[cfg(unix)]
    {
        use std::os::unix::process::ExitStatusExt as _;
        if let Some(signal) = status.signal() {
            // the numbers that POSIX systems agree upon
            let name = match signal {
                4 => ", illegal instruction",
                6 => ", abort",
                8 => ", arithmetic error",
                11 => ", segmentation fault",
                _ => "",
            };
            return format!("signal {signal}{name}");
        }
    }
    status.code().map_or_else(
        || "no exit code".to_owned(),
        |code| format!("exit code {code}"),
    )
}
