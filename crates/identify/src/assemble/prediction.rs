//! What an assembly would answer with a given joint.

use super::super::error::IdentifyError;
use super::super::lines::Lines;
use super::super::model::JointMatrices;
use super::super::study::Study;
use super::axis::Axis;
use super::reader::Reader;
use super::substructure::substructures;
use bolted_joint_frf::{Frf, FrfSet};

/// The assembly's receptances as the study's substructures and `joints` make them: all pairs of its points. There is one
/// joint for each bolt that has its own, or one for all.
///
/// # Errors
/// [`IdentifyError`] if the substructures' data cannot be used, or at an undamped resonance.
pub fn predict_assembly(
    study: &Study,
    joints: &[JointMatrices],
    frequency_hz: &[f64],
) -> Result<FrfSet, IdentifyError> {
    let axis = Axis {
        path: &study.assembly.path,
        frequency_hz,
    };
    let lines = substructures(study, &axis, &mut Reader::default())?;
    let assembly = lines.regenerated(&study.layout().whole(joints))?;
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

/// Lines of the study's first assembly as its substructures and `joints` make them, every pair of points measured.
///
/// # Errors
/// As [`predict_assembly`].
pub fn predict_lines(
    study: &Study,
    joints: &[JointMatrices],
    frequency_hz: &[f64],
) -> Result<Lines, IdentifyError> {
    let axis = Axis {
        path: &study.assembly.path,
        frequency_hz,
    };
    let mut lines = substructures(study, &axis, &mut Reader::default())?;
    lines.assembly = lines.regenerated(&study.layout().whole(joints))?;
    let count = study.points.len();
    lines.measured = (0..count)
        .flat_map(|column| (0..count).map(move |row| (row, column)))
        .collect();
    Ok(lines)
}
