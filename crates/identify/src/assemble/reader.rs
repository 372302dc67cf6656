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
        let mut reading = FrfReading::joined(functions)?;
        // all of a file's coherences, so that those of other points are told from none
        let options = ReadOptions {
            selection: Selection::everything().within(from_hz, to_hz),
            ..options
        };
        let mut of_files: Vec<(&Path, Vec<(Dof, Dof)>)> = Vec::new();
        for path in &file.coherence {
            let own = self.one(path, &options)?;
            let pairs = own.coherences.iter();
            let pairs = pairs.map(|one| (one.response, one.reference)).collect();
            of_files.push((path, pairs));
            reading = reading.with_coherences_of(own)?;
        }
        self.warnings.extend(reading.units_warning());
        self.warnings.extend(reading.phase_warning());
        if !reading.coherences.is_empty() && reading.averages().is_none() {
            let path = file.coherence.first().unwrap_or(&file.path);
            self.warnings.push(format!(
                "{}: coherence is not used, since the number of averages is not known; state averages beside frf",
                path.display()
            ));
        }
        let left_out = reading.not_selected.clone();
        let set = reading
            .into_set()
            .map_err(|refused| refused.asked_for(dofs))?;
        for (path, pairs) in of_files {
            let belongs = |&(response, reference): &(Dof, Dof)| {
                let read = set.functions().map(|own| (own.0, own.1));
                read.chain(left_out.iter().copied()).any(|(p, q)| {
                    [p, p.flipped()].contains(&response) && [q, q.flipped()].contains(&reference)
                })
            };
            if !pairs.iter().any(belongs) {
                self.warnings.push(format!(
                    "{}: none of its coherences belongs to a function of {}; correct the degrees of freedom in one of the two",
                    path.display(),
                    file.path.display()
                ));
            }
        }
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
