//! Writing of results: to files whole or not at all, to stdout with errors reported, messages to stderr.

use std::fs;
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};

use bolted_joint_files::whole_file;

use super::error::CliError;

/// Refuses an output that cannot be written or would replace an input, before anything is computed.
pub(super) fn check_output(path: &Path, others: &[&PathBuf]) -> Result<(), CliError> {
    let unwritable = |source| CliError::Unwritable {
        path: path.to_owned(),
        source,
    };
    let folder = match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    if !fs::metadata(folder).map_err(unwritable)?.is_dir() {
        return Err(unwritable(io::ErrorKind::NotADirectory.into()));
    }
    if path.is_dir() {
        return Err(unwritable(io::ErrorKind::IsADirectory.into()));
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

/// Prints a line to stderr; a stderr that nobody reads is no reason to stop.
pub(super) fn message(text: &str) {
    let _ = writeln!(io::stderr(), "{text}");
}

/// Writes a file whole or not at all.
pub(super) fn write_file(path: &Path, contents: &[u8]) -> Result<(), CliError> {
    whole_file::write(path, contents).map_err(|source| CliError::Unwritable {
        path: path.to_owned(),
        source,
    })
}

/// Prints a result to stdout.
pub(super) fn print(text: &str) -> Result<(), CliError> {
    let mut stdout = io::stdout().lock();
    stdout.write_all(text.as_bytes())?;
    if !text.ends_with('\n') {
        stdout.write_all(b"\n")?;
    }
    Ok(stdout.flush()?)
}
