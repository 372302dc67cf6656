//! What would make the places of sensors and impacts better.

use bolted_joint_study::overstated_noise;
use bolted_joint_virtual_point::{Role, VirtualPoint, Weights};

use crate::identification::SpatialIdentification;
use crate::problem::Level;
use crate::side::{Interface, Side};
use crate::study::SpatialStudy;

impl SpatialStudy {
    /// What had to be assumed of the files, what the places of sensors and impacts are warned of, and functions that tell nothing;
    /// nothing where the files state their units and each interface has enough places in a good arrangement.
    #[must_use]
    pub fn advice(&self) -> Vec<String> {
        let mut all = self.assumed.clone();
        all.extend(advice(&self.problem.sides));
        all.extend(of_zero_functions(self.zero_functions, self.functions()));
        all
    }
}

impl SpatialIdentification {
    /// What is said of stated noise that is far above the residual.
    #[must_use]
    pub fn overstated_noise(&self, study: &SpatialStudy) -> Option<String> {
        of_noise(study.level, self.reduced_chi_squared)
    }
}

pub(crate) fn of_noise(level: Level, reduced_chi_squared: Option<f64>) -> Option<String> {
    match level {
        Level::Relative(part) => overstated_noise(part, reduced_chi_squared?),
        Level::OfCoherence | Level::OfResiduals => None,
    }
}

/// Of functions that are left out since they are zero, beside those that are used.
pub(crate) fn of_zero_functions(left_out: usize, used: usize) -> Option<String> {
    (left_out > 0).then(|| {
        format!(
            "assembly: {left_out} of {} functions are zero at every line and are left out: computed ones of structures that are \
             symmetric, or channels that are not connected",
            used + left_out
        )
    })
}

/// What the places of sensors and impacts are warned of: too few of them, or a motion that they hardly see.
pub(crate) fn advice(sides: &[Side]) -> Vec<String> {
    let interfaces = sides.iter().flat_map(|side| &side.interfaces);
    let mut all = Vec::new();
    for placed in interfaces {
        let Interface::Points(set_up) = &placed.interface else {
            continue;
        };
        let Ok(point) = VirtualPoint::new(set_up.clone(), &Weights::Equal, &Weights::Equal) else {
            continue;
        };
        for role in [Role::Channel, Role::Impact] {
            let own = point.conditioning(role).advice();
            all.extend(
                own.iter()
                    .map(|advice| format!("{}: {advice}", placed.name)),
            );
        }
    }
    all
}
