//! The files that a prediction is asked for: written all or none.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use super::super::error::CliError;
use super::super::output::write_files;

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
        write_files(&files)
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

/// Refuses options that belong to another method.
pub(super) fn refuse(
    asked: &[(&'static str, Option<&PathBuf>)],
    expected: &'static str,
) -> Result<(), CliError> {
    let mut asked = asked.iter();
    match asked.find_map(|(option, path)| Some((*option, (*path)?))) {
        Some((option, path)) => Err(CliError::option(option, path.display(), expected)),
        None => Ok(()),
    }
}
