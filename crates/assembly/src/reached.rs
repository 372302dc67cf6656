//! How far the joints of an assembly move in a response, and where that is further than they were observed to move.

use crate::model::AssemblyModel;

/// The largest relative displacement of each degree of freedom of each joint, in their order; m, rad.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Reached(Vec<f64>);

/// A degree of freedom of a joint that moves further than the joint was observed to.
#[derive(Clone, Debug, PartialEq)]
pub struct BeyondObserved<'m> {
    /// Name of the joint.
    pub joint: &'m str,
    /// Name of the degree of freedom.
    pub dof: &'static str,
    /// `m` or `rad`.
    pub unit: &'static str,
    /// How far it moves.
    pub largest: f64,
    /// How far it was observed to move.
    pub observed: f64,
}

impl Reached {
    /// Takes in a relative displacement of the DOF at this place among those of all joints.
    pub(crate) fn include(&mut self, place: usize, displacement: f64) {
        if self.0.len() <= place {
            self.0.resize(place + 1, 0.0);
        }
        let largest = &mut self.0[place];
        *largest = largest.max(displacement.abs());
    }
}

impl AssemblyModel {
    /// Where joints moved further than they were observed to, which their files may say: what is told there is extrapolated.
    #[must_use]
    pub fn beyond_observed(&self, reached: &Reached) -> Vec<BeyondObserved<'_>> {
        let mut largest = reached.0.iter();
        let mut beyond = Vec::new();
        for placed in &self.joints {
            let joint = &placed.file.joint;
            let observed = joint.higher.as_ref().map(|higher| &higher.amplitude);
            for (dof, row) in joint.dofs.rows().enumerate() {
                let Some(&largest) = largest.next() else {
                    return beyond;
                };
                let Some(&observed) = observed.and_then(|all| all.get(dof)) else {
                    continue;
                };
                if largest > observed {
                    beyond.push(BeyondObserved {
                        joint: &placed.name,
                        dof: row.name,
                        unit: row.kind.displacement_unit(),
                        largest,
                        observed,
                    });
                }
            }
        }
        beyond
    }
}
