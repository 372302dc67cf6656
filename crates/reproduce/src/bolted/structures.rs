//! The bolted beams of chapter 5: substructure A by its published modes, substructure B computed.

use std::path::Path;

use nalgebra::{DMatrix, dmatrix};
use num_complex::Complex64;

use bolted_joint_frf::structure::{
    Beam, Boundary, ComplexMatrix, Damping, FiniteDifference, ModalModel,
};
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

/// Modes of Appendix A.
#[derive(Clone, Copy)]
pub(super) struct PublishedModes {
    /// TOML.
    pub(super) text: &'static str,
    /// What messages call it.
    pub(super) name: &'static str,
    /// Labels of the three points in the direction of the tip; the joint is at the middle one.
    pub(super) towards_tip: [u32; 3],
}

pub(super) const ALUMINIUM_M10: PublishedModes = PublishedModes {
    text: include_str!("../../../../examples/tol-m10x16/a-modes.toml"),
    name: "M10x16",
    towards_tip: [3, 2, 1],
};
pub(super) const ALUMINIUM_M8: PublishedModes = PublishedModes {
    text: include_str!("appendix_a/m8x16.toml"),
    name: "M8x16",
    towards_tip: [3, 2, 1],
};
pub(super) const STEEL_M10: PublishedModes = PublishedModes {
    text: include_str!("appendix_a/m10x35.toml"),
    name: "M10x35",
    towards_tip: [1, 2, 3],
};
pub(super) const STEEL_M8: PublishedModes = PublishedModes {
    text: include_str!("appendix_a/m8x35.toml"),
    name: "M8x35",
    towards_tip: [1, 2, 3],
};
pub(super) const STEEL_M8_LONG: PublishedModes = PublishedModes {
    text: include_str!("appendix_a/m8x35-long.toml"),
    name: "M8x35, longer A",
    towards_tip: [1, 2, 3],
};
pub(super) const STEEL_M6: PublishedModes = PublishedModes {
    text: include_str!("appendix_a/m6x30.toml"),
    name: "M6x30",
    towards_tip: [1, 2, 3],
};

/// Section 5.2: aluminium, 0.221 m × 25 mm × 6 mm.
pub(super) fn aluminium_b() -> Beam {
    Beam {
        length_m: 0.221,
        width_m: 0.025,
        height_m: 0.006,
        youngs_modulus_pa: 70e9,
        density_kg_per_m3: 2700.0,
        boundary: Boundary::FreeFree,
        damping: Damping::Ratios(vec![0.0, 0.0, 0.0008]),
    }
}

/// Steel, 15 mm × 10 mm, 7604 kg/m³ (section 5.3.1 and Appendix B).
fn steel_b(length_m: f64, youngs_modulus_pa: f64, elastic: &[f64]) -> Beam {
    Beam {
        length_m,
        width_m: 0.015,
        height_m: 0.010,
        youngs_modulus_pa,
        density_kg_per_m3: 7604.0,
        boundary: Boundary::FreeFree,
        damping: Damping::Ratios([&[0.0, 0.0], elastic].concat()),
    }
}

pub(super) fn steel_b_m10() -> Beam {
    steel_b(0.335, 1.92e11, &[0.0005])
}

pub(super) fn steel_b_m8() -> Beam {
    steel_b(0.335, 1.9225e11, &[0.0006, 0.0007])
}

pub(super) fn steel_b_m6() -> Beam {
    steel_b(0.340, 1.885e11, &[0.00205, 0.00165])
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
    modes: PublishedModes,
    frequency_hz: &[f64],
) -> Result<Vec<ComplexMatrix>, ReproduceError> {
    let model = ModalModel::from_toml(modes.text, Path::new(modes.name))?.without_residuals();
    let dof = |node| Dof::new(node, Direction::Y, Sign::Plus);
    let points = modes.towards_tip.map(dof);
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
    modes: PublishedModes,
    beam: &Beam,
    joint: &JointMatrices,
) -> Result<Lines, ReproduceError> {
    let frequency_hz = frequencies();
    let transformation = FiniteDifference::central(SPACING_M).transformation();
    let transposed = transformation.transpose();
    let a_joint = translations(modes, &frequency_hz)?
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
        assembly: Vec::new(),
        points: [11, 12, 13].map(dof).to_vec(),
        measured: (0..3)
            .flat_map(|column| (0..3).map(move |row| (row, column)))
            .collect(),
        relative_variance: None,
        repeats: None,
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

/// One receptance of the assembly over all lines.
pub(super) fn function(assembly: &[ComplexMatrix], place: (usize, usize)) -> Vec<Complex64> {
    assembly.iter().map(|h| h[place]).collect()
}

/// Resonances of the assembly at point 2s, Hz.
pub(super) fn resonances_hz(
    lines: &Lines,
    joint: &JointMatrices,
) -> Result<Vec<f64>, ReproduceError> {
    let assembly = lines.regenerated(joint)?;
    let found = resonances(&lines.frequency_hz, &function(&assembly, (1, 1)));
    Ok(found
        .iter()
        .map(|resonance| resonance.frequency_hz)
        .collect())
}

/// √ of the mean of |Ĥ − H|²/|H|² over the lines.
pub(super) fn relative_rms(found: &[Complex64], exact: &[Complex64]) -> f64 {
    let squares = found
        .iter()
        .zip(exact)
        .map(|(found, exact)| (found - exact).norm_sqr() / exact.norm_sqr());
    (squares.sum::<f64>() / exact.len() as f64).sqrt()
}

/// Both matrices multiplied by a factor.
pub(super) fn stiffened(joint: &JointMatrices, factor: f64) -> JointMatrices {
    let times = |matrix: &DMatrix<f64>| matrix * factor;
    JointMatrices {
        stiffness: times(&joint.stiffness),
        damping: times(&joint.damping),
    }
}
