//! The files that a prediction is asked for: checked before anything is computed, written all or none.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use super::super::error::CliError;
use super::super::output::check_output;
use bolted_joint_files::whole_file;

/// Contents for paths.
pub(super) struct Outputs {
    files: Vec<(PathBuf, String)>,
}

impl Outputs {
    pub(super) fn new() -> Self {
        Self { files: Vec::new() }
    }

    /// One more file, where it is asked for.
    pub(super) fn add(&mut self, path: Option<&PathBuf>, contents: impl FnOnce() -> String) {
        if let Some(path) = path {
            self.files.push((path.clone(), contents()));
        }
    }

    /// Writes every file or, if one cannot be written, none.
    pub(super) fn write(&self) -> Result<(), CliError> {
        let files = self.files.iter();
        let files: Vec<(&Path, &[u8])> = files
            .map(|(path, contents)| (path.as_path(), contents.as_bytes()))
            .collect();
        whole_file::write_all(&files)
            .map_err(|(path, source)| CliError::Unwritable { path, source })
    }

    /// A line for each.
    pub(super) fn written(&self) -> String {
        let mut text = String::new();
        for (path, _) in &self.files {
            // writing to a String cannot fail
            let _ = writeln!(text, "wrote {}", path.display());
        }
        text
    }
}

/// Refuses paths that cannot be written, name a file twice or end otherwise than the option asks for.
pub(super) fn check(
    study: &PathBuf,
    asked: &[(&'static str, Option<&PathBuf>, &[&str], &'static str)],
) -> Result<(), CliError> {
    let mut taken = vec![study];
    for (option, path, endings, expected) in asked {
        let Some(path) = *path else { continue };
        let extension = path.extension().and_then(|extension| extension.to_str());
        let fits = endings.is_empty() || extension.is_some_and(|found| endings.contains(&found));
        if !fits {
            return Err(CliError::option(option, path.display(), expected));
        }
        check_output(path, &taken)?;
        taken.push(path);
    }
    Ok(())
}

/// Refuses options that belong to another method.
pub(super) fn refuse(
    asked: &[(&'static str, Option<&PathBuf>)],
    expected: &'static str,
) -> Result<(), CliError> {
    match asked
        .iter()
        .find_map(|(option, path)| Some((*option, (*path)?)))
    {
        Some((option, path)) => Err(CliError::option(option, path.display(), expected)),
        None => Ok(()),
    }
}
