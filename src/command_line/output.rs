//! Writing of results: to files whole or not at all, to stdout with errors reported, messages to stderr.

use std::cell::Cell;
use std::fmt::{self, Write as _};
use std::fs;
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};

use bolted_joint_files::{inputs, whole_file};

use super::error::CliError;
use super::invocation::with_kept;

/// The output that is standard output.
const STANDARD_OUTPUT: &str = "-";

thread_local! {
    /// Whether a file goes to standard output, so that what is said of it goes to standard error.
    static IS_TAKEN: Cell<bool> = const { Cell::new(false) };
}

/// Lets standard output be free at the beginning of a command, which has read nothing yet.
pub(super) fn begin() {
    inputs::watch();
    IS_TAKEN.set(false);
}

/// Whether an output is standard output.
pub(super) fn is_standard_output(path: &Path) -> bool {
    path.as_os_str() == STANDARD_OUTPUT
}

/// Refuses an output that cannot be written or would replace an input, before anything is computed.
pub(super) fn check_output(path: &Path, others: &[&PathBuf]) -> Result<(), CliError> {
    let unwritable = |source| CliError::Unwritable {
        path: path.to_owned(),
        source,
    };
    if is_standard_output(path) {
        if IS_TAKEN.replace(true) {
            let expected = "standard output for one file alone";
            return Err(CliError::option("-", "a second output", expected));
        }
        return Ok(());
    }
    // a link that leads to no file yet is written through all the same
    let target = match path.exists() {
        true => path.to_path_buf(),
        false => whole_file::followed(path).map_err(unwritable)?,
    };
    let folder = match target.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    if !fs::metadata(folder).map_err(unwritable)?.is_dir() {
        return Err(unwritable(io::ErrorKind::NotADirectory.into()));
    }
    if path.is_dir() {
        return Err(unwritable(io::ErrorKind::IsADirectory.into()));
    }
    if let Ok(found) = fs::metadata(path) {
        // an error of the superuser too, who could write it: it was made read-only for a reason
        if found.permissions().readonly() {
            let why = "the file is read-only";
            return Err(unwritable(io::Error::new(
                io::ErrorKind::PermissionDenied,
                why,
            )));
        }
    }
    let same = |other: &&&PathBuf| match (fs::canonicalize(path), fs::canonicalize(other)) {
        (Ok(path), Ok(other)) => path == other,
        _ => path == **other,
    };
    match others.iter().find(same) {
        Some(other) => Err(CliError::SameFile {
            path: path.to_owned(),
            other: (*other).clone(),
        }),
        None => Ok(()),
    }
}

/// What a name may end in.
pub(super) enum Ending {
    Any,
    /// In one of these, and what is said where it does not.
    In(&'static [&'static str], &'static str),
    /// In anything but what another kind of file ends in.
    OfJointFile,
    /// The same of an FMU.
    OfFmu,
}

pub(super) const CSV: Ending = Ending::In(&["csv"], "a name that ends in .csv");
pub(super) const HTML: Ending = Ending::In(&["html"], "a name that ends in .html");
pub(super) const SVG: Ending = Ending::In(&["svg"], "a name that ends in .svg");

/// What a joint file is not: what other commands write, or what is read.
const OTHER_KINDS: [&str; 10] = [
    "fmu", "ssp", "csv", "html", "svg", "mo", "toml", "uff", "npz", "mat",
];

impl Ending {
    /// What is expected in place of this path; `None` where it fits.
    fn expected_for(&self, path: &Path) -> Option<&'static str> {
        let extension = path.extension().and_then(|extension| extension.to_str());
        let is_in = |endings: &[&str]| extension.is_some_and(|found| endings.contains(&found));
        match self {
            Self::In(endings, expected) => {
                (!is_standard_output(path) && !is_in(endings)).then_some(*expected)
            }
            Self::OfJointFile => is_of_another_kind(path).then_some(
                "a name for the joint file, such as NAME.joint.json; `export` makes an FMU of it",
            ),
            Self::OfFmu => (!is_in(&["fmu"])
                && (is_of_another_kind(path) || is_in(&["json", "txt"])))
            .then_some("a name for an FMU, such as NAME.fmu"),
            Self::Any => None,
        }
    }
}

/// In capitals or not: nobody calls a joint file X.FMU either.
fn is_of_another_kind(path: &Path) -> bool {
    let extension = path.extension().and_then(|extension| extension.to_str());
    let is = |kind: &&str| extension.is_some_and(|found| found.eq_ignore_ascii_case(kind));
    OTHER_KINDS.iter().any(is)
}

/// Refuses paths that cannot be written, name a file twice or end otherwise than the option asks for; gives all that are taken.
pub(super) fn check_outputs<'a>(
    study: &'a PathBuf,
    asked: &[(&'static str, Option<&'a PathBuf>, Ending)],
) -> Result<Vec<&'a PathBuf>, CliError> {
    let mut taken = vec![study];
    // that two files would be one says more than what a joint file is not called
    let mut misnamed = None;
    for (option, path, ending) in asked {
        let Some(path) = *path else { continue };
        let refused = |expected| CliError::option(option, path.display(), expected);
        match (ending, ending.expected_for(path).map(refused)) {
            (Ending::OfJointFile, found) => misnamed = misnamed.or(found),
            (_, Some(found)) => return Err(found),
            (_, None) => {}
        }
        check_output(path, &taken)?;
        taken.push(path);
    }
    misnamed.map_or(Ok(taken), Err)
}

/// Refuses the name of another kind of file for an FMU, and notes where it has none that importers look for.
pub(super) fn check_fmu(path: &Path, others: &[&PathBuf]) -> Result<(), CliError> {
    check_output(path, others)?;
    if let Some(expected) = Ending::OfFmu.expected_for(path) {
        return Err(CliError::option("--output", path.display(), expected));
    }
    if !has_extension(path, "fmu") && !is_standard_output(path) {
        note(&["importers look for a name that ends in .fmu".to_owned()]);
    }
    Ok(())
}

/// Refuses a `--plot` that is no page and no picture, cannot be written or would replace one of the files that are read.
pub(super) fn check_plot(plot: Option<&PathBuf>, read: &[PathBuf]) -> Result<(), CliError> {
    let Some(path) = plot else { return Ok(()) };
    if !["html", "svg"]
        .iter()
        .any(|ending| has_extension(path, ending))
    {
        let expected = "a name that ends in .html or .svg";
        return Err(CliError::option("--plot", path.display(), expected));
    }
    check_output(path, &read.iter().collect::<Vec<_>>())
}

/// Whether a path has this ending, in capitals or not; a table (CSV) may go to standard output.
pub(super) fn has_extension(path: &Path, wanted: &str) -> bool {
    let extension = path.extension().and_then(|extension| extension.to_str());
    extension.is_some_and(|extension| extension.eq_ignore_ascii_case(wanted))
        || is_standard_output(path) && wanted == "csv"
}

/// Prints a line to stderr; a stderr that nobody reads is no reason to stop.
pub(super) fn message(text: &str) {
    if with_kept(|kept| kept.messages.push(text.to_owned())).is_none() {
        let _ = writeln!(io::stderr(), "{text}");
    }
}

/// Prints warnings to stderr.
pub(super) fn warn(warnings: &[String]) {
    for warning in warnings {
        message(&format!("warning: {warning}"));
    }
}

/// Tells what may well be meant.
pub(super) fn note(notes: &[String]) {
    for note in notes {
        message(&format!("note: {note}"));
    }
}

/// Writes files whole or, if one cannot be written, none.
pub(super) fn write_files(files: &[(&Path, &[u8])]) -> Result<(), CliError> {
    // a pipe has no old contents that could be put back
    let is_stream =
        |path: &Path| fs::metadata(path).is_ok_and(|own| !own.is_file() && !own.is_dir());
    let (streams, written): (Vec<_>, Vec<_>) = files
        .iter()
        .copied()
        .partition(|(path, _)| is_standard_output(path) || is_stream(path));
    whole_file::write_all(&written)
        .map_err(|(path, source)| CliError::Unwritable { path, source })?;
    written.iter().for_each(|(path, _)| tell_link(path));
    streams
        .iter()
        .try_for_each(|(path, contents)| match is_standard_output(path) {
            true => to_standard_output(contents),
            false => whole_file::write(path, contents).map_err(|source| CliError::Unwritable {
                path: path.to_path_buf(),
                source,
            }),
        })
}

/// Names what was written through a link; not before, since a command that is refused has written nothing.
pub(super) fn tell_link(path: &Path) {
    if let Ok(target) = fs::read_link(path) {
        message(&format!(
            "note: {} is a link and stays one: {} is written",
            path.display(),
            target.display()
        ));
    }
}

/// Writes a file whole or not at all.
pub(super) fn write_file(path: &Path, contents: &[u8]) -> Result<(), CliError> {
    write_files(&[(path, contents)])
}

/// Contents of a file to standard output, as they are.
fn to_standard_output(contents: &[u8]) -> Result<(), CliError> {
    let kept = with_kept(|kept| {
        let text = std::str::from_utf8(contents);
        text.map(|text| kept.printed.push_str(text))
    });
    match kept {
        None => {}
        Some(Ok(())) => return Ok(()),
        Some(Err(_)) => {
            let expected = "the name of a file: it is no text";
            return Err(CliError::option("--output", STANDARD_OUTPUT, expected));
        }
    }
    let mut stdout = io::stdout().lock();
    stdout.write_all(contents)?;
    Ok(stdout.flush()?)
}

/// Prints a result to stdout; to stderr where stdout has a file.
pub(super) fn print(text: &str) -> Result<(), CliError> {
    if IS_TAKEN.get() {
        message(text.trim_end());
        return Ok(());
    }
    if with_kept(|kept| kept.printed.push_str(text)).is_some() {
        return Ok(());
    }
    let mut stdout = io::stdout().lock();
    stdout.write_all(text.as_bytes())?;
    if !text.ends_with('\n') {
        stdout.write_all(b"\n")?;
    }
    Ok(stdout.flush()?)
}

/// Says that a file was written, or that standard output has it.
pub(super) struct Wrote<'p>(pub(super) &'p Path);

impl fmt::Display for Wrote<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match is_standard_output(self.0) {
            true => f.write_str("wrote to standard output"),
            false => write!(f, "wrote {}", self.0.display()),
        }
    }
}

/// Contents for paths: written all or none.
pub(super) struct Outputs {
    files: Vec<(PathBuf, String)>,
}

impl Outputs {
    pub(super) fn new() -> Self {
        Self { files: Vec::new() }
    }

    /// One more file, where it is asked for.
    pub(super) fn add(&mut self, path: Option<&PathBuf>, contents: impl FnOnce() -> String) {
        if let Some(path) = path {
            self.files.push((path.clone(), contents()));
        }
    }

    /// Writes every file or, if one cannot be written, none.
    pub(super) fn write(&self) -> Result<(), CliError> {
        let files = self.files.iter();
        let files: Vec<(&Path, &[u8])> = files
            .map(|(path, contents)| (path.as_path(), contents.as_bytes()))
            .collect();
        write_files(&files)
    }

    /// A line for each.
    pub(super) fn written(&self) -> String {
        let mut text = String::new();
        for (path, _) in &self.files {
            // writing to a String cannot fail
            let _ = writeln!(text, "{}", Wrote(path));
        }
        text
    }
}
