//! `[frequency]`, `[bands]`, `[noise]` and `[bodies]`: ranges and signs of what goes with the data.

use super::super::super::bands::{BandChoice, BandChoices};
use super::super::super::error::IdentifyError;
use super::super::super::layout::Bolts;
use super::super::super::noise::{Noise, StatedLevel};
use super::super::tables::{FrequencyTable, LevelTable, NoiseTable};
use super::Checker;
use bolted_joint_joint::Bodies;

impl Checker<'_> {
    /// The frequency range to use, Hz; where an end is left out, everything there is.
    pub(in super::super) fn frequency_range(
        &self,
        table: &FrequencyTable,
    ) -> Result<[f64; 2], IdentifyError> {
        let from = table.from.unwrap_or(f64::MIN_POSITIVE);
        let to = table.to.unwrap_or(f64::MAX);
        if from > 0.0 && from < to {
            return Ok([from, to]);
        }
        self.refuse(
            "frequency",
            match (table.from, table.to) {
                (Some(from), None) => format!("from {from}"),
                (None, Some(to)) => format!("to {to}"),
                _ => format!("from {from} to {to}"),
            },
            "frequencies in Hz with 0 < from < to",
        )
    }

    pub(in super::super) fn bands(&self, choices: &BandChoices) -> Result<(), IdentifyError> {
        for (name, choice) in [
            ("yy", &choices.yy),
            ("ytheta", &choices.ytheta),
            ("thetatheta", &choices.thetatheta),
        ] {
            let BandChoice::Given(bands) = choice else {
                continue;
            };
            if bands.is_empty() {
                return self.refuse(
                    format!("bands.{name}"),
                    "an empty list",
                    "bands [from, to] in Hz, \"automatic\" or \"median\"",
                );
            }
            if let Some([from, to]) = bands.iter().find(|[from, to]| !(*from > 0.0 && from < to)) {
                return self.refuse(
                    format!("bands.{name}"),
                    format!("[{from}, {to}]"),
                    "bands [from, to] in Hz with 0 < from < to",
                );
            }
        }
        Ok(())
    }

    pub(in super::super) fn noise(&self, table: &NoiseTable) -> Result<Noise, IdentifyError> {
        let assembly = LevelTable {
            relative: table.relative,
            floor: table.floor,
        };
        let of = |key: &str, table: LevelTable| {
            let usable = |value: f64| value.is_finite() && value >= 0.0;
            let LevelTable { relative, floor } = table;
            if relative.is_none_or(usable) && floor.is_none_or(usable) {
                return Ok(StatedLevel { relative, floor });
            }
            let show = |name: &str, value: Option<f64>| Some(format!("{name} = {}", value?));
            let given = [show("relative", relative), show("floor", floor)];
            self.refuse(
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
        if noise.assembly.relative == Some(0.0) && noise.assembly.floor == Some(0.0) {
            return self.refuse(
                "noise",
                "relative = 0, floor = 0",
                "at least one of them above zero, or left out to be estimated",
            );
        }
        Ok(noise)
    }

    pub(in super::super) fn bodies(
        &self,
        bodies: &Bodies,
        dofs: usize,
        bolts: &Bolts,
    ) -> Result<(), IdentifyError> {
        if !bolts.with_own_joint().is_empty() {
            return self.refuse(
                "bodies",
                "them with bolts that differ",
                "them with one joint only; add to each bolt's joint file those around it",
            );
        }
        for (side, body) in [("a", &bodies.a), ("b", &bodies.b)] {
            for (name, values) in [
                ("inertia", &body.inertia),
                ("stiffness", &body.stiffness),
                ("damping", &body.damping),
            ] {
                let key = format!("bodies.{side}.{name}");
                if values.len() != dofs {
                    return self.refuse(
                        key,
                        format!("{} entries", values.len()),
                        format!("{dofs}, one for each DOF of the joint"),
                    );
                }
                let usable = |value: f64| {
                    value.is_finite() && (value > 0.0 || value == 0.0 && name != "inertia")
                };
                if let Some(value) = values.iter().find(|&&value| !usable(value)) {
                    let expected = if name == "inertia" {
                        "a mass in kg or moment of inertia in kg·m² above zero"
                    } else {
                        "a finite number that is not negative"
                    };
                    return self.refuse(key, value.to_string(), expected);
                }
            }
        }
        Ok(())
    }
}
