//! Another kind of file than a command takes: the message names the command that takes it.

use std::fs;
use std::path::Path;

use bolted_joint::show::{FileKind, command_for};

use super::error::CliError;

/// Refuses a file that is not there, or of a kind which the command does not take; what is of no known kind and may be meant is left
/// to its reader's message.
pub(super) fn expect(
    path: &Path,
    expected: &'static str,
    takes: impl Fn(FileKind) -> bool,
) -> Result<FileKind, CliError> {
    if let Err(source) = fs::metadata(path) {
        return Err(CliError::Unreadable {
            path: path.to_owned(),
            source,
            expected,
        });
    }
    expect_kind(path, expected, takes)
}

/// The same for a command whose files have one reader, which knows best what to say of one that is not there.
fn expect_kind(
    path: &Path,
    expected: &'static str,
    takes: impl Fn(FileKind) -> bool,
) -> Result<FileKind, CliError> {
    let kind = FileKind::of(path);
    if takes(kind) || kind == FileKind::Unknown && !is_text_of_another_kind(path) {
        return Ok(kind);
    }
    let instead = match (kind, command_for(kind, path)) {
        (FileKind::Pipe, _) => "a pipe cannot be read twice: save it as a file first".to_owned(),
        (_, Some(command)) => format!("`{command}` takes it"),
        (_, None) => "check the path".to_owned(),
    };
    Err(CliError::Kind {
        path: path.to_owned(),
        found: kind.to_string(),
        expected,
        instead,
    })
}

/// Whether a file has text and a name that say it is none of this program's: what a reader would say of it helps nobody.
fn is_text_of_another_kind(path: &Path) -> bool {
    let has_own_name = path.extension().is_none_or(|extension| {
        let known = ["toml", "json"].iter();
        known
            .into_iter()
            .any(|own| extension.eq_ignore_ascii_case(own))
    });
    let text = fs::read_to_string(path);
    !has_own_name && text.is_ok_and(|text| !text.trim().is_empty())
}

/// A study.
pub(super) fn expect_study(path: &Path) -> Result<(), CliError> {
    expect_kind(path, "a study (TOML)", |kind| {
        matches!(kind, FileKind::Study(_))
    })
    .map(|_| ())
}

/// A joint file.
pub(super) fn expect_joint_file(path: &Path) -> Result<(), CliError> {
    expect_kind(path, "a joint file (JSON)", |kind| {
        matches!(
            kind,
            FileKind::JointFile | FileKind::OtherJson | FileKind::List
        )
    })
    .map(|_| ())
}

/// Draws that `identify` or `predict` has made.
pub(super) fn expect_draws(path: &Path) -> Result<(), CliError> {
    expect_kind(
        path,
        "a file of draws (JSON), as `identify --draws` writes it",
        |kind| matches!(kind, FileKind::Draws | FileKind::OtherJson),
    )
    .map(|_| ())
}
