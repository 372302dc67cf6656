//! Reads files of functions with what a study says of them.

use bolted_joint_frf::{FrfError, FrfReading, FrfSet, Quantity, ReadOptions, read_frfs};
use bolted_joint_study::{LineChoice, Paths, StudyError, UnitsTable};

use crate::study::Reader;

/// Frequencies that are the same, in parts.
const SAME: f64 = 1e-5;

/// A file of functions, and what the study says of it.
pub(crate) struct FileOfFunctions<'t> {
    pub(crate) paths: &'t Paths,
    pub(crate) coherence: Option<&'t Paths>,
    pub(crate) averages: Option<f64>,
    pub(crate) quantity: Option<Quantity>,
    pub(crate) units: Option<&'t UnitsTable>,
}

/// What was read of it at the lines that are used, and what had to be assumed or is missing.
pub(crate) struct Functions {
    pub(crate) set: FrfSet,
    pub(crate) assumed: Vec<String>,
}

impl Reader<'_> {
    pub(crate) fn functions(
        &self,
        key: &str,
        file: &FileOfFunctions<'_>,
        lines: &LineChoice,
    ) -> Result<Functions, StudyError> {
        if let Some(found) = file.averages {
            let key = format!("{key}.averages");
            (self.study).within(&key, found, 1.0..=f64::MAX, "a number of at least 1")?;
        }
        let options = ReadOptions {
            quantity: file.quantity,
            units: (self.study).units(format_args!("{key}.units"), file.units)?,
            averages: file.averages,
            ..ReadOptions::default()
        };
        let read = |paths: &Paths| -> Result<Vec<FrfReading>, FrfError> {
            let paths = paths.iter();
            let all = paths.map(|path| read_frfs(self.study.resolved(path), &options));
            all.collect()
        };
        let of_coherence = || file.coherence.map_or_else(|| Ok(Vec::new()), read);
        let (set, assumed) = read(file.paths)
            .and_then(FrfReading::joined)
            .and_then(|functions| functions.into_set_beside(of_coherence()?))
            .map_err(StudyError::of_file)?;
        let refused = |source| {
            let key = format!("{key}.frf");
            StudyError::model(self.study.path(), Some(&key), source)
        };
        let [from_hz, to_hz] = lines.range_hz;
        let set = set
            .restricted_to(from_hz, to_hz)
            .map_err(refused)?
            .thinned(&lines.bands_hz, lines.every)
            .map_err(refused)?;
        Ok(Functions { set, assumed })
    }

    pub(crate) fn same_lines(
        &self,
        key: &str,
        found: &[f64],
        expected: &[f64],
    ) -> Result<(), StudyError> {
        let mut pairs = found.iter().zip(expected);
        let other = pairs.find(|(one, other)| (*one - *other).abs() > SAME * other.abs());
        let are_same = found.len() == expected.len() && other.is_none();
        let at = other
            .map(|(one, other)| format!("; the first that differs is {one} Hz for {other} Hz"));
        let ends = |all: &[f64]| match (all.first(), all.last()) {
            (Some(first), Some(last)) => format!("{} lines from {first} to {last} Hz", all.len()),
            _ => "no lines".to_owned(),
        };
        self.study.ensure(
            are_same,
            key,
            ends(found),
            format_args!(
                "the lines of the other files, {}{}",
                ends(expected),
                at.unwrap_or_default()
            ),
        )
    }
}
