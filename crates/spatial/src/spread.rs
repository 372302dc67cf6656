//! How well the unknowns of the joints are known: by noise, and with the errors of the set-up.

use bolted_joint_virtual_point::{Place, Role};
use nalgebra::DMatrix;

use crate::fit::covariance;
use crate::problem::Problem;
use crate::side::Test;

/// Information on an error of the set-up that is known, in parts of what there is.
const KNOWN: f64 = 1e9;

/// What is off as a whole, among the groups.
pub(crate) const WHOLES: &str = "places as a whole";

/// Covariances of the unknowns of the joints.
pub(crate) struct Spread {
    /// With the errors of the set-up.
    pub(crate) all: DMatrix<f64>,
    /// Of noise alone.
    pub(crate) by_noise: DMatrix<f64>,
    /// That of the joints and of the errors of the set-up together.
    pub(crate) together: DMatrix<f64>,
    /// What each kind of errors of the set-up adds by itself.
    pub(crate) groups: Vec<(String, DMatrix<f64>)>,
}

impl Spread {
    /// From the information on joints and errors of the set-up together, and the covariance with a set-up that is known. None
    /// where there is something that nothing is known of.
    pub(crate) fn of(
        problem: &Problem,
        information: &DMatrix<f64>,
        by_noise: DMatrix<f64>,
    ) -> Option<Self> {
        let (count, errors) = (problem.joint_count(), problem.error_count());
        if errors == 0 {
            return Some(Self {
                all: by_noise.clone(),
                together: by_noise.clone(),
                by_noise,
                groups: Vec::new(),
            });
        }
        let together = covariance(information)?;
        // θ follows η by −F_θθ⁻¹ F_θη
        let own = information.view((0, 0), (count, count)).into_owned();
        let follows = covariance(&own)? * information.view((0, count), (count, errors));
        let with = |all: &DMatrix<f64>| {
            let moved = &follows * all.view((count, count), (errors, errors));
            &by_noise + moved * follows.transpose()
        };
        let joint = with(&together);
        let prior = problem.prior();
        let of_wholes = prior.without_wholes().map(|more| {
            let mut known = information.clone();
            let mut own = known.view_mut((count, count), (errors, errors));
            own += more;
            let without = covariance(&known).map_or_else(|| joint.clone(), |all| with(&all));
            (WHOLES.to_owned(), &joint - without)
        });
        let groups = groups(problem)
            .into_iter()
            .map(|(name, columns)| {
                // what is known of it no longer adds
                let mut known = information.clone();
                if let Some(more) = prior.known_alone(&columns) {
                    let mut own = known.view_mut((count, count), (errors, errors));
                    own += more;
                } else {
                    for column in columns {
                        let place = count + column;
                        known[(place, place)] += KNOWN * known[(place, place)];
                    }
                }
                let without = covariance(&known).map_or_else(|| joint.clone(), |all| with(&all));
                (name, &joint - without)
            })
            .chain(of_wholes)
            .collect();
        Some(Self {
            all: joint,
            by_noise,
            together,
            groups,
        })
    }
}

/// Sensors and impacts of each interface, with the places of their errors.
fn groups(problem: &Problem) -> Vec<(String, Vec<usize>)> {
    if problem.tolerances.is_none() {
        return Vec::new();
    }
    let parameters = problem.sides.iter().flat_map(|side| side.parameters());
    let kinds = parameters.map(|one| match (one.test, one.parameter.place) {
        (Test::Assembly(Role::Channel), _) => format!("sensors anew on {}", one.placed.name),
        (Test::Assembly(Role::Impact), _) => format!("hits anew on {}", one.placed.name),
        (_, Place::Sensor(_) | Place::Channel(_)) => format!("sensors of {}", one.placed.name),
        (_, Place::Impact(_)) => format!("impacts of {}", one.placed.name),
    });
    let mut groups: Vec<(String, Vec<usize>)> = Vec::new();
    for (place, kind) in kinds.enumerate() {
        match groups.iter_mut().find(|(name, _)| *name == kind) {
            Some((_, places)) => places.push(place),
            None => groups.push((kind, vec![place])),
        }
    }
    groups
}
