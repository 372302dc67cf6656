//! How well a study says that the set-up is known.

use bolted_joint_study::{Deviation, StudyError};
use bolted_joint_virtual_point::{Tolerance, Tolerances};

use crate::chain::part::{Part, PartInterface};
use crate::links::Link;
use crate::prior::Common;
use crate::side::{Anew, Side};
use crate::study::Reader;
use crate::tables::{BudgetTable, DeviationsTable, PoseTable};

/// A standard deviation of the set-up that is larger is in another unit.
const MOST_DEVIATION: f64 = 1.0;

/// Likewise of positions, in parts of the distance from one sensor or impact of an interface to the farthest other one.
const MOST_OF_RIG: f64 = 0.2;

/// What is exact is known so well, in parts of what a careful laboratory knows: a prior of no width has no weight.
pub(crate) const EXACT: f64 = 1e-6;

/// Likewise where a place that is exact by itself may be off as part of a whole: a micrometre, from which rounding leaves the whole's
/// deviation.
pub(crate) const EXACT_IN_A_WHOLE: f64 = 1e-3;

/// How far a hammer hits from where it has hit in another test, and in which direction, and where a sensor is mounted again, with care.
pub(crate) const TYPICAL_ANEW: Tolerance = Tolerance {
    position_m: 1e-3,
    rotation_rad: 0.01,
    gain: 0.0,
};

/// How far all places of an interface are off as a whole, or a joint itself, in a careful laboratory: about as a bolt in its hole.
pub(crate) const TYPICAL_WHOLE: Tolerance = Tolerance {
    position_m: 5e-4,
    rotation_rad: 5e-3,
    gain: 0.0,
};

/// How well the set-up is known.
pub(crate) struct Budget {
    /// Of all tests; `None` where nothing is wrong with it.
    pub(crate) tolerances: Option<Tolerances>,
    /// How far sensors and hits of the assembly are from those of the substructures' tests.
    pub(crate) anew: Anew,
    /// What may be off as a whole.
    pub(crate) common: Common,
}

impl Reader<'_> {
    pub(crate) fn budget(
        &self,
        table: &BudgetTable,
        sides: &[Side; 2],
        parts: &[Part],
        links: &[Link],
    ) -> Result<Budget, StudyError> {
        let DeviationsTable {
            position,
            rotation,
            gain,
            sensors,
            hits,
            origin,
            joint,
        } = match table {
            BudgetTable::None => {
                return Ok(Budget {
                    tolerances: None,
                    anew: Anew::default(),
                    common: Common::default(),
                });
            }
            BudgetTable::Deviations(own) => *own,
        };
        let position_of = |own: Option<PoseTable>| own.and_then(|own| own.position);
        for (key, given) in [
            ("position", position),
            ("sensors.position", position_of(sensors)),
            ("hits.position", position_of(hits)),
            ("origin.position", position_of(origin)),
            ("joint.position", position_of(joint)),
        ] {
            if let Some(Deviation(value)) = given {
                self.ensure_smaller_than_rig(key, value, parts)?;
            }
        }
        let typical = Tolerance::TYPICAL;
        let own = Tolerance {
            position_m: self.deviation("position", position, typical.position_m)?,
            rotation_rad: self.deviation("rotation", rotation, typical.rotation_rad)?,
            gain: self.deviation("gain", gain, typical.gain)?,
        };
        let anew = Anew {
            sensors: self.pose("sensors", sensors, TYPICAL_ANEW)?,
            hits: self.pose("hits", hits, TYPICAL_ANEW)?,
        };
        let common = Common {
            origin: self.pose("origin", origin, TYPICAL_WHOLE)?,
            joint: self.pose("joint", joint, TYPICAL_WHOLE)?,
        };
        if common.joint.is_some() {
            self.ensure_places(sides, links)?;
        }
        // whether anything about a set-up can be wrong
        let has_places = sides.iter().any(|side| !side.parameters().is_empty());
        let has_wholes = common != Common::default();
        let is_known = is_exact(&own) && anew == Anew::default() && !has_wholes;
        let own = match has_wholes {
            true => beside_wholes(&own),
            false => own,
        };
        Ok(Budget {
            tolerances: (has_places && !is_known).then_some(Tolerances {
                sensors: own,
                impacts: own,
            }),
            anew,
            common,
        })
    }

    /// How far something is from where it should be; `None` where nothing says that it is elsewhere.
    fn pose(
        &self,
        name: &str,
        table: Option<PoseTable>,
        typical: Tolerance,
    ) -> Result<Option<Tolerance>, StudyError> {
        let Some(PoseTable { position, rotation }) = table else {
            return Ok(None);
        };
        let of =
            |key: &str, given, typical| self.deviation(&format!("{name}.{key}"), given, typical);
        let own = Tolerance {
            position_m: of("position", position, typical.position_m)?,
            rotation_rad: of("rotation", rotation, typical.rotation_rad)?,
            gain: 0.0,
        };
        Ok((!is_exact(&own)).then_some(own))
    }

    /// A standard deviation, or what it is where none is given; of what is exact, one that is as good as none.
    fn deviation(
        &self,
        key: &str,
        given: Option<Deviation>,
        typical: f64,
    ) -> Result<f64, StudyError> {
        let value = given.map_or(typical, |Deviation(value)| value);
        let expected = "a standard deviation that is finite and not negative, or \"exact\"";
        let key = format_args!("budget.{key}");
        self.study.not_negative(key, value, expected)?;
        let expected = "at most 1: a gain of 0.05 is 5 %, positions are in m, rotations in rad";
        self.study
            .ensure(value <= MOST_DEVIATION, key, value, expected)?;
        Ok(value.max(EXACT * typical))
    }

    /// A joint is beside its point as far as all places about it are off by the opposite: it has to have a place, and these.
    fn ensure_places(&self, sides: &[Side; 2], links: &[Link]) -> Result<(), StudyError> {
        let key = "budget.joint";
        let placed = links.iter().enumerate().filter(|(_, link)| link.is_placed);
        let placed: Vec<_> = placed.collect();
        self.study.ensure(
            !placed.is_empty(),
            key,
            "no joint whose model says where it is",
            "a joint that is sought with another model than \"full\", which is what it is, seen from anywhere; leave the key out",
        )?;
        for (number, link) in placed {
            let mut own = sides.iter().filter_map(|side| side.interfaces.get(number));
            let node = own.find(|placed| placed.points().is_none());
            self.study.ensure(
                node.is_none(),
                key,
                format_args!(
                    "{} between interfaces of which {} is a node",
                    link.key,
                    node.map_or("", |placed| placed.name.as_str())
                ),
                "sensors and impacts on both sides, whose places tell where the joint is; leave the key out, or take model = \"full\"",
            )?;
        }
        Ok(())
    }

    /// Positions that are off by as much as the rig measures are in another unit.
    fn ensure_smaller_than_rig(
        &self,
        key: &str,
        position_m: f64,
        parts: &[Part],
    ) -> Result<(), StudyError> {
        let interfaces = parts.iter().flat_map(|part| &part.interfaces);
        let size_m = interfaces.map(PartInterface::size_m).fold(0.0, f64::max);
        self.study.ensure(
            size_m == 0.0 || position_m <= MOST_OF_RIG * size_m,
            format_args!("budget.{key}"),
            position_m,
            format_args!(
                "a standard deviation in m that is small beside the {size_m:.3} m from one sensor or impact of an interface to \
                 another (is it in millimetres?)"
            ),
        )
    }
}

/// A tolerance of places that may be off as a whole as well.
pub(crate) fn beside_wholes(own: &Tolerance) -> Tolerance {
    let typical = Tolerance::TYPICAL;
    Tolerance {
        position_m: own.position_m.max(EXACT_IN_A_WHOLE * typical.position_m),
        rotation_rad: own
            .rotation_rad
            .max(EXACT_IN_A_WHOLE * typical.rotation_rad),
        gain: own.gain,
    }
}

fn is_exact(tolerance: &Tolerance) -> bool {
    let of = |tolerance: &Tolerance| [tolerance.position_m, tolerance.rotation_rad, tolerance.gain];
    let pairs = of(tolerance).into_iter().zip(of(&Tolerance::TYPICAL));
    pairs
        .into_iter()
        .all(|(own, typical)| own <= EXACT * typical)
}
