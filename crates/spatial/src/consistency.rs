//! Whether the interfaces move as rigid bodies, before any joint is sought: overall over frequency, and for each channel and
//! impact.

use bolted_joint_frf::Dof;
use bolted_joint_virtual_point::{Consistency, Place, Role, VirtualPoint, Weights};

use crate::error::SpatialError;
use crate::study::SpatialStudy;

/// How consistent the channels or the impacts of a side are.
#[derive(Clone, Debug, PartialEq)]
pub struct SideConsistency {
    /// `a` or `b`.
    pub side: &'static str,
    /// Channels or impacts.
    pub role: Role,
    /// ρ at each line of the study.
    pub overall: Vec<f64>,
    /// Each channel or impact: its key in the study, its DOF, its own coherence.
    pub specific: Vec<(String, Dof, f64)>,
}

impl SideConsistency {
    /// Mean of ρ over the lines.
    #[must_use]
    pub fn mean(&self) -> f64 {
        self.overall.iter().sum::<f64>() / self.overall.len().max(1) as f64
    }

    /// The least consistent channel or impact.
    #[must_use]
    pub fn worst(&self) -> Option<&(String, Dof, f64)> {
        let each = self.specific.iter();
        each.min_by(|(_, _, one), (_, _, other)| one.total_cmp(other))
    }
}

impl SpatialStudy {
    /// The consistency of each side with sensors and impacts, with the set-up as the study says it. Six channels or impacts
    /// agree with anything and are left out.
    ///
    /// # Errors
    /// [`SpatialError::Interface`] for functions that cannot be used.
    pub fn consistency(&self) -> Result<Vec<SideConsistency>, SpatialError> {
        let mut all = Vec::new();
        for (name, side) in ["a", "b"].into_iter().zip(&self.problem.sides) {
            let Some((placed, set_up)) = side.points() else {
                continue;
            };
            let refused = |source| placed.refused(source);
            let near = [set_up.channels().count(), set_up.impacts().count()];
            let lines: Vec<_> = side
                .lines
                .iter()
                .map(|line| line.view((0, 0), (near[0], near[1])).into_owned())
                .collect();
            let point = VirtualPoint::new(set_up.clone(), &Weights::Equal, &Weights::Equal)
                .map_err(refused)?;
            for role in [Role::Channel, Role::Impact] {
                let found = point.consistency(role, &lines).map_err(refused)?;
                let Some(Consistency { overall, specific }) = found else {
                    continue;
                };
                let (place, dofs): (fn(usize) -> Place, _) = match role {
                    Role::Channel => (Place::Channel, &side.responses),
                    Role::Impact => (Place::Impact, &side.references),
                };
                let each = specific.into_iter().zip(dofs).enumerate();
                all.push(SideConsistency {
                    side: name,
                    role,
                    overall,
                    specific: each
                        .map(|(row, (own, dof))| (placed.key(place(row)), *dof, own))
                        .collect(),
                });
            }
        }
        Ok(all)
    }
}
