//! Reading of files of functions, with a memory of what had to be assumed.

use std::path::Path;

use super::super::error::IdentifyError;
use super::super::from_modes::FromModes;
use super::super::study::FrfFile;
use super::super::watch::Watch;
use super::soundness::Unsound;
use bolted_joint_frf::{
    Dof, FileSummary, FrfError, FrfReading, FrfSet, ReadOptions, Selection, read_frfs_watched,
};
use bolted_joint_study::LineChoice;

/// Reads files of functions and remembers what they state and what it had to assume.
#[derive(Default)]
pub(super) struct Reader<'watch> {
    pub(super) watch: Option<&'watch dyn Watch>,
    pub(super) warnings: Vec<String>,
    pub(super) reasons_against: Vec<String>,
    pub(super) from_modes: Vec<FromModes>,
    /// Lines to use of what is read; all where nothing is said.
    pub(super) lines: Option<LineChoice>,
    /// Of each file that was read, each once.
    pub(super) files: Vec<FileSummary>,
}

impl Reader<'_> {
    /// Remembers what is wrong with a set.
    pub(super) fn note(&mut self, unsound: Unsound) {
        self.warnings.extend(unsound.warnings);
        self.reasons_against.extend(unsound.turned);
    }

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
        let functions = file.function_files();
        let functions = functions
            .map(|path| self.one(path, &options))
            .collect::<Result<_, _>>()?;
        let reading = FrfReading::joined(functions)?;
        // all of a file's coherences, so that those of other points are told from none
        let options = ReadOptions {
            selection: Selection::everything().within(from_hz, to_hz),
            ..options
        };
        let coherences = file.coherence.iter();
        let coherences = coherences
            .map(|path| self.one(path, &options))
            .collect::<Result<_, _>>()?;
        let (set, told) = reading
            .into_set_beside(coherences)
            .map_err(|refused| refused.asked_for(dofs))?;
        self.warnings.extend(told);
        match &self.lines {
            Some(lines) => set
                .thinned(&lines.bands_hz, lines.every)
                .map_err(|source| in_file(&file.path, source)),
            None => Ok(set),
        }
    }

    /// One of the files of a measurement.
    fn one(&mut self, path: &Path, options: &ReadOptions) -> Result<FrfReading, FrfError> {
        let watch = |bytes, of| {
            if let Some(watch) = self.watch {
                watch.read(path, bytes, of);
            }
        };
        let reading = read_frfs_watched(path, options, &watch)?;
        let summary = reading.summary();
        if !self.files.contains(&summary) {
            self.files.push(summary);
        }
        Ok(reading)
    }
}

pub(super) fn in_file(path: &Path, source: FrfError) -> IdentifyError {
    IdentifyError::Frf(FrfError::InFile {
        path: path.to_owned(),
        source: Box::new(source),
    })
}
