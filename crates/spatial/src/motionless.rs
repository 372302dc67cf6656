//! Whether the structures move at all where a joint is sought: computed in a plane, they do not in the other motions.

use crate::assembled::Open;
use crate::error::SpatialError;
use crate::problem::Problem;
use crate::side::MOTIONS;

use bolted_joint_space::Dof;

/// Receptance in parts of the largest one that is rounding.
const NOTHING: f64 = 1e-12;

/// Refuses joints with unknowns in motions that neither structure has.
pub(crate) fn refuse_motionless(problem: &Problem, open: &[Open]) -> Result<(), SpatialError> {
    for (number, joint) in problem.links.sought().iter().enumerate() {
        let length = joint.link.length_m;
        let reached = Dof::ALL.map(|dof| {
            let i = MOTIONS * number + dof.index();
            // θ L = (H L²) (M/L)
            let scale = if dof.is_rotation() {
                length * length
            } else {
                1.0
            };
            let sizes = open.iter().map(|open| scale * open.seen[(i, i)].norm());
            sizes.fold(0.0, f64::max)
        });
        let largest = reached.iter().copied().fold(0.0, f64::max);
        let (has, has_not): (Vec<Dof>, Vec<Dof>) =
            (Dof::ALL.into_iter()).partition(|dof| reached[dof.index()] > NOTHING * largest);
        let entries = joint.model.entries();
        let is_sought =
            |dof: &Dof| (entries.iter()).any(|own| own.row == *dof || own.column == *dof);
        let motionless: Vec<Dof> = has_not.into_iter().filter(is_sought).collect();
        if !motionless.is_empty() {
            return Err(SpatialError::Motionless {
                joint: joint.link.key.clone(),
                motions: symbols(&motionless, ""),
                has: symbols(&has, "\""),
            });
        }
    }
    Ok(())
}

fn symbols(dofs: &[Dof], quote: &str) -> String {
    let all: Vec<String> = (dofs.iter())
        .map(|dof| format!("{quote}{}{quote}", dof.symbol()))
        .collect();
    all.join(", ")
}
