//! Files that Python writes as the command line does: whole or not at all.

use std::io;
use std::path::PathBuf;

use bolted_joint::files::whole_file;
use pyo3::prelude::*;

/// Writes a file whole or not at all: what is there stays as it is if writing fails.
///
/// Raises `OSError` with the path, of the class that says what is wrong, such as `FileNotFoundError`.
#[pyfunction]
pub(super) fn write_file(py: Python<'_>, path: PathBuf, contents: &[u8]) -> PyResult<()> {
    let written = py.detach(|| whole_file::write(&path, contents));
    written.map_err(|source| {
        let advice = whole_file::advice(&source);
        let why = format!("{}: cannot be written: {source}; {advice}", path.display());
        PyErr::from(io::Error::new(source.kind(), why))
    })
}
