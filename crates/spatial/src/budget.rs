//! How well a study says that the set-up is known.

use bolted_joint_study::{Deviation, StudyError};
use bolted_joint_virtual_point::{Tolerance, Tolerances};

use crate::chain::part::{Part, PartInterface};
use crate::side::Side;
use crate::study::Reader;
use crate::tables::{BudgetTable, DeviationsTable};

/// A standard deviation of the set-up that is larger is in another unit.
const MOST_DEVIATION: f64 = 1.0;

/// Likewise of positions, in parts of the distance from one sensor or impact of an interface to the farthest other one.
const MOST_OF_RIG: f64 = 0.2;

/// What is exact is known so well, in parts of what a careful laboratory knows: a prior of no width has no weight.
pub(crate) const EXACT: f64 = 1e-6;

impl Reader<'_> {
    pub(crate) fn tolerances(
        &self,
        table: &BudgetTable,
        sides: &[Side; 2],
        parts: &[Part],
    ) -> Result<Option<Tolerances>, StudyError> {
        let DeviationsTable {
            position,
            rotation,
            gain,
        } = match table {
            BudgetTable::None => return Ok(None),
            BudgetTable::Deviations(own) => *own,
        };
        let value = |key: &str, given: Option<Deviation>, typical: f64| {
            let value = given.map_or(typical, |Deviation(value)| value);
            let expected = "a standard deviation that is finite and not negative, or \"exact\"";
            let key = format_args!("budget.{key}");
            self.study.not_negative(key, value, expected)?;
            let expected = "at most 1: a gain of 0.05 is 5 %, positions are in m, rotations in rad";
            self.study
                .ensure(value <= MOST_DEVIATION, key, value, expected)?;
            Ok::<f64, StudyError>(value.max(EXACT * typical))
        };
        if let Some(Deviation(value)) = position {
            self.ensure_smaller_than_rig(value, parts)?;
        }
        let tolerance = Tolerance {
            position_m: value("position", position, Tolerance::TYPICAL.position_m)?,
            rotation_rad: value("rotation", rotation, Tolerance::TYPICAL.rotation_rad)?,
            gain: value("gain", gain, Tolerance::TYPICAL.gain)?,
        };
        // whether anything about a set-up can be wrong
        let has_places = sides.iter().any(|side| !side.parameters().is_empty());
        Ok((has_places && !is_exact(&tolerance)).then_some(Tolerances {
            sensors: tolerance,
            impacts: tolerance,
        }))
    }

    /// Positions that are off by as much as the rig measures are in another unit.
    fn ensure_smaller_than_rig(&self, position_m: f64, parts: &[Part]) -> Result<(), StudyError> {
        let interfaces = parts.iter().flat_map(|part| &part.interfaces);
        let size_m = interfaces.map(PartInterface::size_m).fold(0.0, f64::max);
        self.study.ensure(
            size_m == 0.0 || position_m <= MOST_OF_RIG * size_m,
            "budget.position",
            position_m,
            format_args!(
                "a standard deviation in m that is small beside the {size_m:.3} m from one sensor or impact of an interface to \
                 another (is it in millimetres?)"
            ),
        )
    }
}

fn is_exact(tolerance: &Tolerance) -> bool {
    let of = |tolerance: &Tolerance| [tolerance.position_m, tolerance.rotation_rad, tolerance.gain];
    let pairs = of(tolerance).into_iter().zip(of(&Tolerance::TYPICAL));
    pairs
        .into_iter()
        .all(|(own, typical)| own <= EXACT * typical)
}
