//! Reading of files of functions, with a memory of what had to be assumed.

use std::path::Path;

use super::super::error::IdentifyError;
use super::super::from_modes::FromModes;
use super::super::study::FrfFile;
use super::super::watch::Watch;
use bolted_joint_frf::{
    Dof, FileSummary, FrfError, FrfSet, ReadOptions, Selection, read_frfs_watched,
};

/// Reads files of functions and remembers what they state and what it had to assume.
#[derive(Default)]
pub(super) struct Reader<'watch> {
    pub(super) watch: Option<&'watch dyn Watch>,
    pub(super) warnings: Vec<String>,
    pub(super) from_modes: Vec<FromModes>,
    /// Of each file that was read, each once.
    pub(super) files: Vec<FileSummary>,
}

impl Reader<'_> {
    /// The functions between `dofs` in a band (Hz); of a large file the rest is not held.
    pub(super) fn read(
        &mut self,
        file: &FrfFile,
        dofs: &[Dof],
        [from_hz, to_hz]: [f64; 2],
    ) -> Result<FrfSet, IdentifyError> {
        let options = ReadOptions {
            quantity: file.quantity,
            units: file.units,
            averages: file.averages,
            selection: Selection::between(dofs.iter().copied()).within(from_hz, to_hz),
        };
        let watch = |bytes, of| {
            if let Some(watch) = self.watch {
                watch.read(&file.path, bytes, of);
            }
        };
        let reading = read_frfs_watched(&file.path, &options, &watch)?;
        let summary = reading.summary();
        if !self.files.contains(&summary) {
            self.files.push(summary);
        }
        if !reading.units_are_stated() {
            self.warnings.push(format!(
                "{}: states no units, so SI units are assumed; state units beside frf if they are others",
                file.path.display()
            ));
        }
        if !reading.coherences.is_empty() && reading.averages().is_none() {
            self.warnings.push(format!(
                "{}: coherence is not used, since the number of averages is not known; state averages beside frf",
                file.path.display()
            ));
        }
        Ok(reading.into_set()?)
    }
}

pub(super) fn in_file(path: &Path, source: FrfError) -> IdentifyError {
    IdentifyError::Frf(FrfError::InFile {
        path: path.to_owned(),
        source: Box::new(source),
    })
}
