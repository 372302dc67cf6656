//! Receptances between labelled degrees of freedom, as matrices line by line.

use std::path::Path;

use num_complex::Complex64;

use super::super::error::IdentifyError;
use super::reader::in_file;
use crate::frf::{Dof, FrfSet};
use crate::structure::{ComplexMatrix, ModalModel};

/// Receptances between labelled DOFs: a matrix for each line, and which entries were measured independently of the others.
pub(super) struct Labelled {
    pub(super) matrices: Vec<ComplexMatrix>,
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
    let mut entries = Vec::with_capacity(labels.len() * labels.len());
    let mut missing = Vec::new();
    for (column, &reference) in labels.iter().enumerate() {
        for (row, &response) in labels.iter().enumerate() {
            match set.receptance(response, reference) {
                Ok(receptance) => {
                    if !receptance.is_reciprocal() {
                        measured.push((row, column));
                    }
                    entries.push(receptance.values().to_vec());
                }
                Err(error) => match completeness {
                    Completeness::WithModes(modes) => {
                        let found = modes.receptance(response, reference, set.frequency_hz());
                        entries.push(found.map_err(|modal| {
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
                        entries.push(vec![Complex64::new(f64::NAN, f64::NAN); set.line_count()]);
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
            matrices: matrices(labels.len(), set.line_count(), &entries),
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
            for (modal, matrix) in modal.iter().flatten().zip(&self.matrices) {
                difference += (modal - matrix[(row, column)]).norm_sqr();
                size += matrix[(row, column)].norm_sqr();
            }
        }
        (size > 0.0).then(|| (difference / size).sqrt())
    }

    /// Replaces H_pq and H_qp by their mean: by reciprocity they are one number, measured twice.
    pub(super) fn symmetrise(&mut self) {
        for matrix in &mut self.matrices {
            for column in 0..matrix.ncols() {
                for row in column + 1..matrix.nrows() {
                    let mean = 0.5 * (matrix[(row, column)] + matrix[(column, row)]);
                    matrix[(row, column)] = mean;
                    matrix[(column, row)] = mean;
                }
            }
        }
    }
}

/// One size×size matrix a line from entries in column-major order, each over all lines.
pub(super) fn matrices(
    size: usize,
    line_count: usize,
    entries: &[Vec<Complex64>],
) -> Vec<ComplexMatrix> {
    (0..line_count)
        .map(|line| {
            ComplexMatrix::from_iterator(size, size, entries.iter().map(|entry| entry[line]))
        })
        .collect()
}
