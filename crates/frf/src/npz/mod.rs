//! Functions as NumPy arrays: an archive (`.npz`) of named arrays.

mod archive;
mod array;
mod write;

use std::io::{BufReader, Read, Seek};
use std::path::Path;

use crate::arrays::{functions, matrices};
use crate::read::opened;
use crate::structure::{NamedMatrices, StructureError};
use crate::{FrfError, FrfReading, ReadOptions};

use archive::Archive;

pub use write::to_npz;

/// Reads the functions of a NumPy archive (`.npz`), stored or deflated.
///
/// Its arrays are `frequency` (Hz), `frf` (real or complex, with one axis for responses, one for references, one for
/// frequencies; axes of length one may be missing), `response` and `reference` (degrees of freedom such as `11:+Y`), and if need be
/// `axes` (such as `frequency,response,reference`), `quantity`, `unit`, `coherence` (as `frf`) and `averages`. Where lengths are
/// equal and `axes` is not there, the file is refused. Values become receptances in SI units.
///
/// # Errors
/// [`FrfError::Read`] if the file cannot be read, [`FrfError::Arrays`] with the cause if it cannot be used.
pub fn read_npz(path: impl AsRef<Path>, options: &ReadOptions) -> Result<FrfReading, FrfError> {
    let path = path.as_ref();
    read_npz_from(BufReader::new(opened(path)?), path, options)
}

/// As [`read_npz`], from any reader; `name` stands for the path in messages.
///
/// # Errors
/// As [`read_npz`].
pub fn read_npz_from(
    reader: impl Read + Seek,
    name: impl AsRef<Path>,
    options: &ReadOptions,
) -> Result<FrfReading, FrfError> {
    functions(Archive::open(reader), name.as_ref(), options)
}

/// The matrices of a structure in an archive.
pub(crate) fn matrices_from(
    reader: impl Read + Seek,
    name: &Path,
) -> Result<NamedMatrices, StructureError> {
    matrices(Archive::open(reader), name)
}
