//! Where a joint comes from: the files it was identified from, by their hashes.

use std::path::{Path, PathBuf};

use sha2::{Digest, Sha256};

use crate::joint::{InputFile, Provenance};
use crate::text_file::TextFileError;

use super::error::IdentifyError;
use super::study::{Source, Study, Substructure};

/// Provenance of what is identified from this study.
pub(super) fn of(study: &Study) -> Result<Provenance, IdentifyError> {
    let folder = study.path.parent().unwrap_or(Path::new(""));
    let file_of = |substructure: &Substructure| match substructure {
        Substructure::Measured { source, .. } => Some(match source {
            Source::Frf(file) => file.path.clone(),
            Source::Modal(path) => path.clone(),
        }),
        Substructure::Beam { .. } => None,
    };
    let mut named = vec![
        ("study", Some(study.path.clone())),
        ("substructure a", file_of(&study.a)),
        ("substructure b", file_of(&study.b)),
        ("assembly", Some(study.assembly.path.clone())),
    ];
    for further in &study.further {
        let its_own = |role, path: Option<PathBuf>, named: &[(&str, Option<PathBuf>)]| {
            let known = named.contains(&(role, path.clone()));
            (!known).then_some((role, path))
        };
        for (role, path) in [
            ("substructure a", file_of(&further.a)),
            ("substructure b", file_of(&further.b)),
            ("assembly", Some(further.file.path.clone())),
        ] {
            let entry = its_own(role, path, &named);
            named.extend(entry);
        }
    }
    let repeats = study.further.iter().flat_map(|further| &further.repeats);
    let repeats = study.repeats.iter().chain(repeats);
    named.extend(repeats.map(|file| ("assembly, repeated", Some(file.path.clone()))));
    let inputs = named
        .into_iter()
        .filter_map(|(role, path)| Some((role, path?)))
        .map(|(role, path)| input(role, &path, folder))
        .collect::<Result<Vec<_>, _>>()?;
    Ok(Provenance {
        tool: env!("CARGO_PKG_NAME").to_owned(),
        version: env!("CARGO_PKG_VERSION").to_owned(),
        method: "frf-decoupling".to_owned(),
        model: study.model.to_string(),
        inputs,
        notes: study.notes.clone(),
    })
}

fn input(role: &str, path: &PathBuf, folder: &Path) -> Result<InputFile, IdentifyError> {
    let bytes = std::fs::read(path).map_err(|source| TextFileError::Unreadable {
        path: path.clone(),
        source,
    })?;
    let digest = Sha256::digest(&bytes);
    Ok(InputFile {
        role: role.to_owned(),
        file: path
            .strip_prefix(folder)
            .unwrap_or(path)
            .display()
            .to_string(),
        sha256: digest.iter().map(|byte| format!("{byte:02x}")).collect(),
    })
}
