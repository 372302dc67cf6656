//! Files behind a lap model, by their hashes.

use std::path::{Path, PathBuf};

use bolted_joint_identify::Watch;
use bolted_joint_joint::Provenance;
use bolted_joint_study::{Method, StudyError, input_file, provenance};

/// Where a joint of a lap method comes from: its `model`, the `files` with their roles, the study's notes.
pub(super) fn origin(
    method: Method,
    model: &str,
    study: &Path,
    files: &[(String, PathBuf)],
    notes: Vec<String>,
    watch: &dyn Watch,
) -> Result<Provenance, StudyError> {
    let folder = study.parent().unwrap_or(Path::new(""));
    let all = std::iter::once(("study".to_owned(), study.to_owned())).chain(files.iter().cloned());
    let record = |(role, path): (String, PathBuf)| {
        input_file(&role, &path, folder, |read, of| watch.read(&path, read, of))
    };
    let inputs = all.map(record).collect::<Result<_, _>>()?;
    Ok(provenance(method, model, inputs, notes))
}
