//! Receptances of a substructure between the joint's degrees of freedom and its points: read, synthesised or computed.

use std::collections::BTreeMap;
use std::sync::Arc;

use nalgebra::DMatrix;
use num_complex::Complex64;

use super::super::error::IdentifyError;
use super::super::from_modes::FromModes;
use super::super::lines::{Lines, independent};
use super::super::receptances::{MeasuredSubstructure, Receptances, with_lost};
use super::super::roughness::ShownNoise;
use super::super::study::{MeasuredJoint, Rotation, Source, Study, Substructure};
use super::axis::Axis;
use super::both_sides::as_one;
use super::known_mass::{masses_at, with_masses};
use super::labelled::{Completeness, Labelled, labelled_functions, relative_variances};
use super::reader::{Reader, in_file};
use super::soundness;
use bolted_joint_frf::Dof;
use bolted_joint_frf::structure::{
    Beam, BeamPoint, ComplexMatrix, ModalModel, Motion, StructureError,
};
use bolted_joint_study::StudyError;

/// Lines without the assembly: what A and B contribute.
pub(super) fn substructures(
    study: &Study,
    axis: &Axis<'_>,
    reader: &mut Reader,
) -> Result<Lines, IdentifyError> {
    let points = &study.points;
    let (of_b, of_a) = study.points_by_side();
    let a = joint_and_points(study, "a", of_a, axis, reader)?;
    let b = joint_and_points(study, "b", of_b, axis, reader)?;
    let (a, b, apart) = if of_a.is_empty() {
        (a, b, None)
    } else {
        let dofs = a.size() - of_a.len();
        let still = ComplexMatrix::zeros(dofs, dofs);
        let still = Receptances::Exact(vec![still; axis.frequency_hz.len()]);
        let one = as_one(&a, &b, dofs, axis.frequency_hz);
        (still, one, Some([a, b]))
    };
    Ok(Lines {
        frequency_hz: axis.frequency_hz.to_vec(),
        a,
        b,
        apart,
        assembly: Vec::new(),
        points: points.clone(),
        measured: Vec::new(),
        relative_variance: None,
        repeats: None,
        shown: ShownNoise::default(),
    })
}

/// Receptance matrices of a substructure at each line: the joint's DOFs first, bolt by bolt, then `points`.
fn joint_and_points(
    study: &Study,
    key: &'static str,
    points: &[Dof],
    axis: &Axis<'_>,
    reader: &mut Reader,
) -> Result<Receptances, IdentifyError> {
    let dofs_of_a_bolt = study.dofs_of_a_bolt();
    let substructure = if key == "a" { &study.a } else { &study.b };
    let masses = masses_at(substructure.masses(), dofs_of_a_bolt);
    match substructure {
        Substructure::Beam {
            beam,
            joints_m,
            positions_m,
            ..
        } => {
            let dofs = beam_dofs(dofs_of_a_bolt, joints_m, points, positions_m);
            let receptances = beam_receptances(beam, &dofs, axis.frequency_hz);
            let refused = |source| StudyError::model(&study.path, Some(key), source);
            massed_exact(receptances.map_err(refused)?, &masses, axis)
        }
        Substructure::Ground { bolts } => {
            let size = bolts * dofs_of_a_bolt;
            let still = ComplexMatrix::zeros(size, size);
            Ok(Receptances::Exact(vec![still; axis.frequency_hz.len()]))
        }
        Substructure::Measured { source, joints, .. } => {
            let lost = substructure
                .rotation_lost(dofs_of_a_bolt)
                .map(|[lost, _]| lost);
            let motions = Motions::new(joints, dofs_of_a_bolt, points);
            let labelled = labelled_receptances(key, source, &motions.labels, axis, reader)?;
            // (joint, points) = W (labels): H = W H_labels Wᵀ   (Tol 3.54)
            let whole = motions.transformation();
            if labelled.measured.is_empty() {
                let complex = whole.map(Complex64::from);
                let transposed = complex.transpose();
                let lines = 0..axis.frequency_hz.len();
                let formed = lines.map(|line| {
                    with_lost(
                        &complex * labelled.matrix(line) * &transposed,
                        lost.as_ref(),
                    )
                });
                return massed_exact(formed.collect(), &masses, axis);
            }
            let (measured, variance) = (
                labelled.measured.clone(),
                labelled.relative_variance.clone(),
            );
            let functions = labelled.symmetrised();
            let measured =
                MeasuredSubstructure::new(whole, functions, measured, variance).with_lost(lost);
            let rotations = motions.labels.iter();
            let rotations = rotations.map(|label| label.direction().is_rotation());
            let measured = measured.with_axis(axis.frequency_hz, rotations.collect());
            let measured = massed(measured, &masses, axis)?;
            Ok(Receptances::Measured(Arc::new(measured)))
        }
    }
}

/// Receptances at the joint's DOFs and the points with these masses at DOFs of the joint.
fn massed_exact(
    matrices: Vec<ComplexMatrix>,
    masses: &[(usize, f64)],
    axis: &Axis<'_>,
) -> Result<Receptances, IdentifyError> {
    if masses.is_empty() {
        return Ok(Receptances::Exact(matrices));
    }
    let with = matrices.into_iter().zip(axis.frequency_hz);
    let with = with.map(|(matrix, &frequency_hz)| {
        let motions = ComplexMatrix::identity(matrix.nrows(), matrix.nrows());
        let (motions, kg) = moved_with(&motions, masses);
        with_masses(matrix, &motions, &kg, frequency_hz)
            .ok_or(IdentifyError::SingularWithMass { frequency_hz })
    });
    Ok(Receptances::Exact(with.collect::<Result<_, _>>()?))
}

/// Measured functions with these masses at DOFs of the joint. Their noise is taken as if they had been measured so.
fn massed(
    measured: MeasuredSubstructure,
    masses: &[(usize, f64)],
    axis: &Axis<'_>,
) -> Result<MeasuredSubstructure, IdentifyError> {
    if masses.is_empty() {
        return Ok(measured);
    }
    let whole = measured.transformation().map(Complex64::from);
    let (motions, kg) = moved_with(&whole, masses);
    let with = |line: usize, u| with_masses(u, &motions, &kg, axis.frequency_hz[line]);
    let failed = IdentifyError::SingularWithMass {
        frequency_hz: axis.first_hz(),
    };
    measured.changed(with).ok_or(failed)
}

/// The rows of the motions that masses take part in, and the masses.
fn moved_with(whole: &ComplexMatrix, masses: &[(usize, f64)]) -> (ComplexMatrix, Vec<f64>) {
    let rows: Vec<usize> = masses.iter().map(|&(dof, _)| dof).collect();
    let kg = masses.iter().map(|&(_, kg)| kg);
    (whole.select_rows(&rows), kg.collect())
}

/// Labels of a measured substructure's functions, in their order; none of one that is computed.
pub(in super::super) fn measured_labels(
    substructure: &Substructure,
    dofs_of_a_bolt: usize,
    points: &[Dof],
) -> Vec<Dof> {
    match substructure {
        Substructure::Measured { joints, .. } => {
            Motions::new(joints, dofs_of_a_bolt, points).labels
        }
        Substructure::Beam { .. } | Substructure::Ground { .. } => Vec::new(),
    }
}

/// Motions of the joint's DOFs and of the points as combinations of labelled ones. A label that serves several of them,
/// whatever its sign, is one measurement.
struct Motions {
    labels: Vec<Dof>,
    /// For each motion, labels by number and their factors.
    rows: Vec<Vec<(usize, f64)>>,
}

impl Motions {
    fn new(joints: &[MeasuredJoint], dofs_of_a_bolt: usize, points: &[Dof]) -> Self {
        let mut motions = Self {
            labels: Vec::new(),
            rows: Vec::new(),
        };
        for joint in joints {
            match &joint.theta {
                Some(Rotation::Difference { points, difference }) if dofs_of_a_bolt == 2 => {
                    for row in difference.transformation().row_iter() {
                        let factors = row.iter().map(|factor| factor.re);
                        motions.add(points.iter().copied().zip(factors));
                    }
                }
                Some(Rotation::Measured(theta)) if dofs_of_a_bolt == 2 => {
                    motions.add([(joint.y, 1.0)]);
                    motions.add([(*theta, 1.0)]);
                }
                _ => motions.add([(joint.y, 1.0)]),
            }
        }
        for &point in points {
            motions.add([(point, 1.0)]);
        }
        motions
    }

    fn add(&mut self, parts: impl IntoIterator<Item = (Dof, f64)>) {
        let row = parts.into_iter().map(|(dof, factor)| {
            let known = |wanted: Dof| self.labels.iter().position(|&label| label == wanted);
            match (known(dof), known(dof.flipped())) {
                (Some(index), _) => (index, factor),
                (None, Some(index)) => (index, -factor),
                (None, None) => {
                    self.labels.push(dof);
                    (self.labels.len() - 1, factor)
                }
            }
        });
        let row = row.collect();
        self.rows.push(row);
    }

    fn transformation(&self) -> DMatrix<f64> {
        let mut whole = DMatrix::zeros(self.rows.len(), self.labels.len());
        for (row, parts) in self.rows.iter().enumerate() {
            for &(label, factor) in parts {
                whole[(row, label)] += factor;
            }
        }
        whole
    }
}

/// The joint's DOFs on a beam, bolt by bolt, then its points, each with the sign of its label.
pub(super) fn beam_dofs(
    dofs_of_a_bolt: usize,
    joints_m: &[f64],
    points: &[Dof],
    positions_m: &BTreeMap<Dof, f64>,
) -> Vec<(BeamPoint, f64)> {
    let joint = joints_m.iter().flat_map(|&position_m| {
        [Motion::Translation, Motion::Rotation]
            .into_iter()
            .take(dofs_of_a_bolt)
            .map(move |motion| (BeamPoint { position_m, motion }, 1.0))
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
    frequency_hz: &[f64],
) -> Result<Vec<ComplexMatrix>, StructureError> {
    let points: Vec<BeamPoint> = dofs.iter().map(|&(point, _)| point).collect();
    Ok(signed(beam.receptances(&points, frequency_hz)?, dofs))
}

/// Receptances at the DOFs, each with its sign.
pub(super) fn signed(
    mut receptances: Vec<ComplexMatrix>,
    dofs: &[(BeamPoint, f64)],
) -> Vec<ComplexMatrix> {
    for receptance in &mut receptances {
        for (p, (_, row_sign)) in dofs.iter().enumerate() {
            for (q, (_, column_sign)) in dofs.iter().enumerate() {
                receptance[(p, q)] *= row_sign * column_sign;
            }
        }
    }
    receptances
}

/// Receptances between all `labels` of a measured substructure.
fn labelled_receptances(
    key: &'static str,
    source: &Source,
    labels: &[Dof],
    axis: &Axis<'_>,
    reader: &mut Reader,
) -> Result<Labelled, IdentifyError> {
    match source {
        Source::Frf { file, modes } => {
            let (from_hz, to_hz) = axis.ends();
            let set = reader.read(file, labels, [from_hz, to_hz])?;
            let set = set
                .restricted_to(from_hz, to_hz)
                .map_err(|source| in_file(&file.path, source))?;
            axis.compare(&file.path, set.frequency_hz())?;
            let modal = modes.as_deref().map(ModalModel::read).transpose()?;
            reader
                .warnings
                .extend(modal.iter().flat_map(ModalModel::warnings).cloned());
            let completeness = modal
                .as_ref()
                .map_or(Completeness::All, Completeness::WithModes);
            let mut labelled = labelled_functions(&set, labels, completeness, file)?;
            reader.note(soundness::unsound(&labelled, labels, &file.path));
            let is_symmetric = |p, q| labelled.function(p, q) == labelled.function(q, p);
            let measured = independent(&labelled.measured, is_symmetric);
            labelled.relative_variance = relative_variances(&set, labels, &measured);
            labelled.measured = measured;
            if let (Some(path), Some(modal)) = (modes, &modal) {
                let pairs = labelled.from_modes.iter();
                reader.from_modes.push(FromModes {
                    substructure: key,
                    path: path.clone(),
                    functions: pairs.map(|&(p, q)| (labels[p], labels[q])).collect(),
                    deviation: labelled.deviation_of(modal, labels, axis.frequency_hz),
                });
            }
            Ok(labelled)
        }
        Source::Modal(path) => {
            let model = ModalModel::read(path)?;
            reader.warnings.extend_from_slice(model.warnings());
            Labelled::of_modes(&model, labels, axis.frequency_hz)
        }
    }
}
