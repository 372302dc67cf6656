//! Functions from a file of any format that is known: universal file, table, NumPy archive or MATLAB file.

use std::fs::{File, Metadata};
use std::io::{BufRead, BufReader, Read, Seek};
use std::path::Path;

use bolted_joint_files::inputs;
use bolted_joint_files::text_table::is_for_excel;

use super::counted::Counted;
use super::csv::read_csv_from;
use super::mat::read_mat_from;
use super::npz::read_npz_from;
use super::uff::read_uff58_of;
use super::{FrfError, FrfReading, ReadOptions, TableProblem};

/// Bytes that are read at a time.
const PIECE: usize = 1 << 16;
/// How much of a file is looked at to tell what it is.
const LOOKED_AT: u64 = 4096;

/// What a file is by its first bytes and its name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Container {
    /// Universal file.
    Universal,
    /// Table (CSV).
    Table,
    /// NumPy archive (npz), or another zip archive.
    Archive,
    /// One NumPy array (npy).
    SingleArray,
    /// MATLAB file (mat).
    Matlab,
}

impl Container {
    /// What a file is by its name and its beginning, of which a few lines are enough; `None` if neither tells.
    #[must_use]
    pub fn told_by(path: &Path, beginning: &[u8]) -> Option<Self> {
        let extension = path.extension().unwrap_or_default().to_ascii_lowercase();
        let named = |names: &[&str]| names.iter().any(|name| extension == *name);
        let text = String::from_utf8_lossy(beginning);
        let first = text
            .trim_start_matches('\u{feff}')
            .lines()
            .map(str::trim)
            .find(|line| !line.is_empty() && !is_for_excel(line))
            .unwrap_or_default()
            .to_lowercase();
        if beginning.starts_with(b"PK") {
            Some(Self::Archive)
        } else if beginning.starts_with(b"\x93NUMPY") {
            Some(Self::SingleArray)
        } else if beginning.starts_with(b"MATLAB") || named(&["mat"]) {
            Some(Self::Matlab)
        } else if first == "-1" {
            Some(Self::Universal)
        } else if named(&["npz"]) {
            Some(Self::Archive)
        } else if named(&["csv", "tsv", "txt"])
            || !named(&["uff", "unv", "uf", "bunv"])
                && (first.starts_with('#') || first.starts_with("freq"))
        {
            Some(Self::Table)
        } else if named(&["uff", "unv", "uf", "bunv"]) {
            Some(Self::Universal)
        } else {
            None
        }
    }
}

/// Reads the frequency response functions of a universal file (58 or 58b), a table (CSV), a NumPy archive (npz) or a MATLAB
/// file (mat).
///
/// What the file is, is told by how it begins, and by its extension where that leaves it open. Values become receptances in SI
/// units; see [`read_uff58`](super::read_uff58), [`read_csv`](super::read_csv), [`read_npz`](super::read_npz) and
/// [`read_mat`](super::read_mat).
///
/// # Errors
/// [`FrfError::Read`], [`FrfError::Uff`], [`FrfError::Csv`] or [`FrfError::Arrays`].
pub fn read_frfs(path: impl AsRef<Path>, options: &ReadOptions) -> Result<FrfReading, FrfError> {
    read_frfs_watched(path, options, &|_, _| ())
}

/// As [`read_frfs`]; `watch` is told again and again how many bytes have been read, and how many there are.
///
/// # Errors
/// As [`read_frfs`].
pub fn read_frfs_watched(
    path: impl AsRef<Path>,
    options: &ReadOptions,
    watch: &dyn Fn(u64, u64),
) -> Result<FrfReading, FrfError> {
    reading(path.as_ref(), options, watch)
}

/// A file that is to be read.
pub(crate) fn opened(path: &Path) -> Result<File, FrfError> {
    inputs::open(path).map_err(|source| FrfError::Read {
        path: path.to_owned(),
        source,
    })
}

/// Not generic, so that callers do not compile the readers anew.
fn reading(
    path: &Path,
    options: &ReadOptions,
    watch: &dyn Fn(u64, u64),
) -> Result<FrfReading, FrfError> {
    let failed = |source| FrfError::Read {
        path: path.to_owned(),
        source,
    };
    let file = opened(path)?;
    let metadata = file.metadata().ok().filter(Metadata::is_file);
    let length = metadata.map(|metadata| metadata.len());
    let of = length.unwrap_or(0);
    // A member of an archive may be met twice, and no reader asks for the end of a file that it has understood before.
    let counted = |bytes: u64| watch(bytes.min(of), of);
    let mut reader = BufReader::with_capacity(PIECE, Counted::new(file, &counted));
    let mut beginning = Vec::new();
    (&mut reader)
        .take(LOOKED_AT)
        .read_to_end(&mut beginning)
        .map_err(failed)?;
    reader.rewind().map_err(failed)?;
    let reading = match Container::told_by(path, &beginning).unwrap_or(Container::Universal) {
        Container::Universal => {
            read_uff58_of(&mut reader as &mut dyn BufRead, path, length, options)
        }
        Container::Table => read_csv_from(&mut reader as &mut dyn BufRead, path, options),
        Container::Archive => read_npz_from(reader, path, options),
        Container::Matlab => read_mat_from(reader, path, options),
        Container::SingleArray => Err(FrfError::Arrays {
            path: path.to_owned(),
            problem: Box::new(TableProblem::whole(
                "one NumPy array (.npy)",
                "an archive (.npz) that has its frequencies and names too; save it with numpy.savez(file, frequency=…, frf=…, response=…, \
                 reference=…)",
            )),
        }),
    };
    watch(of, of);
    reading
}
