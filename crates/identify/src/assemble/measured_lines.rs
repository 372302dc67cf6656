//! Which lines a test of an assembly has, where its study does not say it: those of what was measured before.

use super::super::study::{FrfFile, Source, Study, Substructure};
use bolted_joint_frf::{ReadOptions, Selection, read_frfs};

impl Study {
    /// Frequencies within the study's range, Hz, of the first of its files that is there and can be read: the assembly's, then A's
    /// and B's. `None` where there is none.
    #[must_use]
    pub fn measured_frequencies_hz(&self) -> Option<Vec<f64>> {
        let of_substructure = |substructure| match substructure {
            &Substructure::Measured {
                source: Source::Frf { ref file, .. },
                ..
            } => Some(file),
            _ => None,
        };
        let parts = [&self.a, &self.b].into_iter().filter_map(of_substructure);
        let mut files = std::iter::once(&self.assembly).chain(parts);
        files.find_map(|file| self.frequencies_of(file))
    }

    fn frequencies_of(&self, file: &FrfFile) -> Option<Vec<f64>> {
        let [from_hz, to_hz] = self.frequency_range_hz;
        let options = ReadOptions {
            quantity: file.quantity,
            units: file.units,
            averages: file.averages,
            selection: Selection::everything().within(from_hz, to_hz),
        };
        let set = read_frfs(&file.path, &options).ok()?.into_set().ok()?;
        let set = set.restricted_to(from_hz, to_hz).ok()?;
        Some(set.frequency_hz().to_vec())
    }
}
