//! Receptances between labelled degrees of freedom, as matrices line by line.

use std::path::Path;

use num_complex::Complex64;

use super::super::error::IdentifyError;
use super::reader::in_file;
use bolted_joint_frf::structure::{ComplexMatrix, ModalModel};
use bolted_joint_frf::{Dof, FrfSet};

/// Receptances between labelled DOFs, and which of them were measured independently of the others.
pub(super) struct Labelled {
    labels: usize,
    /// Each entry of the matrix over all lines, column by column.
    functions: Vec<Vec<Complex64>>,
    /// Empty where the receptances come from modes.
    pub(super) measured: Vec<(usize, usize)>,
    /// σ²/|H|² of each of `measured` at each line, where coherence says it.
    pub(super) relative_variance: Option<Vec<Vec<f64>>>,
    /// Entries on and above the diagonal that come from modes because they were not measured.
    pub(super) from_modes: Vec<(usize, usize)>,
}

/// Whether every pair of labels has to be there.
#[derive(Clone, Copy)]
pub(super) enum Completeness<'m> {
    All,
    /// Only one; what is missing is not a number.
    Any,
    /// Every one, but those that were not measured come from modes.
    WithModes(&'m ModalModel),
}

/// Functions of a set between all `labels`; `path` is its file.
pub(super) fn labelled_functions(
    set: &FrfSet,
    labels: &[Dof],
    completeness: Completeness<'_>,
    path: &Path,
) -> Result<Labelled, IdentifyError> {
    let mut measured = Vec::new();
    let mut from_modes = Vec::new();
    let mut functions = Vec::with_capacity(labels.len() * labels.len());
    let mut missing = Vec::new();
    for (column, &reference) in labels.iter().enumerate() {
        for (row, &response) in labels.iter().enumerate() {
            match set.receptance(response, reference) {
                Ok(receptance) => {
                    if !receptance.is_reciprocal() {
                        measured.push((row, column));
                    }
                    functions.push(receptance.values().to_vec());
                }
                Err(error) => match completeness {
                    Completeness::WithModes(modes) => {
                        let found = modes.receptance(response, reference, set.frequency_hz());
                        functions.push(found.map_err(|modal| {
                            IdentifyError::NeitherMeasuredNorModal {
                                frf: Box::new(in_file(path, error)),
                                modal: Box::new(modal),
                            }
                        })?);
                        if row <= column {
                            from_modes.push((row, column));
                        }
                    }
                    Completeness::All | Completeness::Any => {
                        missing.push((row, column, error));
                        functions.push(vec![Complex64::new(f64::NAN, f64::NAN); set.line_count()]);
                    }
                },
            }
        }
    }
    // A label without any function is a mistake, whatever the others have.
    let is_used = |label: usize| {
        let mut pairs = measured.iter();
        pairs.any(|&(row, column)| row == label || column == label)
    };
    let fatal = missing.into_iter().find(|&(row, column, _)| {
        matches!(completeness, Completeness::All) || !is_used(row) || !is_used(column)
    });
    match fatal {
        Some((_, _, error)) => Err(in_file(path, error)),
        None => Ok(Labelled {
            labels: labels.len(),
            functions,
            relative_variance: relative_variances(set, labels, &measured),
            measured,
            from_modes,
        }),
    }
}

/// σ²/|H|² of each measured entry at each line by its coherence, if every one has coherence and the averages are known.
pub(super) fn relative_variances(
    set: &FrfSet,
    labels: &[Dof],
    measured: &[(usize, usize)],
) -> Option<Vec<Vec<f64>>> {
    measured
        .iter()
        .map(|&(row, column)| set.relative_variance(labels[row], labels[column]))
        .collect()
}

impl Labelled {
    /// Those that modes give between all `labels`.
    pub(super) fn of_modes(
        modes: &ModalModel,
        labels: &[Dof],
        frequency_hz: &[f64],
    ) -> Result<Self, IdentifyError> {
        let mut functions = Vec::with_capacity(labels.len() * labels.len());
        for &reference in labels {
            for &response in labels {
                functions.push(modes.receptance(response, reference, frequency_hz)?);
            }
        }
        Ok(Self {
            labels: labels.len(),
            functions,
            measured: Vec::new(),
            relative_variance: None,
            from_modes: Vec::new(),
        })
    }

    /// An entry over all lines.
    pub(super) fn function(&self, row: usize, column: usize) -> &[Complex64] {
        &self.functions[column * self.labels + row]
    }

    /// The matrix at a line.
    pub(super) fn matrix(&self, line: usize) -> ComplexMatrix {
        let values = self.functions.iter().map(|function| function[line]);
        ComplexMatrix::from_iterator(self.labels, self.labels, values)
    }

    /// The matrix at each line.
    pub(super) fn matrices(&self) -> Vec<ComplexMatrix> {
        let lines = self.functions.first().map_or(0, Vec::len);
        (0..lines).map(|line| self.matrix(line)).collect()
    }

    /// √(Σ|H_modal − H|²/Σ|H|²) over the measured entries that the modes have, too; `None` if they have none.
    pub(super) fn deviation_of(
        &self,
        modes: &ModalModel,
        labels: &[Dof],
        frequency_hz: &[f64],
    ) -> Option<f64> {
        let (mut difference, mut size) = (0.0, 0.0);
        for &(row, column) in &self.measured {
            let modal = modes.receptance(labels[row], labels[column], frequency_hz);
            for (modal, value) in modal.iter().flatten().zip(self.function(row, column)) {
                difference += (modal - value).norm_sqr();
                size += value.norm_sqr();
            }
        }
        (size > 0.0).then(|| (difference / size).sqrt())
    }

    /// The upper triangle column by column, H_pq and H_qp replaced by their mean: by reciprocity they are one number, measured
    /// twice.
    pub(super) fn symmetrised(self) -> Vec<Vec<Complex64>> {
        let labels = self.labels;
        let mut functions = self.functions;
        let mut triangle = Vec::with_capacity(labels * (labels + 1) / 2);
        for column in 0..labels {
            for row in 0..=column {
                let mut upper = std::mem::take(&mut functions[column * labels + row]);
                let lower = std::mem::take(&mut functions[row * labels + column]);
                for (value, other) in upper.iter_mut().zip(lower) {
                    *value = 0.5 * (*value + other);
                }
                triangle.push(upper);
            }
        }
        triangle
    }
}
