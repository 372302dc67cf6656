//! The files that a study or an assembly names: they have to be there, and no output may take the place of one. Both are told with
//! the key, before anything is computed.

use std::fs;
use std::path::PathBuf;

use bolted_joint::show::FileKind;
use bolted_joint::study::{NamedFile, StudyText};

use super::error::CliError;

/// Refuses a file that is named and not there, and an output that would replace one that is.
pub(super) fn check_named(text: &StudyText, outputs: &[Option<&PathBuf>]) -> Result<(), CliError> {
    check(text, &text.named_files(), outputs)
}

/// The same but for what was measured of the assembly, which need not be there yet, and may be computed anew.
pub(super) fn check_named_but_assembly(
    text: &StudyText,
    outputs: &[Option<&PathBuf>],
) -> Result<(), CliError> {
    let mut files = text.named_files();
    files.retain(|file| !file.key.starts_with("assembly"));
    check(text, &files, outputs)
}

/// Refuses a file of functions or modes that is plainly something else: their readers know nothing of other kinds.
fn check_kind(text: &StudyText, file: &NamedFile) -> Result<(), CliError> {
    let key = file.key.rsplit('.').next().unwrap_or_default();
    let expected = match key {
        "frf" | "coherence" => {
            "a file of measured functions: universal file, table (CSV), NPZ or MAT"
        }
        "modal" => "a file of modes",
        _ => return Ok(()),
    };
    let kind = FileKind::of(&file.path);
    let is_toml = file
        .path
        .extension()
        .is_some_and(|own| own.eq_ignore_ascii_case("toml"));
    let is_other = match kind {
        FileKind::Modes => key != "modal" && is_toml,
        FileKind::Study(_)
        | FileKind::Assembly
        | FileKind::Table(_)
        | FileKind::JointFile
        | FileKind::Draws
        | FileKind::Fmu
        | FileKind::Ssp
        | FileKind::Folder
        | FileKind::Pipe => true,
        _ => false,
    };
    match is_other {
        true => {
            let found = format!("{:?}, {kind}", file.name);
            Err(text.refusal(&file.key, found, expected).into())
        }
        false => Ok(()),
    }
}

fn check(
    text: &StudyText,
    files: &[NamedFile],
    outputs: &[Option<&PathBuf>],
) -> Result<(), CliError> {
    text.check_is_there(files)?;
    for file in files {
        check_kind(text, file)?;
    }
    for output in outputs.iter().flatten() {
        let Ok(whole) = fs::canonicalize(output) else {
            continue;
        };
        let is_output =
            |file: &&NamedFile| fs::canonicalize(&file.path).is_ok_and(|path| path == whole);
        if let Some(file) = files.iter().find(is_output) {
            return Err(CliError::Named {
                path: (*output).clone(),
                study: text.path().to_owned(),
                key: file.key.clone(),
            });
        }
    }
    Ok(())
}
