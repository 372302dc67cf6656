//! Which sensor or impact does not fit the others, told before the joint is sought: a sign or a place that is wrong would spoil
//! the estimate, and the estimate would not say which it was.

use std::fmt;
use std::ops::Range;

use bolted_joint_frf::Dof;
use bolted_joint_virtual_point::{
    Diagnosis, Place, Role, SetUp, Tolerance, VirtualPoint, VirtualPointError, Weights,
};

use crate::error::SpatialError;
use crate::mirrored::refuse_mirrored;
use crate::problem::Problem;
use crate::side::{Placed, Side};
use crate::study::SpatialStudy;

/// χ² by which errors of that place beyond the budget explain more than those of all places within it. A good one gains as many
/// as it has errors, nine at most, and never above 30 in 30 set-ups.
const BEYOND: f64 = 40.0;

/// χ² by which it has to explain more than any other: else it may be that one.
const BESIDE: f64 = 20.0;

/// A sensor, one of its channels or an impact that does not fit the others.
#[derive(Clone, Debug, PartialEq)]
pub struct Misfit {
    /// Its key in the study, such as `a.sensors[0]`.
    pub key: String,
    /// Its DOFs in the functions.
    pub dofs: Vec<Dof>,
    /// What is wrong with it.
    pub cause: MisfitCause,
}

/// What is wrong with a place that does not fit.
#[derive(Clone, Debug, PartialEq)]
pub enum MisfitCause {
    /// It would fit with another gain, shift or rotation.
    Errs {
        /// What does not fit that goes with it, over what stays, each by its degrees of freedom: about 1 for noise.
        ratio: f64,
        /// By which gain, shift or rotation it would fit.
        diagnosis: Diagnosis,
    },
    /// It stands in the place of another.
    Exchanged {
        /// The other's key in the study.
        key: String,
        /// The other's DOFs in the functions.
        dofs: Vec<Dof>,
    },
}

impl fmt::Display for Misfit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let named = |dofs: &[Dof]| {
            let dofs: Vec<String> = dofs.iter().map(Dof::to_string).collect();
            dofs.join(", ")
        };
        write!(f, "{} ({})", self.key, named(&self.dofs))?;
        match &self.cause {
            MisfitCause::Errs { diagnosis, .. } => write!(
                f,
                " does not fit the others, {diagnosis}: check its direction, sign, position and gain"
            ),
            MisfitCause::Exchanged { key, dofs } => write!(
                f,
                " does not fit the others, nor does {key} ({}), and each would in the place of the other: exchange them",
                named(dofs)
            ),
        }
    }
}

impl SpatialStudy {
    /// The sensors and impacts that stand out from the others of their side by more than the budget allows; one for each
    /// kind and side at most, as more would hide each other. Fewer than eight channels or impacts cannot be judged.
    ///
    /// # Errors
    /// [`SpatialError::Interface`] for functions that cannot be used, [`SpatialError::Mirrored`] for places in mirrored coordinates.
    pub fn misfits(&self) -> Result<Vec<Misfit>, SpatialError> {
        let Problem {
            sides, tolerances, ..
        } = &self.problem;
        let mut misfits = Vec::new();
        for side in sides {
            let Some((placed, set_up)) = side.points() else {
                continue;
            };
            refuse_mirrored(placed, side, set_up)?;
            for role in [Role::Channel, Role::Impact] {
                let tolerance = tolerances.as_ref().map(|tolerances| match role {
                    Role::Channel => &tolerances.sensors,
                    Role::Impact => &tolerances.impacts,
                });
                let found = misfit(placed, side, set_up, role, tolerance);
                misfits.extend(found.map_err(|source| placed.refused(source))?);
            }
        }
        Ok(misfits)
    }
}

fn misfit(
    placed: &Placed,
    side: &Side,
    set_up: &SetUp,
    role: Role,
    tolerance: Option<&Tolerance>,
) -> Result<Option<Misfit>, VirtualPointError> {
    let near = [set_up.channels().count(), set_up.impacts().count()];
    let lines: Vec<_> = side
        .lines
        .iter()
        .map(|line| line.view((0, 0), (near[0], near[1])).into_owned())
        .collect();
    let point = VirtualPoint::new(set_up.clone(), &Weights::Equal, &Weights::Equal)?;
    if let Some(pair) = point.exchanged(role, &lines)? {
        let [one, other] = pair.map(|row| match role {
            Role::Channel => Place::Channel(row),
            Role::Impact => Place::Impact(row),
        });
        return Ok(Some(Misfit {
            key: placed.key(one),
            dofs: dofs(side, set_up, one),
            cause: MisfitCause::Exchanged {
                key: placed.key(other),
                dofs: dofs(side, set_up, other),
            },
        }));
    }
    let Some(suspects) = point.suspects(role, &lines)? else {
        return Ok(None);
    };
    let bad = match tolerance {
        None => suspects.bad,
        Some(tolerance) => {
            let gains = point.beyond_budget(role, &lines, tolerance)?;
            let next = gains.get(1).map_or(0.0, |(_, gain)| *gain);
            let first = gains.first();
            first
                .filter(|(_, gain)| *gain > BEYOND.max(next + BESIDE))
                .map(|(place, _)| *place)
        }
    };
    // of a sensor's channels and the whole the one that explains most
    let bad = bad.and_then(|bad| {
        let bad = rows(set_up, bad);
        let mut ranked = suspects.ranked.into_iter();
        ranked.find(|suspect| bad.contains(&rows(set_up, suspect.place).start))
    });
    Ok(bad.map(|suspect| Misfit {
        key: placed.key(suspect.place),
        dofs: dofs(side, set_up, suspect.place),
        cause: MisfitCause::Errs {
            ratio: suspect.ratio,
            diagnosis: suspect.diagnosis,
        },
    }))
}

/// Its channels, or its impact.
fn rows(set_up: &SetUp, place: Place) -> Range<usize> {
    match place {
        Place::Sensor(number) => set_up.channels().rows_of_each()[number].clone(),
        Place::Channel(row) => row..row + 1,
        Place::Impact(number) => number..number + 1,
    }
}

/// Its DOFs in the functions.
fn dofs(side: &Side, set_up: &SetUp, place: Place) -> Vec<Dof> {
    let all = match place {
        Place::Sensor(_) | Place::Channel(_) => &side.responses,
        Place::Impact(_) => &side.references,
    };
    all[rows(set_up, place)].to_vec()
}
