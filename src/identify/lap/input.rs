//! Files behind a lap model, by their hashes, and errors that name the study and the key.

use std::path::{Path, PathBuf};

use super::super::error::IdentifyError;
use super::super::provenance;
use super::super::watch::Watch;
use crate::joint::Provenance;

/// Where a joint of a lap method comes from: its `model`, the `files` with their roles, the study's notes.
pub(super) fn origin(
    method: &str,
    model: String,
    study: &Path,
    files: &[(String, PathBuf)],
    notes: Vec<String>,
    watch: &dyn Watch,
) -> Result<Provenance, IdentifyError> {
    let folder = study.parent().unwrap_or(Path::new(""));
    let all = std::iter::once(("study".to_owned(), study.to_owned())).chain(files.iter().cloned());
    let inputs = all
        .map(|(role, path)| provenance::input(&role, &path, folder, watch))
        .collect::<Result<_, _>>()?;
    Ok(Provenance {
        tool: env!("CARGO_PKG_NAME").to_owned(),
        version: env!("CARGO_PKG_VERSION").to_owned(),
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
) -> Result<T, IdentifyError> {
    Err(IdentifyError::Study {
        path: path.to_owned(),
        key: key.into(),
        found: found.into(),
        expected: expected.into(),
    })
}

/// Refuses a name that is no line of text.
pub(super) fn check_name(path: &Path, name: &str) -> Result<(), IdentifyError> {
    if name.trim().is_empty() || name.chars().any(char::is_control) {
        return refuse(path, "name", format!("{name:?}"), "one line of text");
    }
    Ok(())
}
