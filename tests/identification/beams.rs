//! What every test rig is made of: the thesis's beams, their points, all pairs of them, and the joint of their lines.

use bolted_joint::frf::Dof;
use bolted_joint::identify::{
    JointModel, Lines, LinesEstimate, NoiseLevel, Options, identify_lines,
};
use bolted_joint::structure::{Beam, BeamPoint, Boundary, Damping, Motion, Theory};

/// Of Tol section 4.2.2 with this length, with ζ in every mode; ζ = 0.01 there.
pub(crate) fn beam(length_m: f64, boundary: Boundary, damping_ratio: f64) -> Beam {
    Beam {
        length_m,
        width_m: 0.025,
        height_m: 0.006,
        youngs_modulus_pa: 67e9,
        density_kg_per_m3: 2700.0,
        theory: Theory::EulerBernoulli,
        boundary,
        damping: Damping::Ratios(vec![damping_ratio]),
    }
}

/// Translations at these places.
pub(crate) fn translations(positions_m: &[f64]) -> Vec<BeamPoint> {
    let translation = |&position_m: &f64| BeamPoint {
        position_m,
        motion: Motion::Translation,
    };
    positions_m.iter().map(translation).collect()
}

/// Translation and rotation at each of these places.
pub(crate) fn joints(positions_m: &[f64]) -> Vec<BeamPoint> {
    let both = |&position_m: &f64| {
        [Motion::Translation, Motion::Rotation].map(|motion| BeamPoint { position_m, motion })
    };
    positions_m.iter().flat_map(both).collect()
}

/// Names of so many points.
pub(crate) fn names(count: usize) -> Vec<Dof> {
    let name = |point: usize| format!("{}:+Y", point + 1).parse().unwrap();
    (0..count).map(name).collect()
}

/// All pairs of so many points, row by row.
pub(crate) fn pairs(count: usize) -> Vec<(usize, usize)> {
    let row = |row| (0..count).map(move |column| (row, column));
    (0..count).flat_map(row).collect()
}

/// Noise in proportion to what is measured.
pub(crate) const fn relative(relative: f64) -> NoiseLevel {
    NoiseLevel {
        relative,
        floor: 0.0,
    }
}

/// The joint of some lines.
pub(crate) fn identified(lines: &Lines, model: JointModel, options: &Options) -> LinesEstimate {
    identify_lines(std::slice::from_ref(lines), model, options).unwrap()
}
