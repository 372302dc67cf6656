//! Files that Python writes as the command line does: whole or not at all.

use std::io;
use std::path::PathBuf;

use bolted_joint::files::whole_file;
use pyo3::exceptions::PyOSError;
use pyo3::prelude::*;

/// Writes a file whole or not at all: what is there stays as it is if writing fails.
///
/// Raises `OSError` with the path, of the class that the number of the operating system's error has.
#[pyfunction]
pub(super) fn write_file(py: Python<'_>, path: PathBuf, contents: &[u8]) -> PyResult<()> {
    let written = py.detach(|| whole_file::write(&path, contents));
    written.map_err(|source: io::Error| match source.raw_os_error() {
        Some(number) => {
            let text = source.to_string();
            let why = text.split(" (os error").next().unwrap_or_default();
            PyOSError::new_err((number, why.to_owned(), path.into_os_string()))
        }
        None => PyOSError::new_err(format!("{}: {source}", path.display())),
    })
}
