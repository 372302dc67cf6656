//! From a study to lines: reads the files, computes the beams, forms rotations, and puts all on one frequency axis.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

use nalgebra::DMatrix;
use num_complex::Complex64;

use crate::frf::{Dof, Frf, FrfError, FrfSet, ReadOptions, Selection, read_frfs};
use crate::structure::{Beam, BeamError, BeamPoint, ComplexMatrix, ModalModel, Motion, Partition};

use super::error::IdentifyError;
use super::lines::{Lines, MeasuredSubstructure, Repeats, independent};
use super::model::JointMatrices;
use super::study::{FrfFile, Rotation, Source, Study, Substructure};

/// Everything that the study names, line by line for each assembly, and what the user should know about the files.
pub(super) fn lines(study: &Study) -> Result<(Vec<Lines>, Vec<String>), IdentifyError> {
    let mut reader = Reader::default();
    let mut all = vec![assembly_lines(study, &mut reader)?];
    for further in &study.further {
        let its_study = Study {
            a: further.a.clone(),
            b: further.b.clone(),
            assembly: further.file.clone(),
            points: further.points.clone(),
            repeats: further.repeats.clone(),
            further: Vec::new(),
            ..study.clone()
        };
        let mut lines = assembly_lines(&its_study, &mut reader)?;
        // The same measurement of a substructure has the same errors in every assembly.
        for (earlier, earlier_study) in all.iter().zip(studies_before(study, all.len())) {
            let same_axis = earlier.frequency_hz.len() == lines.frequency_hz.len();
            if same_axis && earlier_study.0.is_same_measurement(&its_study.a) {
                lines.a_measured.clone_from(&earlier.a_measured);
            }
            let same_points = earlier.points == lines.points;
            if same_axis && same_points && earlier_study.1.is_same_measurement(&its_study.b) {
                lines.b_measured.clone_from(&earlier.b_measured);
            }
        }
        all.push(lines);
    }
    reader.warnings.sort();
    reader.warnings.dedup();
    Ok((all, reader.warnings))
}

/// A and B of the first `count` assemblies.
fn studies_before(study: &Study, count: usize) -> Vec<(&Substructure, &Substructure)> {
    let further = study.further.iter().map(|further| (&further.a, &further.b));
    std::iter::once((&study.a, &study.b))
        .chain(further)
        .take(count)
        .collect()
}

fn assembly_lines(study: &Study, reader: &mut Reader) -> Result<Lines, IdentifyError> {
    let [from_hz, to_hz] = study.frequency_range_hz;
    let path = &study.assembly.path;
    let in_file = |source| in_file(path, source);
    let assembly = reader
        .read(&study.assembly, &study.points, [from_hz, to_hz])?
        .restricted_to(from_hz, to_hz)
        .map_err(in_file)?;
    let axis = Axis {
        path,
        frequency_hz: assembly.frequency_hz(),
    };
    let points = &study.points;
    let labelled = labelled_functions(&assembly, points, Completeness::Any).map_err(in_file)?;
    let (labelled, repeats) = repeated(study, labelled, &axis, reader)?;
    let measured = labelled.measured;
    // Each function gives two real equations on each line; the joint file's band of validity needs two lines.
    let needed = study.model.unknowns().div_ceil(2 * measured.len()).max(2);
    if axis.frequency_hz.len() < needed {
        return Err(IdentifyError::TooFewLines {
            path: path.clone(),
            found: axis.frequency_hz.len(),
            from_hz: axis.first_hz(),
            to_hz: axis.last_hz(),
            needed,
            model: study.model,
            functions: measured.len(),
        });
    }
    let lines = Lines {
        assembly: labelled.matrices,
        measured,
        relative_variance: labelled.relative_variance,
        repeats,
        ..substructures(study, &axis, reader)?
    };
    Ok(lines)
}

/// The mean of repeated measurements of the assembly, and their scatter; the `first` where there are no others.
fn repeated(
    study: &Study,
    first: Labelled,
    axis: &Axis<'_>,
    reader: &mut Reader,
) -> Result<(Labelled, Option<Repeats>), IdentifyError> {
    if study.repeats.is_empty() {
        return Ok((first, None));
    }
    let mut all = vec![first];
    for file in &study.repeats {
        let in_file = |source| in_file(&file.path, source);
        let (from_hz, to_hz) = axis.ends();
        let set = reader
            .read(file, &study.points, [from_hz, to_hz])?
            .restricted_to(from_hz, to_hz)
            .map_err(in_file)?;
        axis.compare(&file.path, set.frequency_hz())?;
        all.push(labelled_functions(&set, &study.points, Completeness::Any).map_err(in_file)?);
    }
    let count = all.len() as f64;
    let measured = all[0].measured.clone();
    // A function that one of the repetitions lacks is not repeated: it stays out.
    let everywhere = |place: &(usize, usize)| all.iter().all(|one| one.measured.contains(place));
    let measured: Vec<(usize, usize)> = measured.into_iter().filter(everywhere).collect();
    let mut means = Vec::new();
    let mut scatter = Vec::new();
    for line in 0..axis.frequency_hz.len() {
        let sum = |sum: ComplexMatrix, one: &Labelled| sum + &one.matrices[line];
        let zero = ComplexMatrix::zeros(study.points.len(), study.points.len());
        let mean = all.iter().fold(zero, sum) / Complex64::from(count);
        let squares = |place: (usize, usize)| -> f64 {
            let differences = all
                .iter()
                .map(|one| one.matrices[line][place] - mean[place]);
            differences.map(|difference| difference.norm_sqr()).sum()
        };
        scatter.push(DMatrix::from_fn(mean.nrows(), mean.ncols(), |p, q| {
            squares((p, q))
        }));
        means.push(mean);
    }
    let repeats = Repeats {
        count: all.len() as u32,
        scatter,
    };
    // Repeats say themselves how far the measurements scatter.
    let mean = Labelled {
        matrices: means,
        measured,
        relative_variance: None,
    };
    Ok((mean, Some(repeats)))
}

/// The assembly's receptances as the study's substructures and `joint` make them: all pairs of its points.
///
/// # Errors
/// [`IdentifyError`] if the substructures' data cannot be used, or at an undamped resonance.
pub fn predict_assembly(
    study: &Study,
    joint: &JointMatrices,
    frequency_hz: &[f64],
) -> Result<FrfSet, IdentifyError> {
    let axis = Axis {
        path: &study.assembly.path,
        frequency_hz,
    };
    let lines = substructures(study, &axis, &mut Reader::default())?;
    let assembly = lines.regenerated(joint)?;
    let mut functions = Vec::new();
    for (row, &response) in study.points.iter().enumerate() {
        for (column, &reference) in study.points.iter().enumerate() {
            let values = assembly
                .iter()
                .map(|matrix| matrix[(row, column)])
                .collect();
            functions.push(Frf::new(
                response,
                reference,
                frequency_hz.to_vec(),
                values,
            )?);
        }
    }
    Ok(FrfSet::new(functions)?)
}

/// Lines of the study's first assembly as its substructures and `joint` make them, every pair of points measured.
///
/// # Errors
/// As [`predict_assembly`].
pub fn predict_lines(
    study: &Study,
    joint: &JointMatrices,
    frequency_hz: &[f64],
) -> Result<Lines, IdentifyError> {
    let axis = Axis {
        path: &study.assembly.path,
        frequency_hz,
    };
    let mut lines = substructures(study, &axis, &mut Reader::default())?;
    lines.assembly = lines.regenerated(joint)?;
    let count = study.points.len();
    lines.measured = (0..count)
        .flat_map(|column| (0..count).map(move |row| (row, column)))
        .collect();
    Ok(lines)
}

/// Lines without the assembly: what A and B contribute.
fn substructures(
    study: &Study,
    axis: &Axis<'_>,
    reader: &mut Reader,
) -> Result<Lines, IdentifyError> {
    let points = &study.points;
    let (a_joint, a_measured) = joint_and_points(study, "a", &[], axis, reader)?;
    let (b, b_measured) = joint_and_points(study, "b", points, axis, reader)?;
    Ok(Lines {
        frequency_hz: axis.frequency_hz.to_vec(),
        a_joint,
        b: b.iter()
            .map(|receptance| Partition::of(receptance, study.model.dofs()))
            .collect(),
        assembly: Vec::new(),
        points: points.clone(),
        measured: Vec::new(),
        relative_variance: None,
        repeats: None,
        a_measured,
        b_measured,
    })
}

/// The assembly's frequencies within the band, to which every other file has to agree.
struct Axis<'a> {
    path: &'a Path,
    frequency_hz: &'a [f64],
}

fn in_file(path: &Path, source: FrfError) -> IdentifyError {
    IdentifyError::Frf(FrfError::InFile {
        path: path.to_owned(),
        source: Box::new(source),
    })
}

/// Reads universal files and remembers what it had to assume.
#[derive(Default)]
struct Reader {
    warnings: Vec<String>,
}

impl Reader {
    /// The functions between `dofs` in a band (Hz); of a large file the rest is not held.
    fn read(
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

/// Receptance matrices of a substructure at each line: the joint's DOFs first, then `points`.
fn joint_and_points(
    study: &Study,
    key: &'static str,
    points: &[Dof],
    axis: &Axis<'_>,
    reader: &mut Reader,
) -> Result<(Vec<ComplexMatrix>, Option<Arc<MeasuredSubstructure>>), IdentifyError> {
    let joint_dofs = study.model.dofs();
    let substructure = if key == "a" { &study.a } else { &study.b };
    match substructure {
        Substructure::Beam {
            beam,
            joint_m,
            positions_m,
        } => {
            let dofs = beam_dofs(joint_dofs, *joint_m, points, positions_m);
            let receptances =
                beam_receptances(beam, &dofs, axis).map_err(|source| IdentifyError::Beam {
                    path: study.path.clone(),
                    key,
                    source,
                })?;
            Ok((receptances, None))
        }
        Substructure::Measured { source, y, theta } => {
            let (joint, transformation) = joint_labels(*y, theta.as_ref(), joint_dofs);
            let labels: Vec<Dof> = joint.iter().chain(points).copied().collect();
            let labelled = labelled_receptances(source, &labels, axis, reader)?;
            // (joint, points) = T (labels): H = T H_labels Tᵀ   (Tol 3.54)
            let (joint_dofs, joint_labels) = transformation.shape();
            let mut whole = DMatrix::zeros(joint_dofs + points.len(), labels.len());
            whole
                .view_mut((0, 0), (joint_dofs, joint_labels))
                .copy_from(&transformation.map(|value| value.re));
            for point in 0..points.len() {
                whole[(joint_dofs + point, joint_labels + point)] = 1.0;
            }
            let complex = whole.map(Complex64::from);
            let transposed = complex.transpose();
            let receptances = labelled
                .matrices
                .iter()
                .map(|receptance| &complex * receptance * &transposed)
                .collect();
            let measured = (!labelled.measured.is_empty()).then(|| {
                Arc::new(MeasuredSubstructure {
                    transformation: whole,
                    receptances: labelled.matrices,
                    measured: labelled.measured,
                    relative_variance: labelled.relative_variance,
                })
            });
            Ok((receptances, measured))
        }
    }
}

/// Labels of the measured DOFs from which the joint's follow, and the matrix that takes one to the other.
fn joint_labels(y: Dof, theta: Option<&Rotation>, joint_dofs: usize) -> (Vec<Dof>, ComplexMatrix) {
    match theta {
        Some(Rotation::Difference { points, difference }) if joint_dofs == 2 => {
            (points.to_vec(), difference.transformation())
        }
        Some(Rotation::Measured(theta)) if joint_dofs == 2 => {
            (vec![y, *theta], ComplexMatrix::identity(2, 2))
        }
        _ => (vec![y], ComplexMatrix::identity(1, 1)),
    }
}

/// The joint's DOFs on a beam, then its points, each with the sign of its label.
fn beam_dofs(
    joint_dofs: usize,
    joint_m: f64,
    points: &[Dof],
    positions_m: &BTreeMap<Dof, f64>,
) -> Vec<(BeamPoint, f64)> {
    let joint = [Motion::Translation, Motion::Rotation]
        .into_iter()
        .take(joint_dofs)
        .map(|motion| {
            let position_m = joint_m;
            (BeamPoint { position_m, motion }, 1.0)
        });
    let labelled = points.iter().filter_map(|point| {
        let motion = if point.direction().is_rotation() {
            Motion::Rotation
        } else {
            Motion::Translation
        };
        let position_m = *positions_m.get(point)?;
        Some((BeamPoint { position_m, motion }, point.sign().factor()))
    });
    joint.chain(labelled).collect()
}

fn beam_receptances(
    beam: &Beam,
    dofs: &[(BeamPoint, f64)],
    axis: &Axis<'_>,
) -> Result<Vec<ComplexMatrix>, BeamError> {
    let points: Vec<BeamPoint> = dofs.iter().map(|&(point, _)| point).collect();
    let mut receptances = beam.receptances(&points, axis.frequency_hz)?;
    for receptance in &mut receptances {
        for (p, (_, row_sign)) in dofs.iter().enumerate() {
            for (q, (_, column_sign)) in dofs.iter().enumerate() {
                receptance[(p, q)] *= row_sign * column_sign;
            }
        }
    }
    Ok(receptances)
}

/// Receptances between labelled DOFs: a matrix for each line, and which entries were measured independently of the others.
struct Labelled {
    matrices: Vec<ComplexMatrix>,
    /// Empty where the receptances come from modes.
    measured: Vec<(usize, usize)>,
    /// σ²/|H|² of each of `measured` at each line, where coherence says it.
    relative_variance: Option<Vec<Vec<f64>>>,
}

/// Receptances between all `labels` of a measured substructure.
fn labelled_receptances(
    source: &Source,
    labels: &[Dof],
    axis: &Axis<'_>,
    reader: &mut Reader,
) -> Result<Labelled, IdentifyError> {
    match source {
        Source::Frf(file) => {
            let (from_hz, to_hz) = axis.ends();
            let set = reader.read(file, labels, [from_hz, to_hz])?;
            let set = set
                .restricted_to(from_hz, to_hz)
                .map_err(|source| in_file(&file.path, source))?;
            axis.compare(&file.path, set.frequency_hz())?;
            let mut labelled = labelled_functions(&set, labels, Completeness::All)
                .map_err(|source| in_file(&file.path, source))?;
            let measured = independent(&labelled.measured, &labelled.matrices);
            labelled.relative_variance = relative_variances(&set, labels, &measured);
            labelled.measured = measured;
            labelled.symmetrise();
            Ok(labelled)
        }
        Source::Modal(path) => {
            let model = ModalModel::read(path)?;
            let mut entries = Vec::with_capacity(labels.len() * labels.len());
            for &reference in labels {
                for &response in labels {
                    entries.push(model.receptance(response, reference, axis.frequency_hz)?);
                }
            }
            Ok(Labelled {
                matrices: matrices(labels.len(), axis.frequency_hz.len(), &entries),
                measured: Vec::new(),
                relative_variance: None,
            })
        }
    }
}

/// Whether every pair of labels has to be there.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Completeness {
    All,
    /// Only one; what is missing is not a number.
    Any,
}

/// Functions of a set between all `labels`.
fn labelled_functions(
    set: &FrfSet,
    labels: &[Dof],
    completeness: Completeness,
) -> Result<Labelled, FrfError> {
    let mut measured = Vec::new();
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
                Err(error) => {
                    missing.push((row, column, error));
                    entries.push(vec![Complex64::new(f64::NAN, f64::NAN); set.line_count()]);
                }
            }
        }
    }
    // A label without any function is a mistake, whatever the others have.
    let is_used = |label: usize| {
        let mut pairs = measured.iter();
        pairs.any(|&(row, column)| row == label || column == label)
    };
    let fatal = missing.into_iter().find(|&(row, column, _)| {
        completeness == Completeness::All || !is_used(row) || !is_used(column)
    });
    match fatal {
        Some((_, _, error)) => Err(error),
        None => Ok(Labelled {
            matrices: matrices(labels.len(), set.line_count(), &entries),
            relative_variance: relative_variances(set, labels, &measured),
            measured,
        }),
    }
}

/// σ²/|H|² of each measured entry at each line by its coherence, if every one has coherence and the averages are known.
fn relative_variances(
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
    /// Replaces H_pq and H_qp by their mean: by reciprocity they are one number, measured twice.
    fn symmetrise(&mut self) {
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
fn matrices(size: usize, line_count: usize, entries: &[Vec<Complex64>]) -> Vec<ComplexMatrix> {
    (0..line_count)
        .map(|line| {
            ComplexMatrix::from_iterator(size, size, entries.iter().map(|entry| entry[line]))
        })
        .collect()
}

impl Axis<'_> {
    fn first_hz(&self) -> f64 {
        self.frequency_hz[0]
    }

    fn last_hz(&self) -> f64 {
        self.frequency_hz[self.frequency_hz.len() - 1]
    }

    /// First and last frequency, widened by what rounding in another file may have moved them.
    fn ends(&self) -> (f64, f64) {
        (
            self.first_hz() * (1.0 - 1e-5),
            self.last_hz() * (1.0 + 1e-5),
        )
    }

    fn compare(&self, path: &Path, other_hz: &[f64]) -> Result<(), IdentifyError> {
        let same = |a: f64, b: f64| (a - b).abs() <= 1e-5 * a.abs().max(b.abs());
        let shared = self.frequency_hz.len().min(other_hz.len());
        let first_difference = (0..shared)
            .find(|&line| !same(self.frequency_hz[line], other_hz[line]))
            .or_else(|| (self.frequency_hz.len() != other_hz.len()).then_some(shared));
        let Some(line) = first_difference else {
            return Ok(());
        };
        let show = |axis: &[f64]| {
            axis.get(line)
                .map_or_else(|| "(no line left)".to_owned(), |hz| format!("{hz} Hz"))
        };
        Err(IdentifyError::DifferingAxes {
            first_path: self.path.to_owned(),
            second_path: path.to_owned(),
            from_hz: self.first_hz(),
            to_hz: self.last_hz(),
            line: line + 1,
            first: show(self.frequency_hz),
            second: show(other_hz),
        })
    }
}
