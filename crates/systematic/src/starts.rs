//! Where searches begin beside the joint that an estimate without causes finds: errors of the set-up can move that far away.

use bolted_joint_statistics::upper_median;

use super::cause::Side;
use super::experiment::Experiment;
use super::line::{Point, Task};
use super::normal::as_measured;
use super::structures::Recomputations;

/// Stiffness of a start as multiples of the structures' own dynamic stiffness at the joint.
const MULTIPLES: [f64; 4] = [10.0, 1.0, 100.0, 0.1];
/// Loss of a start's joint in the middle of the range, ωc/k.
const LOSS: f64 = 1e-2;

/// Of these joints those on the diagonal of the grid: all stiffnesses in proportion.
pub(crate) fn few(experiment: &Experiment<'_>) -> Vec<Vec<f64>> {
    let all = grid(experiment);
    let stride = if all.len() > MULTIPLES.len() {
        MULTIPLES.len() + 1
    } else {
        1
    };
    all.into_iter().step_by(stride).collect()
}

/// Diagonal joints, every translation alike and every rotation alike, from those near the structures' own stiffness outwards.
pub(crate) fn grid(experiment: &Experiment<'_>) -> Vec<Vec<f64>> {
    let task = Task::new(experiment, &[]);
    let joint = &experiment.joint;
    let count = joint.entries.len();
    let Some(typical) = typical(&task) else {
        return Vec::new();
    };
    let omega = experiment.omega[experiment.omega.len() / 2];
    let start = |translation: f64, rotation: f64| -> Vec<f64> {
        let mut start = vec![0.0; 2 * count];
        for (index, places) in joint.entries.iter().enumerate() {
            let (i, j) = places[0];
            if i != j {
                continue;
            }
            let multiple = if i % joint.dofs_of_a_bolt == 0 {
                translation
            } else {
                rotation
            };
            start[index] = multiple * typical[i];
            start[count + index] = LOSS * start[index] / omega;
        }
        start.repeat(experiment.joints())
    };
    let has_rotation = joint
        .entries
        .iter()
        .any(|places| places[0].0 % joint.dofs_of_a_bolt == 1);
    let rotations = if has_rotation {
        &MULTIPLES[..]
    } else {
        &MULTIPLES[..1]
    };
    let pairs = MULTIPLES
        .iter()
        .flat_map(|&y| rotations.iter().map(move |&theta| (y, theta)));
    pairs.map(|(y, theta)| start(y, theta)).collect()
}

/// Median over the lines of 1/|H_A + H_B| at each of the joint's DOFs.
fn typical(task: &Task<'_>) -> Option<Vec<f64>> {
    let point = Point {
        unknowns: Vec::new(),
        causes: Vec::new(),
    };
    let recomputed = Recomputations::of(task.experiment, &[], &[])?;
    let dofs = task.experiment.joint.dofs;
    let mut stiffness: Vec<Vec<f64>> = vec![Vec::new(); dofs];
    for line in 0..task.lines() {
        let labelled = as_measured(task, line, &point);
        let a = task.formed(Side::A, line, &point, &labelled, &recomputed)?;
        let b = task.formed(Side::B, line, &point, &labelled, &recomputed)?;
        for (dof, values) in stiffness.iter_mut().enumerate() {
            values.push((a[(dof, dof)] + b[(dof, dof)]).norm().recip());
        }
    }
    stiffness.into_iter().map(upper_median).collect()
}
