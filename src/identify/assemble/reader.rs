//! Reading of files of functions, with a memory of what had to be assumed.

use std::path::Path;

use super::super::error::IdentifyError;
use super::super::study::FrfFile;
use crate::frf::{Dof, FrfError, FrfSet, ReadOptions, Selection, read_frfs};

/// Reads universal files and remembers what it had to assume.
#[derive(Default)]
pub(super) struct Reader {
    pub(super) warnings: Vec<String>,
}

impl Reader {
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
        let reading = read_frfs(&file.path, &options)?;
        if !reading.units_are_stated() {
            self.warnings.push(format!(
                "{}: states no units, so SI units are assumed; state units beside frf if they are others",
                file.path.display()
            ));
        }
        if !reading.coherences().is_empty() && reading.averages().is_none() {
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
