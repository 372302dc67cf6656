//! Writing of results: to files whole or not at all, to stdout with errors reported.

use std::io::{self, Write as _};
use std::path::Path;

use crate::whole_file;

use super::error::CliError;

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
