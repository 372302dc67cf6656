//! Repeated measurements of an assembly: their mean is used, and their scatter tells the noise.

use nalgebra::DMatrix;
use num_complex::Complex64;

use super::super::error::IdentifyError;
use super::super::lines::Repeats;
use super::super::study::Study;
use super::axis::Axis;
use super::labelled::{Completeness, Labelled, labelled_functions};
use super::reader::{Reader, in_file};
use crate::structure::ComplexMatrix;

/// The mean of repeated measurements of the assembly, and their scatter; the `first` where there are no others.
pub(super) fn repeated(
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
        all.push(labelled_functions(
            &set,
            &study.points,
            Completeness::Any,
            &file.path,
        )?);
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
        from_modes: Vec::new(),
    };
    Ok((mean, Some(repeats)))
}
