//! Starting values of the estimator: the band average, and joints from soft to stiff beside the substructures.

use nalgebra::DMatrix;

use super::lines::Lines;
use super::model::{JointMatrices, JointModel};

/// Stiffness of a start as a multiple of the substructures' own dynamic stiffness at the joint.
const MULTIPLES: [f64; 4] = [0.1, 1.0, 10.0, 100.0];

/// The same for a start that all but leaves the substructures apart: a loose joint has minima of its own beside zero, in
/// which a single spring acts where the measured points hardly move.
const LOOSE: f64 = 1e-6;

/// Loss of a start's joint at the middle of the frequency range, ωc/k.
const LOSS: f64 = 1e-2;

/// `first` (the band average, where there is one), a grid of diagonal joints, and one that all but does not join.
pub(super) fn starts(
    lines: &Lines,
    model: JointModel,
    first: Option<&JointMatrices>,
) -> Vec<JointMatrices> {
    let size = model.dofs();
    let typical: Vec<f64> = (0..size).map(|dof| dynamic_stiffness(lines, dof)).collect();
    let middle = lines.frequency_hz[lines.frequency_hz.len() / 2];
    let omega = std::f64::consts::TAU * middle;
    let mut starts: Vec<JointMatrices> = first.cloned().into_iter().collect();
    let mut push = |multiple: &dyn Fn(usize) -> f64| {
        let stiffness = DMatrix::from_fn(size, size, |i, j| {
            if i == j {
                typical[i] * multiple(i)
            } else {
                0.0
            }
        });
        starts.push(JointMatrices {
            damping: &stiffness * (LOSS / omega),
            stiffness,
        });
    };
    for combination in 0..MULTIPLES.len().pow(size as u32) {
        push(&|dof| MULTIPLES[combination / MULTIPLES.len().pow(dof as u32) % MULTIPLES.len()]);
    }
    push(&|_| LOOSE);
    starts
}

/// Median over the lines of 1/|H_jj + H_kk| on one DOF.
fn dynamic_stiffness(lines: &Lines, dof: usize) -> f64 {
    let mut values: Vec<f64> = lines
        .a_joint
        .iter()
        .zip(&lines.b)
        .map(|(a, b)| (a[(dof, dof)] + b.joint[(dof, dof)]).norm().recip())
        .collect();
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}
