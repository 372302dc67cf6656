//! A folder of its own for each test, in which the real binary runs.

use bolted_joint_testing::has;
use std::collections::BTreeMap;
use std::fs::{self, File};
use std::io::Read as _;
use std::path::PathBuf;
use std::process::{Command, Output, Stdio};

use serde_json::Value;
use tempfile::TempDir;
use zip::ZipArchive;

/// Identifies the joint of `study.toml`.
pub(crate) const IDENTIFY: &str = "identify study.toml -o o.joint.json";

/// The beginning of a picture: binary data that no reader of this program should take for anything else.
pub(crate) const PNG: &[u8] =
    b"\x89PNG\r\n\x1a\n\x00\x00\x00\rIHDR\x00\x00\x01\x00\x00\x00\x01\x00";

/// What the program left behind when it ended.
pub(crate) struct Outcome {
    pub(crate) code: Option<i32>,
    pub(crate) stdout: String,
    pub(crate) stderr: String,
}

impl Outcome {
    pub(crate) fn of(output: Output) -> Self {
        let outcome = Self {
            code: output.status.code(),
            stdout: String::from_utf8(output.stdout).unwrap(),
            stderr: String::from_utf8(output.stderr).unwrap(),
        };
        assert!(!outcome.stderr.contains("panicked"), "{}", outcome.stderr);
        outcome
    }

    pub(crate) fn json(&self) -> Value {
        serde_json::from_str(&self.stdout).unwrap()
    }
}

/// A folder with files, where the program is run.
pub(crate) struct Bench {
    folder: TempDir,
}

impl Bench {
    pub(crate) fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        Self { folder }
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    pub(crate) fn write(&self, name: &str, contents: impl AsRef<[u8]>) {
        fs::write(self.path(name), contents).unwrap();
    }

    pub(crate) fn text(&self, name: &str) -> String {
        fs::read_to_string(self.path(name)).unwrap()
    }

    pub(crate) fn json(&self, name: &str) -> Value {
        serde_json::from_str(&self.text(name)).unwrap()
    }

    /// Replaces what stands once in a file.
    pub(crate) fn edit(&self, name: &str, from: &str, to: &str) {
        self.write(name, replaced(&self.text(name), from, to));
    }

    /// A text in an FMU.
    pub(crate) fn member(&self, fmu: &str, entry: &str) -> String {
        let mut archive = ZipArchive::new(File::open(self.path(fmu)).unwrap()).unwrap();
        let mut text = String::new();
        let mut entry = archive.by_name(entry).unwrap();
        entry.read_to_string(&mut text).unwrap();
        text
    }

    /// The program with arguments as one types them; none of them holds a space.
    pub(crate) fn command(&self, arguments: &str) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_bolted-joint"));
        command
            .args(arguments.split_whitespace())
            .current_dir(self.folder.path())
            .env_remove("SOURCE_DATE_EPOCH")
            .stdin(Stdio::null());
        command
    }

    pub(crate) fn run(&self, arguments: &str) -> Outcome {
        Outcome::of(self.command(arguments).output().unwrap())
    }

    /// Runs a command that must succeed.
    pub(crate) fn done(&self, arguments: &str) -> Outcome {
        let outcome = self.run(arguments);
        assert_eq!(outcome.code, Some(0), "{arguments}: {}", outcome.stderr);
        outcome
    }

    /// Identifies and gives the report.
    pub(crate) fn report(&self) -> String {
        let outcome = self.done(&format!("{IDENTIFY} --report o.html"));
        has(&outcome.stdout, &["wrote o.html"]);
        self.text("o.html")
    }

    /// Identifies where nothing that anyone may rely on comes of it, for this reason among others, and gives the report.
    pub(crate) fn report_not_to_be_relied_on(&self, reason: &str) -> String {
        let outcome = self.unusable(&format!("{IDENTIFY} --report o.html"), &[reason]);
        has(&outcome.stdout, &["wrote o.html"]);
        self.text("o.html")
    }

    /// Runs a command that does its work and must end with 3, because its result is not to be relied on, as `fragments` say.
    pub(crate) fn unusable(&self, arguments: &str, fragments: &[&str]) -> Outcome {
        let outcome = self.run(arguments);
        assert_eq!(outcome.code, Some(3), "{arguments}: {}", outcome.stderr);
        has(&outcome.stderr, &["not to be relied on"]);
        has(&outcome.stderr, fragments);
        outcome
    }

    /// Runs a command that must end with 1 and say all `fragments`.
    pub(crate) fn fails(&self, arguments: &str, fragments: &[&str]) -> Outcome {
        let outcome = self.run(arguments);
        assert_eq!(outcome.code, Some(1), "{arguments}: {}", outcome.stderr);
        has(&outcome.stderr, fragments);
        outcome
    }

    /// A file whose text has one part replaced is refused by `arguments`, as each row says; so it is for every row.
    pub(crate) fn refused_edits<const N: usize>(
        &self,
        arguments: &str,
        (file, text): (&str, &str),
        rows: &[(&str, &str, [&str; N])],
    ) {
        for (from, to, fragments) in rows {
            self.write(file, replaced(text, from, to));
            let place = format!("error: {file}:");
            self.refused(arguments, &[&[place.as_str()], &fragments[..]].concat());
        }
    }

    /// A file is refused by `arguments` for its contents, as each row says.
    pub(crate) fn refused_contents(
        &self,
        arguments: &str,
        file: &str,
        rows: &[(&[u8], [&str; 2])],
    ) {
        for (contents, [one, two]) in rows {
            self.write(file, contents);
            self.refused(arguments, &[&format!("error: {file}:"), one, two]);
        }
    }

    /// Runs a command that must end with 1, an error that holds all `fragments`, nothing on stdout and no file touched.
    pub(crate) fn refused(&self, arguments: &str, fragments: &[&str]) {
        self.refused_by(&mut self.command(arguments), fragments);
    }

    /// As [`Bench::refused`], for a command with an environment of its own.
    pub(crate) fn refused_by(&self, command: &mut Command, fragments: &[&str]) {
        let before = self.contents();
        let outcome = Outcome::of(command.output().unwrap());
        let stderr = &outcome.stderr;
        assert_eq!(outcome.code, Some(1), "{command:?}: {stderr}");
        assert_eq!(outcome.stdout, "", "{command:?}");
        assert!(stderr.starts_with("error: "), "{command:?}: {stderr}");
        has(stderr, fragments);
        // Messages are for people: no bytes of a binary file, no hundreds of digits.
        let printable = |c: char| !c.is_control() || c == '\n';
        assert!(stderr.chars().all(printable), "{stderr:?}");
        assert!(
            stderr.lines().all(|line| line.chars().count() < 700),
            "{stderr}"
        );
        assert!(before == self.contents(), "{command:?} touched files");
    }

    /// Every file below the folder with what is in it.
    pub(crate) fn contents(&self) -> BTreeMap<PathBuf, Vec<u8>> {
        let mut contents = BTreeMap::new();
        let mut folders = vec![self.folder.path().to_path_buf()];
        while let Some(folder) = folders.pop() {
            for entry in fs::read_dir(folder).unwrap() {
                let path = entry.unwrap().path();
                if path.is_dir() {
                    folders.push(path);
                } else {
                    contents.insert(path.clone(), fs::read(path).unwrap());
                }
            }
        }
        contents
    }

    /// Names of everything in the folder itself, sorted.
    pub(crate) fn names(&self) -> Vec<String> {
        let entries = fs::read_dir(self.folder.path()).unwrap();
        let mut names: Vec<String> = entries
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .collect();
        names.sort();
        names
    }
}

/// `text` with the one occurrence of `from` replaced.
pub(crate) fn replaced(text: &str, from: &str, to: &str) -> String {
    assert_eq!(text.matches(from).count(), 1, "{from:?} in {text}");
    text.replacen(from, to, 1)
}
