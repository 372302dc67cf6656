//! `budget`: how well the set-up of the test is known.

use std::fmt;

use bolted_joint_study::{Deviation, StudyError, StudyText};
use bolted_joint_systematic::Budget;
use serde::de::value::MapAccessDeserializer;
use serde::de::{self, MapAccess, Visitor};
use serde::{Deserialize, Deserializer};

/// `budget = "none"`, or a table of standard deviations.
pub(super) enum BudgetKey {
    None,
    Table(Box<BudgetTable>),
}

/// Standard deviations; what is left out is that of a careful laboratory.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct BudgetTable {
    gain: Option<Deviation>,
    common_gain: Option<Deviation>,
    channel_gain: Option<Deviation>,
    delay: Option<Deviation>,
    phase: Option<Deviation>,
    accelerometer_mass: Option<Deviation>,
    position: Option<Deviation>,
    frequency: Option<Deviation>,
    youngs_modulus: Option<Deviation>,
    density: Option<Deviation>,
    joint_mass: Option<Deviation>,
    joint_inertia: Option<Deviation>,
    loss_factor: Option<Deviation>,
    fd_stiffness: Option<Deviation>,
}

impl<'de> Deserialize<'de> for BudgetKey {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct KeyVisitor;
        impl<'de> Visitor<'de> for KeyVisitor {
            type Value = BudgetKey;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("\"none\" or a table of standard deviations")
            }

            fn visit_str<E: de::Error>(self, word: &str) -> Result<BudgetKey, E> {
                match word {
                    "none" => Ok(BudgetKey::None),
                    _ => Err(E::invalid_value(de::Unexpected::Str(word), &self)),
                }
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<BudgetKey, A::Error> {
                let table = BudgetTable::deserialize(MapAccessDeserializer::new(map))?;
                Ok(BudgetKey::Table(Box::new(table)))
            }
        }
        deserializer.deserialize_any(KeyVisitor)
    }
}

/// What a study says of its budget; that of a careful laboratory if it says nothing.
pub(super) fn budget(study: &StudyText, key: Option<BudgetKey>) -> Result<Budget, StudyError> {
    let table = match key {
        None => return Ok(Budget::default()),
        Some(BudgetKey::None) => return Ok(Budget::none()),
        Some(BudgetKey::Table(table)) => table,
    };
    let careful = Budget::default();
    let of = |name: &str, unit: &str, given: Option<Deviation>, otherwise: f64| {
        let Some(Deviation(value)) = given else {
            return Ok(otherwise);
        };
        let expected =
            format!("a standard deviation{unit} that is finite and not negative, or \"exact\"");
        let key = format_args!("budget.{name}");
        study.not_negative(key, value, expected)?;
        if unit.is_empty() {
            study.part_of_whole(key, value)?;
        }
        Ok::<f64, StudyError>(value)
    };
    Ok(Budget {
        gain: of("gain", "", table.gain, careful.gain)?,
        common_gain: of("common_gain", "", table.common_gain, careful.common_gain)?,
        channel_gain: of("channel_gain", "", table.channel_gain, careful.channel_gain)?,
        delay_s: of("delay", " in s", table.delay, careful.delay_s)?,
        phase_rad: of("phase", " in rad", table.phase, careful.phase_rad)?,
        accelerometer_mass_kg: of(
            "accelerometer_mass",
            " in kg",
            table.accelerometer_mass,
            careful.accelerometer_mass_kg,
        )?,
        position_m: of("position", " in m", table.position, careful.position_m)?,
        frequency: of("frequency", "", table.frequency, careful.frequency)?,
        youngs_modulus: of(
            "youngs_modulus",
            "",
            table.youngs_modulus,
            careful.youngs_modulus,
        )?,
        density: of("density", "", table.density, careful.density)?,
        joint_mass_kg: of(
            "joint_mass",
            " in kg",
            table.joint_mass,
            careful.joint_mass_kg,
        )?,
        joint_inertia_kg_m2: of(
            "joint_inertia",
            " in kg·m²",
            table.joint_inertia,
            careful.joint_inertia_kg_m2,
        )?,
        loss_factor: of("loss_factor", "", table.loss_factor, careful.loss_factor)?,
        difference_stiffness: of(
            "fd_stiffness",
            "",
            table.fd_stiffness,
            careful.difference_stiffness,
        )?,
    })
}
