//! Receptances of a substructure between the joint's degrees of freedom and its points: read, synthesised or computed.

use std::collections::BTreeMap;
use std::sync::Arc;

use nalgebra::DMatrix;
use num_complex::Complex64;

use super::super::error::IdentifyError;
use super::super::lines::{Lines, MeasuredSubstructure, independent};
use super::super::study::{Rotation, Source, Study, Substructure};
use super::axis::Axis;
use super::labelled::{Completeness, Labelled, labelled_functions, matrices, relative_variances};
use super::reader::{Reader, in_file};
use crate::frf::Dof;
use crate::structure::{Beam, BeamError, BeamPoint, ComplexMatrix, ModalModel, Motion, Partition};

/// Lines without the assembly: what A and B contribute.
pub(super) fn substructures(
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
