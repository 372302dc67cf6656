//! Repeated measurements of an assembly: their mean is used, and their scatter tells the noise.

use nalgebra::DMatrix;
use num_complex::Complex64;

use super::super::error::IdentifyError;
use super::super::lines::Repeats;
use super::super::study::Study;
use super::axis::Axis;
use super::labelled::{Completeness, Labelled, labelled_functions};
use super::reader::{Reader, in_file};
use bolted_joint_frf::structure::ComplexMatrix;

/// The mean of repeated measurements of an assembly.
pub(super) struct Mean {
    /// A matrix for each line.
    pub(super) receptances: Vec<ComplexMatrix>,
    /// Which of its entries were measured.
    pub(super) measured: Vec<(usize, usize)>,
    /// As in [`Labelled`].
    pub(super) relative_variance: Option<Vec<Vec<f64>>>,
    /// The scatter; `None` where nothing was repeated.
    pub(super) repeats: Option<Repeats>,
}

/// The mean of repeated measurements of the assembly, and their scatter; the `first` where there are no others.
pub(super) fn repeated(
    study: &Study,
    first: Labelled,
    axis: &Axis<'_>,
    reader: &mut Reader,
) -> Result<Mean, IdentifyError> {
    if study.repeats.is_empty() {
        return Ok(Mean {
            receptances: first.matrices(),
            measured: first.measured,
            relative_variance: first.relative_variance,
            repeats: None,
        });
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
            file,
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
        let matrices: Vec<ComplexMatrix> = all.iter().map(|one| one.matrix(line)).collect();
        let zero = ComplexMatrix::zeros(study.points.len(), study.points.len());
        let mean = matrices.iter().fold(zero, |sum, one| sum + one) / Complex64::from(count);
        let squares = |place: (usize, usize)| -> f64 {
            let differences = matrices.iter().map(|one| one[place] - mean[place]);
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
    Ok(Mean {
        receptances: means,
        measured,
        relative_variance: None,
        repeats: Some(repeats),
    })
}
