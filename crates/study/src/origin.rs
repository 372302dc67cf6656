//! Where a joint comes from: the files behind it, by their hashes.

use std::io::{self, ErrorKind, Read as _};
use std::path::Path;

use sha2::{Digest, Sha256};

use bolted_joint_files::{inputs, text_file::TextFileError};
use bolted_joint_joint::{InputFile, Provenance};

use super::{Method, StudyError, StudyText};

/// Bytes of a file that are read at a time.
const PIECE: usize = 1 << 16;

impl StudyText {
    /// The record of the study itself.
    #[must_use]
    pub fn record(&self) -> InputFile {
        record(
            "study",
            self.path(),
            self.folder(),
            &Sha256::digest(self.text()),
        )
    }
}

/// The record of a file of a study in `folder`; `progress` is told how many bytes of how many have been read.
///
/// # Errors
/// [`StudyError::File`] if it cannot be read.
pub fn input_file(
    role: &str,
    path: &Path,
    folder: &Path,
    progress: impl FnMut(u64, u64),
) -> Result<InputFile, StudyError> {
    let digest = digest(path, progress).map_err(|source| TextFileError::Unreadable {
        path: path.to_owned(),
        source,
    })?;
    Ok(record(role, path, folder, &digest))
}

/// A path as the study in `folder` gives it.
#[must_use]
pub fn name_in(folder: &Path, path: &Path) -> String {
    let path = path.strip_prefix(folder).unwrap_or(path);
    path.display().to_string()
}

/// Where a joint comes from that this program has found from `inputs` by a method with a `model`.
#[must_use]
pub fn provenance(
    method: Method,
    model: impl Into<String>,
    inputs: Vec<InputFile>,
    notes: Vec<String>,
) -> Provenance {
    Provenance {
        tool: bolted_joint_files::TOOL.to_owned(),
        version: bolted_joint_files::VERSION.to_owned(),
        method: method.name().to_owned(),
        model: model.into(),
        inputs,
        notes,
        ..Provenance::default()
    }
}

fn record(role: &str, path: &Path, folder: &Path, digest: &[u8]) -> InputFile {
    InputFile {
        role: role.to_owned(),
        file: name_in(folder, path),
        sha256: digest.iter().map(|byte| format!("{byte:02x}")).collect(),
    }
}

/// SHA-256 of a file, which may be larger than the memory.
fn digest(path: &Path, mut progress: impl FnMut(u64, u64)) -> io::Result<Vec<u8>> {
    let mut file = inputs::open(path)?;
    let of = file.metadata()?.len();
    let mut digest = Sha256::new();
    let mut piece = vec![0; PIECE];
    let mut read = 0;
    loop {
        let count = match file.read(&mut piece) {
            Ok(0) => break,
            Ok(count) => count,
            Err(error) if error.kind() == ErrorKind::Interrupted => continue,
            Err(error) => return Err(error),
        };
        digest.update(&piece[..count]);
        read += count as u64;
        progress(read.min(of), of);
    }
    progress(of, of);
    Ok(digest.finalize().to_vec())
}
