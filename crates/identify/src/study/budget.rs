//! `budget`: how well the set-up of the test is known.

use std::fmt;

use bolted_joint_study::{Deviation, StudyError, StudyText};
use bolted_joint_systematic::Budget;
use serde::de::value::MapAccessDeserializer;
use serde::de::{self, MapAccess, Visitor};
use serde::{Deserialize, Deserializer};

/// What a standard deviation is in, beyond what it is none of this kind, and what it may be in instead.
#[derive(Clone, Copy)]
struct Unit {
    symbol: &'static str,
    most: f64,
    doubt: &'static str,
}

/// Positions that are less well known are none.
const POSITION: Unit = Unit {
    symbol: "m",
    most: 0.1,
    doubt: "is it in millimetres?",
};
/// Delays of channels are parts of a sample.
const DELAY: Unit = Unit {
    symbol: "s",
    most: 0.01,
    doubt: "is it in microseconds or milliseconds?",
};
const PHASE: Unit = Unit {
    symbol: "rad",
    most: 0.5,
    doubt: "is it in degrees?",
};
/// Of an accelerometer, or of a bolt.
const MASS: Unit = Unit {
    symbol: "kg",
    most: 5.0,
    doubt: "is it in grams?",
};
/// Of a bolt with its washers.
const INERTIA: Unit = Unit {
    symbol: "kg·m²",
    most: 0.1,
    doubt: "is it in g·mm² or kg·mm²?",
};

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
    common_delay: Option<Deviation>,
    delay: Option<Deviation>,
    phase: Option<Deviation>,
    accelerometer_mass: Option<Deviation>,
    position: Option<Deviation>,
    frequency: Option<Deviation>,
    youngs_modulus: Option<Deviation>,
    density: Option<Deviation>,
    beam_damping: Option<Deviation>,
    joint_mass: Option<Deviation>,
    joint_inertia: Option<Deviation>,
    loss_factor: Option<Deviation>,
    fd_stiffness: Option<Deviation>,
    fd_spacing: Option<Deviation>,
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
    let not_negative = |name: &str, unit: &str, value: f64| {
        let expected =
            format!("a standard deviation{unit} that is finite and not negative, or \"exact\"");
        study.not_negative(format_args!("budget.{name}"), value, expected)
    };
    let part = |name: &str, given: Option<Deviation>, otherwise: f64| {
        let Some(Deviation(value)) = given else {
            return Ok(otherwise);
        };
        not_negative(name, "", value)?;
        study.part_of_whole(format_args!("budget.{name}"), value)?;
        Ok::<f64, StudyError>(value)
    };
    let number = |name: &str, unit: Unit, given: Option<Deviation>, otherwise: f64| {
        let Some(Deviation(value)) = given else {
            return Ok(otherwise);
        };
        let Unit {
            symbol,
            most,
            doubt,
        } = unit;
        not_negative(name, &format!(" in {symbol}"), value)?;
        study.ensure(
            value <= most,
            format_args!("budget.{name}"),
            value,
            format_args!("a standard deviation in {symbol}, at most {most} ({doubt})"),
        )?;
        Ok::<f64, StudyError>(value)
    };
    Ok(Budget {
        gain: part("gain", table.gain, careful.gain)?,
        common_gain: part("common_gain", table.common_gain, careful.common_gain)?,
        channel_gain: part("channel_gain", table.channel_gain, careful.channel_gain)?,
        common_delay_s: number(
            "common_delay",
            DELAY,
            table.common_delay,
            careful.common_delay_s,
        )?,
        delay_s: number("delay", DELAY, table.delay, careful.delay_s)?,
        phase_rad: number("phase", PHASE, table.phase, careful.phase_rad)?,
        accelerometer_mass_kg: number(
            "accelerometer_mass",
            MASS,
            table.accelerometer_mass,
            careful.accelerometer_mass_kg,
        )?,
        position_m: number("position", POSITION, table.position, careful.position_m)?,
        frequency: part("frequency", table.frequency, careful.frequency)?,
        youngs_modulus: part(
            "youngs_modulus",
            table.youngs_modulus,
            careful.youngs_modulus,
        )?,
        density: part("density", table.density, careful.density)?,
        structure_damping: part(
            "beam_damping",
            table.beam_damping,
            careful.structure_damping,
        )?,
        joint_mass_kg: number("joint_mass", MASS, table.joint_mass, careful.joint_mass_kg)?,
        joint_inertia_kg_m2: number(
            "joint_inertia",
            INERTIA,
            table.joint_inertia,
            careful.joint_inertia_kg_m2,
        )?,
        loss_factor: part("loss_factor", table.loss_factor, careful.loss_factor)?,
        difference_stiffness: part(
            "fd_stiffness",
            table.fd_stiffness,
            careful.difference_stiffness,
        )?,
        difference_spacing: part("fd_spacing", table.fd_spacing, careful.difference_spacing)?,
    })
}
