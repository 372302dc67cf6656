//! Files behind a lap model, by their hashes, and errors that name the study and the key.

use std::path::{Path, PathBuf};

use crate::error::LapError;
use bolted_joint_identify::{IdentifyError, Watch, input_file};
use bolted_joint_joint::Provenance;

/// Where a joint of a lap method comes from: its `model`, the `files` with their roles, the study's notes.
pub(super) fn origin(
    method: &str,
    model: String,
    study: &Path,
    files: &[(String, PathBuf)],
    notes: Vec<String>,
    watch: &dyn Watch,
) -> Result<Provenance, LapError> {
    let folder = study.parent().unwrap_or(Path::new(""));
    let all = std::iter::once(("study".to_owned(), study.to_owned())).chain(files.iter().cloned());
    let inputs = all
        .map(|(role, path)| input_file(&role, &path, folder, watch))
        .collect::<Result<_, _>>()?;
    Ok(Provenance {
        tool: bolted_joint_files::TOOL.to_owned(),
        version: bolted_joint_files::VERSION.to_owned(),
        method: method.to_owned(),
        model,
        inputs,
        bolts: Vec::new(),
        bands: None,
        from_modes: Vec::new(),
        notes,
    })
}

/// A study that cannot be used, by its key.
pub(super) fn refuse<T>(
    path: &Path,
    key: impl Into<String>,
    found: impl Into<String>,
    expected: impl Into<String>,
) -> Result<T, LapError> {
    Err(IdentifyError::Study {
        path: path.to_owned(),
        key: key.into(),
        found: found.into(),
        expected: expected.into(),
    }
    .into())
}

/// Refuses a name that is no line of text.
pub(super) fn check_name(path: &Path, name: &str) -> Result<(), LapError> {
    if name.trim().is_empty() || name.chars().any(char::is_control) {
        return refuse(path, "name", format!("{name:?}"), "one line of text");
    }
    Ok(())
}
