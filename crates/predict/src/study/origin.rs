//! Where a predicted joint comes from: the files behind it, by their hashes.

use std::path::{Path, PathBuf};

use sha2::{Digest, Sha256};

use bolted_joint_files::text_file::{self, TextFileError};
use bolted_joint_joint::InputFile;

/// The record of a file of a study in `folder`, which should hold `expected`.
pub(super) fn of_file(
    role: &str,
    path: &Path,
    folder: &Path,
    expected: &'static str,
) -> Result<InputFile, TextFileError> {
    let text = text_file::read(path, expected)?;
    Ok(of_text(role, path, folder, &text))
}

/// The record of a file whose text is at hand.
pub(super) fn of_text(role: &str, path: &Path, folder: &Path, text: &str) -> InputFile {
    let digest = Sha256::digest(text.as_bytes());
    InputFile {
        role: role.to_owned(),
        file: path
            .strip_prefix(folder)
            .unwrap_or(path)
            .display()
            .to_string(),
        sha256: digest.iter().map(|byte| format!("{byte:02x}")).collect(),
    }
}

/// A path of the study, relative to its folder.
pub(super) fn resolved(folder: &Path, path: &Path) -> PathBuf {
    folder.join(path)
}
