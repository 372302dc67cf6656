//! Receptances between labelled degrees of freedom, as matrices line by line.

use std::path::Path;

use num_complex::Complex64;

use super::super::error::IdentifyError;
use super::super::study::FrfFile;
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

/// Functions of a set between all `labels`, which is in `file`, without the accelerometer that moved with the response.
pub(super) fn labelled_functions(
    set: &FrfSet,
    labels: &[Dof],
    completeness: Completeness<'_>,
    file: &FrfFile,
) -> Result<Labelled, IdentifyError> {
    let path = file.path.as_path();
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
    if let Some((_, _, error)) = fatal {
        return Err(in_file(path, error));
    }
    let known = file
        .accelerometer
        .map(|accelerometer| accelerometer.mass_kg);
    if let Some(mass_kg) = known.filter(|&mass_kg| mass_kg > 0.0) {
        let all = Unloaded {
            set,
            labels,
            measured: &measured,
            path,
        };
        functions = all.without(mass_kg, &functions)?;
    }
    Ok(Labelled {
        labels: labels.len(),
        functions,
        relative_variance: relative_variances(set, labels, &measured),
        measured,
        from_modes,
    })
}

/// Functions that were measured with an accelerometer which moved from response to response.
struct Unloaded<'s> {
    set: &'s FrfSet,
    labels: &'s [Dof],
    measured: &'s [(usize, usize)],
    path: &'s Path,
}

impl Unloaded<'_> {
    /// h_ij = z_ij/(1 + ω² m z_ii), z being what was measured with a mass m at the response i; every function column by column.
    fn without(
        &self,
        mass_kg: f64,
        functions: &[Vec<Complex64>],
    ) -> Result<Vec<Vec<Complex64>>, IdentifyError> {
        let count = self.labels.len();
        let places = (0..count).flat_map(|column| (0..count).map(move |row| (row, column)));
        let of = |((row, column), function): ((usize, usize), &Vec<Complex64>)| {
            // a function that follows from its transpose was measured at the other one
            let response = match (
                self.measured.contains(&(row, column)),
                self.measured.contains(&(column, row)),
            ) {
                (true, _) => row,
                (false, true) => column,
                (false, false) => return Ok(function.clone()),
            };
            if self.labels[response].direction().is_rotation() {
                return Ok(function.clone());
            }
            if !self.measured.contains(&(response, response)) {
                return Err(IdentifyError::NoDrivePoint {
                    path: self.path.to_owned(),
                    point: self.labels[response],
                    mass_kg,
                });
            }
            let drive_point = &functions[response * count + response];
            let lines = function.iter().zip(drive_point);
            let lines = lines.zip(self.set.frequency_hz());
            let free = lines.map(|((value, drive_point), hz)| {
                let omega = std::f64::consts::TAU * hz;
                value / (1.0 + omega * omega * mass_kg * drive_point)
            });
            Ok(free.collect())
        };
        places.zip(functions).map(of).collect()
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
        .map(|&(row, column)| {
            let own = set.relative_variance(labels[row], labels[column]);
            own.map(<[f64]>::to_vec)
        })
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
