//! The bolted beams of chapter 5: substructure A by its published modes, substructure B computed.

use std::path::Path;

use nalgebra::dmatrix;
use num_complex::Complex64;
use serde::Deserialize;

use bolted_joint_frf::structure::{Beam, ComplexMatrix, FiniteDifference, ModalModel};
use bolted_joint_frf::{Direction, Dof, Sign, resonances};
use bolted_joint_identify::{JointMatrices, Lines, Receptances};

use crate::error::ReproduceError;
use crate::receptances::joint_first;

/// Distance between neighbouring points on A and on B, and of the joint and the middle points from the ends.
pub(super) const SPACING_M: f64 = 0.015;
/// Chapter 5's acquisition: 2048 lines, 0.25 Hz apart.
pub(super) const LINE_SPACING_HZ: f64 = 0.25;
const LINE_COUNT: u32 = 2048;
/// Below, the assembly answers like a support; the first mode is at 18 Hz or more.
const FIRST_LINE: u32 = 20;

/// Substructures A, by their modes in Appendix A.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum SubstructureA {
    M10x16,
    M8x16,
    M10x35,
    M8x35,
    LongM8x35,
    M6x30,
}

impl SubstructureA {
    fn modes(self) -> Result<ModalModel, ReproduceError> {
        let text = match self {
            Self::M10x16 => include_str!("../../../../examples/tol-m10x16/a-modes.toml"),
            Self::M8x16 => include_str!("appendix_a/m8x16.toml"),
            Self::M10x35 => include_str!("appendix_a/m10x35.toml"),
            Self::M8x35 => include_str!("appendix_a/m8x35.toml"),
            Self::LongM8x35 => include_str!("appendix_a/m8x35-long.toml"),
            Self::M6x30 => include_str!("appendix_a/m6x30.toml"),
        };
        Ok(ModalModel::from_toml(text, Path::new(&format!("{self:?}")))?.without_residuals())
    }

    /// Labels of the three points in the direction of the tip; the joint is at the middle one.
    fn towards_tip(self) -> [u32; 3] {
        match self {
            Self::M10x16 | Self::M8x16 => [3, 2, 1],
            _ => [1, 2, 3],
        }
    }
}

/// K and C from k_Fy, k_Fθ, k_Mθ, c_Fy, c_Fθ, c_Mθ.
pub(super) fn joint([k, kt, ktt, c, ct, ctt]: [f64; 6]) -> JointMatrices {
    JointMatrices {
        stiffness: dmatrix![k, kt; kt, ktt],
        damping: dmatrix![c, ct; ct, ctt],
    }
}

pub(super) fn frequencies() -> Vec<f64> {
    (FIRST_LINE..=LINE_COUNT)
        .map(|line| LINE_SPACING_HZ * f64::from(line))
        .collect()
}

/// Receptances of A between its three points in the direction of the tip, from modes alone.
pub(super) fn translations(
    a: SubstructureA,
    frequency_hz: &[f64],
) -> Result<Vec<ComplexMatrix>, ReproduceError> {
    let model = a.modes()?;
    let dof = |node| Dof::new(node, Direction::Y, Sign::Plus);
    let points = a.towards_tip().map(dof);
    let mut entries = Vec::new();
    for reference in points {
        for response in points {
            entries.push(model.receptance(response, reference, frequency_hz)?);
        }
    }
    Ok((0..frequency_hz.len())
        .map(|line| ComplexMatrix::from_iterator(3, 3, entries.iter().map(|entry| entry[line])))
        .collect())
}

/// The places on B of points 1s, 2s and 3s.
pub(super) fn points_m(beam: &Beam) -> [f64; 3] {
    [2.0, 1.0, 0.0].map(|steps| beam.length_m - steps * SPACING_M)
}

/// A, B and their assembly through `joint` at points 1s, 2s and 3s, without noise.
pub(super) fn assembled(
    a: SubstructureA,
    beam: &Beam,
    joint: &JointMatrices,
) -> Result<Lines, ReproduceError> {
    let frequency_hz = frequencies();
    let transformation = FiniteDifference::central(SPACING_M).transformation();
    let transposed = transformation.transpose();
    let a_joint = translations(a, &frequency_hz)?
        .iter()
        .map(|h| &transformation * h * &transposed)
        .collect();
    let points = points_m(beam).map(crate::receptances::translation);
    let b = joint_first(beam, SPACING_M, &points, &frequency_hz)?;
    lines(frequency_hz, a_joint, b, joint)
}

/// Lines whose assembly is that of `joint`.
pub(super) fn lines(
    frequency_hz: Vec<f64>,
    a_joint: Vec<ComplexMatrix>,
    b: Vec<ComplexMatrix>,
    joint: &JointMatrices,
) -> Result<Lines, ReproduceError> {
    let dof = |node| Dof::new(node, Direction::Y, Sign::Plus);
    let mut lines = Lines {
        frequency_hz,
        a: Receptances::Exact(a_joint),
        b: Receptances::Exact(b),
        apart: None,
        assembly: Vec::new(),
        points: [11, 12, 13].map(dof).to_vec(),
        measured: (0..3)
            .flat_map(|column| (0..3).map(move |row| (row, column)))
            .collect(),
        relative_variance: None,
        repeats: None,
        shown: Default::default(),
    };
    lines.assembly = lines.regenerated(joint)?;
    Ok(lines)
}

/// The same lines measured at some of the points only.
pub(super) fn measured_at(lines: &Lines, places: &[usize]) -> Lines {
    let dofs = lines.joint_dofs();
    let kept: Vec<usize> = (0..dofs)
        .chain(places.iter().map(|place| dofs + place))
        .collect();
    let b = (0..lines.frequency_hz.len())
        .map(|line| lines.b.at(line).select_rows(&kept).select_columns(&kept))
        .collect();
    Lines {
        b: Receptances::Exact(b),
        assembly: lines
            .assembly
            .iter()
            .map(|h| h.select_rows(places).select_columns(places))
            .collect(),
        points: places.iter().map(|&place| lines.points[place]).collect(),
        measured: (0..places.len())
            .flat_map(|column| (0..places.len()).map(move |row| (row, column)))
            .collect(),
        ..lines.clone()
    }
}

/// Resonances of the assembly at point 2s, Hz.
pub(super) fn resonances_hz(
    lines: &Lines,
    joint: &JointMatrices,
) -> Result<Vec<f64>, ReproduceError> {
    let assembly = lines.regenerated(joint)?;
    let function: Vec<Complex64> = assembly.iter().map(|h| h[(1, 1)]).collect();
    let found = resonances(&lines.frequency_hz, &function);
    Ok(found
        .iter()
        .map(|resonance| resonance.frequency_hz)
        .collect())
}

/// √ of the mean of |Ĥ − H|²/|H|² over the lines at each drive point, %, where Ĥ is with `joint`.
pub(super) fn deviations_percent(
    lines: &Lines,
    joint: &JointMatrices,
) -> Result<[f64; 3], ReproduceError> {
    let regenerated = lines.regenerated(joint)?;
    Ok(std::array::from_fn(|point| {
        let squares = regenerated
            .iter()
            .zip(&lines.assembly)
            .map(|(found, exact)| {
                let (found, exact) = (found[(point, point)], exact[(point, point)]);
                (found - exact).norm_sqr() / exact.norm_sqr()
            });
        100.0 * (squares.sum::<f64>() / lines.assembly.len() as f64).sqrt()
    }))
}
