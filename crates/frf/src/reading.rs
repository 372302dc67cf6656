//! What was read from a file of functions, whatever its format.

use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;

use super::skipped::{SkippedDatasets, SkippedFunction, in_words};
use super::summary::{FileSummary, StatedBy, Statements, coherence_noise};
use super::{Coherence, Dof, Frf, FrfError, FrfSet, UnitStatement, without_phase};

/// What was read from a file.
#[derive(Debug, Clone, PartialEq)]
pub struct FrfReading {
    pub(super) path: PathBuf,
    pub(super) functions: Vec<Frf>,
    /// Ordinary coherences in the file's order.
    pub coherences: Vec<Coherence>,
    /// Averages, and who states them.
    pub(super) averages: Option<(f64, StatedBy)>,
    /// Response and reference of the functions that are in the file but were not asked for.
    pub not_selected: BTreeSet<(Dof, Dof)>,
    /// Data sets 58 that hold something else than a frequency response function or an ordinary coherence.
    pub skipped_functions: Vec<SkippedFunction>,
    /// Data sets that are neither functions (58) nor units (164).
    pub skipped_datasets: Vec<SkippedDatasets>,
    pub(super) statements: Statements,
    /// Files of the coherences, with how many each has, in their order; nothing where all are of this file.
    pub(super) coherence_files: Vec<(PathBuf, usize)>,
    /// What was found in which array of a file of arrays.
    pub(super) taken: Vec<(&'static str, String)>,
}

impl FrfReading {
    /// The functions in the file's order, as receptances in SI units.
    #[must_use]
    pub fn functions(&self) -> &[Frf] {
        &self.functions
    }

    /// What was found in which array of a file of arrays: such as functions in `H`; nothing for other files.
    #[must_use]
    pub fn taken(&self) -> &[(&'static str, String)] {
        &self.taken
    }

    /// The number of averages behind the functions, where the caller or the file states it.
    #[must_use]
    pub fn averages(&self) -> Option<f64> {
        self.averages.map(|(averages, _)| averages)
    }

    /// Whether the file (or the caller) states the units of every function; where it does not, SI was assumed.
    #[must_use]
    pub fn units_are_stated(&self) -> bool {
        self.statements.have_units()
    }

    /// What its user is told where nobody states the units.
    #[must_use]
    pub fn units_warning(&self) -> Option<String> {
        let units = &self.statements.units;
        let of_some = match units.iter().any(|own| *own != UnitStatement::Assumed) {
            true => " for some of its functions",
            false => "",
        };
        (!self.units_are_stated()).then(|| {
            format!(
                "{}: states no units{of_some}, so SI units are assumed; state units beside frf if they are others",
                self.path.display()
            )
        })
    }

    /// What its user is told where no function has a phase, so that magnitudes may have been saved alone.
    #[must_use]
    pub fn phase_warning(&self) -> Option<String> {
        let why = without_phase(self.functions.iter().map(Frf::receptance))?;
        Some(format!("{}: {why}", self.path.display()))
    }

    /// What was read, and by whose word the values are what they were taken for.
    #[must_use]
    pub fn summary(&self) -> FileSummary {
        let Statements {
            formats,
            quantities,
            units,
            ..
        } = self.statements.clone();
        FileSummary {
            path: self.path.clone(),
            functions: self.functions.len(),
            left_out: self.not_selected.len(),
            formats,
            quantities,
            units,
            coherences: self.coherences.len(),
            averages: self.averages,
            coherence_noise: self
                .averages()
                .and_then(|averages| coherence_noise(&self.coherences, averages)),
        }
    }

    /// The functions as one set, with the coherences that belong to them.
    ///
    /// # Errors
    /// [`FrfError::InFile`] around what [`FrfSet::new`] and [`FrfSet::with_coherences`] refuse.
    pub fn into_set(self) -> Result<FrfSet, FrfError> {
        let averages = self.averages();
        let set = match self.functions.is_empty() && !self.not_selected.is_empty() {
            true => Err(FrfError::NoneSelected {
                wanted: Vec::new(),
                present: self.not_selected.iter().copied().collect(),
            }),
            false if self.functions.is_empty() && !self.coherences.is_empty() => {
                Err(FrfError::OnlyCoherences)
            }
            false if self.functions.is_empty() && self.has_skipped() => {
                Err(FrfError::OnlyOtherDatasets {
                    found: self.skipped().join(", "),
                })
            }
            false => FrfSet::new(self.functions),
        };
        let in_file = |path: &PathBuf, source| FrfError::InFile {
            path: path.clone(),
            source: Box::new(source),
        };
        let mut set = set
            .and_then(|set| set.with_coherences(Vec::new(), averages))
            .map_err(|source| in_file(&self.path, source))?;
        let all = [(self.path, self.coherences.len())];
        let files = match self.coherence_files.is_empty() {
            true => &all[..],
            false => &self.coherence_files,
        };
        let mut coherences = self.coherences.into_iter();
        for (path, count) in files {
            let own = coherences.by_ref().take(*count).collect();
            set = set
                .with_coherences(own, averages)
                .map_err(|source| in_file(path, source))?;
        }
        Ok(set.knowing_of(self.not_selected))
    }

    /// Takes the coherences of another file, too.
    fn extend_coherences(&mut self, path: PathBuf, coherences: Vec<Coherence>) {
        if self.coherence_files.is_empty() {
            let own = (self.path.clone(), self.coherences.len());
            self.coherence_files.push(own);
        }
        self.coherence_files.push((path, coherences.len()));
        self.coherences.extend(coherences);
    }

    /// Whether it has data sets that were passed over.
    fn has_skipped(&self) -> bool {
        !(self.skipped_functions.is_empty() && self.skipped_datasets.is_empty())
    }

    /// What was passed over in a universal file, a line for each kind: such as `3 × time response (data set 58)`.
    #[must_use]
    pub fn skipped(&self) -> Vec<String> {
        in_words(&self.skipped_functions, &self.skipped_datasets)
    }

    /// The functions of several files as those of one, such as files with one reference each.
    ///
    /// # Errors
    /// [`FrfError::NoFunctions`] without a file, [`FrfError::InBothFiles`], [`FrfError::AveragesDiffer`], or
    /// [`FrfError::InFile`] around [`FrfError::DifferingFrequencyAxes`] or [`FrfError::DifferingLineCounts`].
    pub fn joined(readings: Vec<Self>) -> Result<Self, FrfError> {
        let mut owners: BTreeMap<(Dof, Dof), PathBuf> = BTreeMap::new();
        let mut readings = readings.into_iter();
        let mut all = readings.next().ok_or(FrfError::NoFunctions)?;
        let pairs = |reading: &Self| -> Vec<(Dof, Dof)> {
            let functions = reading.functions.iter();
            functions
                .map(|own| (own.response(), own.reference()))
                .collect()
        };
        owners.extend(pairs(&all).into_iter().map(|pair| (pair, all.path.clone())));
        for next in readings {
            for pair in pairs(&next) {
                if let Some(first) = owners.insert(pair, next.path.clone()) {
                    return Err(FrfError::InBothFiles {
                        response: pair.0,
                        reference: pair.1,
                        first,
                        second: next.path,
                    });
                }
            }
            // one function of each file is enough here; a set looks at all
            if let (Some(first), Some(second)) = (all.functions.first(), next.functions.first()) {
                FrfSet::new(vec![first.clone(), second.clone()]).map_err(|source| {
                    FrfError::InFile {
                        path: next.path.clone(),
                        source: Box::new(source),
                    }
                })?;
            }
            all.agree_on_averages(&next)?;
            all.functions.extend(next.functions);
            all.extend_coherences(next.path, next.coherences);
            all.not_selected.extend(next.not_selected);
            all.skipped_functions.extend(next.skipped_functions);
            all.skipped_datasets.extend(next.skipped_datasets);
            all.statements.extend(next.statements);
        }
        Ok(all)
    }

    /// The same functions with the coherences of another file; functions that it has as well stay out.
    ///
    /// # Errors
    /// [`FrfError::NoCoherence`], [`FrfError::AveragesDiffer`].
    pub fn with_coherences_of(mut self, other: Self) -> Result<Self, FrfError> {
        if other.coherences.is_empty() {
            return Err(FrfError::NoCoherence { path: other.path });
        }
        self.agree_on_averages(&other)?;
        self.extend_coherences(other.path, other.coherences);
        Ok(self)
    }

    /// Takes the averages of another file where this one states none.
    fn agree_on_averages(&mut self, other: &Self) -> Result<(), FrfError> {
        match (self.averages, other.averages) {
            (Some((first, _)), Some((second, _))) if first != second => {
                Err(FrfError::AveragesDiffer {
                    path: other.path.clone(),
                    first,
                    second,
                })
            }
            (first, second) => {
                self.averages = first.or(second);
                Ok(())
            }
        }
    }
}
