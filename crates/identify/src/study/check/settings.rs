//! `[bands]`, `[noise]` and `[bodies]`: ranges and signs of what goes with the data.

use super::super::super::bands::{BandChoice, BandChoices};
use super::super::super::layout::Bolts;
use super::super::super::noise::{Noise, StatedFloor, StatedLevel};
use super::super::tables::{LevelTable, NoiseTable};
use bolted_joint_joint::Bodies;
use bolted_joint_study::{StudyError, StudyText};

pub(crate) fn bands(study: &StudyText, choices: &BandChoices) -> Result<(), StudyError> {
    for (name, choice) in [
        ("yy", &choices.yy),
        ("ytheta", &choices.ytheta),
        ("thetatheta", &choices.thetatheta),
    ] {
        let BandChoice::Given(bands) = choice else {
            continue;
        };
        let key = format!("bands.{name}");
        let expected = "bands [from, to] in Hz, \"automatic\" or \"median\"";
        study.ensure(!bands.is_empty(), &key, "an empty list", expected)?;
        for [from, to] in bands {
            let (good, found) = (*from > 0.0 && from < to, format!("[{from}, {to}]"));
            study.ensure(
                good,
                &key,
                found,
                "bands [from, to] in Hz with 0 < from < to",
            )?;
        }
    }
    Ok(())
}

pub(crate) fn noise(study: &StudyText, table: &NoiseTable) -> Result<Noise, StudyError> {
    let assembly = LevelTable {
        relative: table.relative,
        floor: table.floor,
    };
    let of = |key: &str, table: LevelTable| {
        let usable = |value: f64| value.is_finite() && value >= 0.0;
        let LevelTable { relative, floor } = table;
        let floor = floor.0;
        let parts = [
            ("relative", relative),
            // also a floor that is a plain number
            ("floor", floor.yy),
            ("floor.ytheta", floor.ytheta),
            ("floor.thetatheta", floor.thetatheta),
        ];
        if parts.iter().all(|(_, part)| part.is_none_or(usable)) {
            return Ok(StatedLevel { relative, floor });
        }
        let given = parts.map(|(name, value)| Some(format!("{name} = {}", value?)));
        study.refuse(
            key,
            given.into_iter().flatten().collect::<Vec<_>>().join(", "),
            "standard deviations that are finite and not negative",
        )
    };
    let noise = Noise {
        assembly: of("noise", assembly)?,
        a: of("noise.a", table.a)?,
        b: of("noise.b", table.b)?,
    };
    study.ensure(
        noise.assembly.relative != Some(0.0) || noise.assembly.floor != StatedFloor::all(0.0),
        "noise",
        "relative = 0, floor = 0",
        "at least one of them above zero, or left out to be estimated",
    )?;
    Ok(noise)
}

pub(crate) fn bodies(
    study: &StudyText,
    bodies: &Bodies,
    dofs: usize,
    bolts: &Bolts,
) -> Result<(), StudyError> {
    study.ensure(
        bolts.with_own_joint().is_empty(),
        "bodies",
        "them with bolts that differ",
        "them with one joint only; add to each bolt's joint file those around it",
    )?;
    for (side, body) in [("a", &bodies.a), ("b", &bodies.b)] {
        for (name, values) in [
            ("inertia", &body.inertia),
            ("stiffness", &body.stiffness),
            ("damping", &body.damping),
        ] {
            let key = format!("bodies.{side}.{name}");
            let found = format!("{} entries", values.len());
            let expected = format!("{dofs}, one for each DOF of the joint");
            study.ensure(values.len() == dofs, &key, found, expected)?;
            for &value in values {
                if name == "inertia" {
                    let expected = "a mass in kg or moment of inertia in kg·m² above zero";
                    study.positive(&key, value, expected)?;
                } else {
                    study.not_negative(&key, value, "a finite number that is not negative")?;
                }
            }
        }
    }
    Ok(())
}
