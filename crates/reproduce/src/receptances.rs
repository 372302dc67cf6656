//! Receptances of beams and of their assemblies, as every case study needs them.

use bolted_joint_frf::structure::{
    Assembly, Beam, BeamPoint, ComplexMatrix, Motion, Partition, couple,
};
use bolted_joint_identify::{Equation, JointMatrices};

use super::error::ReproduceError;

pub(super) fn translation(position_m: f64) -> BeamPoint {
    let motion = Motion::Translation;
    BeamPoint { position_m, motion }
}

pub(super) fn rotation(position_m: f64) -> BeamPoint {
    let motion = Motion::Rotation;
    BeamPoint { position_m, motion }
}

/// Receptances of a beam at each line, its joint's translation and rotation first.
pub(super) fn joint_first(
    beam: &Beam,
    joint_m: f64,
    points: &[BeamPoint],
    frequency_hz: &[f64],
) -> Result<Vec<ComplexMatrix>, ReproduceError> {
    let mut dofs = vec![translation(joint_m), rotation(joint_m)];
    dofs.extend_from_slice(points);
    Ok(beam.receptances(&dofs, frequency_hz)?)
}

/// The same in parts.
pub(super) fn partitions(
    beam: &Beam,
    joint_m: f64,
    points: &[BeamPoint],
    frequency_hz: &[f64],
) -> Result<Vec<Partition>, ReproduceError> {
    let receptances = joint_first(beam, joint_m, points, frequency_hz)?;
    Ok(receptances.iter().map(|h| Partition::of(h, 2)).collect())
}

pub(super) fn assemblies(
    frequency_hz: &[f64],
    a: &[Partition],
    b: &[Partition],
    joint: &JointMatrices,
) -> Result<Vec<Assembly>, ReproduceError> {
    let lines = frequency_hz.iter().zip(a.iter().zip(b));
    let couple_line = |(&hz, (a, b)): (&f64, (&Partition, &Partition))| {
        Ok(couple(a, b, &joint.complex_stiffness(hz))?)
    };
    lines.map(couple_line).collect()
}

/// Some of a substructure's points.
pub(super) fn at(part: &Partition, places: &[usize]) -> Partition {
    Partition {
        joint: part.joint.clone(),
        joint_points: part.joint_points.select_columns(places),
        points_joint: part.points_joint.select_rows(places),
        points: part.points.select_rows(places).select_columns(places),
    }
}

/// The receptances of an assembly that an equation decouples.
pub(super) fn block(equation: Equation, assembly: &Assembly) -> &ComplexMatrix {
    match equation {
        Equation::Rr => &assembly.rr,
        Equation::Rs => &assembly.rs,
        Equation::Sr => &assembly.sr,
        Equation::Ss => &assembly.ss,
    }
}
