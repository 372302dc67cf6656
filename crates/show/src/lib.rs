//! What a file is, and what is in it, in one screen: measured functions, modes, matrices, studies, assemblies, joint files and
//! FMUs.
//!
//! [`FileKind::of`] tells what a path is, for every command: one that gets another kind of file than it takes names the command
//! that takes it. [`show`] reads the file and tells what is in it, with checks of what was measured, and pictures.
#![forbid(unsafe_code)]

mod assembly;
mod draft;
mod draws;
mod error;
mod fmu;
mod functions;
mod joint;
mod kind;
mod matrices;
mod modes;
mod quality;
mod shown;
mod study;
mod system;
mod tables;

use std::path::Path;

use bolted_joint_files::{table_header, text_file};
use bolted_joint_joint::{JointFile, JointFileError};
use bolted_joint_study::StudyText;

pub use draft::{Draft, DraftError, draft};
pub use error::ShowError;
pub use kind::{FileKind, command_for};
pub use quality::{DrivePoint, Reciprocity, drive_points, half_power_lines, reciprocities};
pub use shown::{Fact, Shown};
pub use tables::TableKind;

/// What is in a file.
///
/// # Errors
/// [`ShowError`] if the file is none of those that are known, or what its reader says of it.
pub fn show(path: &Path) -> Result<Shown, ShowError> {
    let kind = FileKind::of(path);
    let mut shown = match kind {
        FileKind::Functions(_) => functions::or_matrices(path)?,
        FileKind::Table(kind) => tables::shown(path, kind)?,
        FileKind::Unknown => unknown(path)?,
        FileKind::Matrices => matrices::shown(path)?,
        FileKind::Modes => modes::shown(path)?,
        FileKind::Study(_) => study::shown(&StudyText::read(path)?)?,
        FileKind::Assembly => assembly::shown(&StudyText::read(path)?)?,
        FileKind::JointFile => joint::shown(path)?,
        FileKind::Draws => draws::shown(path)?,
        FileKind::Fmu => fmu::shown(path)?,
        FileKind::Ssp => system::shown(path)?,
        FileKind::Pipe => {
            return Err(ShowError::Pipe {
                path: path.to_owned(),
            });
        }
        FileKind::List => {
            // the list that `show --json` prints is none of joint files
            return Err(match JointFile::read(path) {
                Err(
                    error @ JointFileError::List {
                        joint_files: 1.., ..
                    },
                ) => error.into(),
                _ => ShowError::Kind {
                    path: path.to_owned(),
                    found: kind.to_string(),
                },
            });
        }
        FileKind::OtherJson if is_named_joint_file(path) => joint::shown(path)?,
        FileKind::Folder | FileKind::OtherJson | FileKind::OtherZip => {
            return Err(ShowError::Kind {
                path: path.to_owned(),
                found: kind.to_string(),
            });
        }
    };
    path.clone_into(&mut shown.path);
    Ok(shown)
}

/// Whether a file is called what joint files are: then their reader says what is wrong with it.
fn is_named_joint_file(path: &Path) -> bool {
    path.to_string_lossy().ends_with(".joint.json")
}

/// What cannot be read is told by the reader whose it seems to be; what is read, and is of no kind, with the kinds that there are.
fn unknown(path: &Path) -> Result<Shown, ShowError> {
    let extension = path.extension().unwrap_or_default();
    let is_blank = kind::is_blank(path);
    let is_text = |name: &&str| extension.eq_ignore_ascii_case(name);
    if path.exists() && is_blank && ["toml", "json"].iter().any(is_text) {
        return Err(ShowError::Kind {
            path: path.to_owned(),
            found: "an empty file".to_owned(),
        });
    }
    if !path.exists() || is_blank {
        return functions::or_matrices(path);
    }
    if is_named_joint_file(path) {
        return joint::shown(path);
    }
    let begins_as_toml = || {
        let text = text_file::beginning(path).unwrap_or_default();
        table_header(&text).is_some()
    };
    // instruments write headers in brackets, too, into files of other names
    let may_be_toml = extension.is_empty() || extension.eq_ignore_ascii_case("json");
    if extension.eq_ignore_ascii_case("toml") || may_be_toml && begins_as_toml() {
        StudyText::read(path)?.method()?;
    }
    Err(ShowError::Kind {
        path: path.to_owned(),
        found: FileKind::Unknown.to_string(),
    })
}
