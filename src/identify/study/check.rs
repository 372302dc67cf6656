//! Checks of a study's tables: what passes is complete, physical and without contradiction.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use crate::frf::{Dof, Quantity, UnitSystem};
use crate::joint::Bodies;
use crate::structure::{Beam, Damping, Difference, FiniteDifference, Order};

use super::super::bands::Bands;
use super::super::error::IdentifyError;
use super::super::model::JointModel;
use super::super::noise::{Noise, StatedLevel};
use super::tables::{
    BeamTable, DifferenceTable, FrequencyTable, JointPlaceTable, LevelTable, NoiseTable, OneOrMore,
    SubstructureTable, ThetaTable, UnitsTable,
};
use super::{FrfFile, Rotation, Source, Substructure};

/// Makes errors that name the study's file.
pub(super) struct Checker<'a> {
    pub(super) path: &'a Path,
}

impl Checker<'_> {
    pub(super) fn refuse<T>(
        &self,
        key: impl Into<String>,
        found: impl Into<String>,
        expected: impl Into<String>,
    ) -> Result<T, IdentifyError> {
        Err(IdentifyError::Study {
            path: self.path.to_owned(),
            key: key.into(),
            found: found.into(),
            expected: expected.into(),
        })
    }
}

impl Checker<'_> {
    /// The frequency range to use, Hz; where an end is left out, everything there is.
    pub(super) fn frequency_range(
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

    pub(super) fn bands(&self, bands: &Bands) -> Result<(), IdentifyError> {
        for (name, bands) in bands.named() {
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

    pub(super) fn noise(&self, table: &NoiseTable) -> Result<Noise, IdentifyError> {
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

    pub(super) fn torque(&self, torque: Option<f64>) -> Result<Option<f64>, IdentifyError> {
        match torque {
            Some(value) if !(value.is_finite() && value >= 0.0) => self.refuse(
                "assembly.torque",
                value.to_string(),
                "a tightening torque in N·m that is not negative",
            ),
            _ => Ok(torque),
        }
    }

    pub(super) fn at_least_one<T>(&self, tables: &[T]) -> Result<(), IdentifyError> {
        if tables.is_empty() {
            return self.refuse("assembly", "an empty list", "one [[assembly]] or more");
        }
        Ok(())
    }

    pub(super) fn name(&self, name: &str) -> Result<(), IdentifyError> {
        if name.trim().is_empty() || name.chars().any(char::is_control) {
            return self.refuse("name", format!("{name:?}"), "one line of text");
        }
        Ok(())
    }

    /// Every point of the assembly has a place on the beam B.
    pub(super) fn points_on_beam(
        &self,
        points: &[Dof],
        positions_m: &BTreeMap<Dof, f64>,
    ) -> Result<(), IdentifyError> {
        for point in points {
            if !(point.direction().is_translation() || point.direction().is_rotation()) {
                return self.refuse(
                    "assembly.points",
                    point.to_string(),
                    "a direction such as \"11:+Y\" on a beam",
                );
            }
            if !positions_m.contains_key(point) {
                return self.refuse(
                    "b.points",
                    format!("no position of {point}"),
                    format!("\"{point}\" = its distance from the beam's first end in m"),
                );
            }
        }
        Ok(())
    }

    pub(super) fn substructure(
        &self,
        key: &str,
        table: SubstructureTable,
        folder: &Path,
        model: JointModel,
    ) -> Result<Substructure, IdentifyError> {
        for (name, there) in [
            ("quantity", table.quantity.is_some()),
            ("units", table.units.is_some()),
            ("averages", table.averages.is_some()),
        ] {
            if there && table.frf.is_none() {
                let found = if name == "quantity" {
                    "a quantity"
                } else {
                    name
                };
                return self.refuse(format!("{key}.{name}"), found, "it beside `frf` only");
            }
        }
        let source = match (table.frf, table.modal, table.beam) {
            (Some(path), None, None) => Source::Frf(self.frf_file(
                key,
                folder.join(path),
                table.quantity,
                table.units.as_ref(),
                table.averages,
            )?),
            (None, Some(path), None) => Source::Modal(folder.join(path)),
            (None, None, Some(beam)) => {
                let beam = self.beam(key, beam)?;
                let joint_m = self.position(key, &table.joint)?;
                let labelled = table
                    .points
                    .iter()
                    .map(|(point, &x_m)| (format!("points.\"{point}\""), x_m));
                for (place, x_m) in std::iter::once(("joint.x".to_owned(), joint_m)).chain(labelled)
                {
                    self.on_the_beam(&format!("{key}.{place}"), x_m, beam.length_m)?;
                }
                return Ok(Substructure::Beam {
                    beam,
                    joint_m,
                    positions_m: table.points,
                });
            }
            (frf, modal, beam) => {
                let given = [
                    ("frf", frf.is_some()),
                    ("modal", modal.is_some()),
                    ("beam", beam.is_some()),
                ];
                return self.refuse(
                    key,
                    names_given("no source", &given),
                    "exactly one of `frf`, `modal` and `beam`",
                );
            }
        };
        if !table.points.is_empty() {
            return self.refuse(
                format!("{key}.points"),
                "positions",
                "them beside `beam` only; measured points have labels",
            );
        }
        let key = format!("{key}.joint");
        let (None, Some(y)) = (table.joint.x, table.joint.y) else {
            return self.refuse(
                key,
                keys_given(&table.joint),
                "{ y = \"node:+Y\", theta = … } with the labels of the measured points",
            );
        };
        Ok(Substructure::Measured {
            source,
            y,
            theta: self.rotation(&key, y, table.joint.theta, model)?,
        })
    }

    /// A file of functions with what `[key]` states beside it.
    pub(super) fn frf_file(
        &self,
        key: &str,
        path: PathBuf,
        quantity: Option<Quantity>,
        units: Option<&UnitsTable>,
        averages: Option<f64>,
    ) -> Result<FrfFile, IdentifyError> {
        let units = match units {
            None => None,
            Some(UnitsTable { length, force }) => {
                let Some(units) = UnitSystem::named(length, force) else {
                    return self.refuse(
                        format!("{key}.units"),
                        format!("length = {length:?}, force = {force:?}"),
                        "units of length and force such as { length = \"mm\", force = \"N\" }",
                    );
                };
                Some(units)
            }
        };
        if let Some(found) = averages.filter(|n| !(n.is_finite() && *n >= 1.0)) {
            return self.refuse(
                format!("{key}.averages"),
                found.to_string(),
                "a number of at least 1",
            );
        }
        Ok(FrfFile {
            path,
            quantity,
            units,
            averages,
        })
    }

    fn position(&self, key: &str, joint: &JointPlaceTable) -> Result<f64, IdentifyError> {
        match (joint.x, joint.y, &joint.theta) {
            (Some(x), None, None) => Ok(x),
            _ => self.refuse(
                format!("{key}.joint"),
                keys_given(joint),
                "{ x = distance from the beam's first end in m }",
            ),
        }
    }

    /// A length that is none is left to the beam's own check.
    fn on_the_beam(&self, key: &str, x_m: f64, length_m: f64) -> Result<(), IdentifyError> {
        if (0.0..=length_m).contains(&x_m) || length_m.is_nan() || length_m <= 0.0 {
            return Ok(());
        }
        self.refuse(
            key,
            x_m.to_string(),
            format!("a position on the beam, from 0 to {length_m} m"),
        )
    }

    fn rotation(
        &self,
        key: &str,
        y: Dof,
        theta: Option<ThetaTable>,
        model: JointModel,
    ) -> Result<Option<Rotation>, IdentifyError> {
        let key = format!("{key}.theta");
        match theta {
            None if model.dofs() == 1 => Ok(None),
            None => self.refuse(
                key,
                "nothing",
                format!("a rotation, which joint model \"{model}\" needs: a measured one or {{ points = […], spacing = … }}"),
            ),
            Some(_) if model.dofs() == 1 => Ok(None),
            Some(ThetaTable::Measured(dof)) if dof.direction().is_rotation() => {
                Ok(Some(Rotation::Measured(dof)))
            }
            Some(ThetaTable::Measured(dof)) => {
                self.refuse(key, dof.to_string(), "a rotation such as \"2:+RZ\"")
            }
            Some(ThetaTable::Difference(table)) => self.difference(&key, y, table).map(Some),
        }
    }

    fn difference(
        &self,
        key: &str,
        y: Dof,
        table: DifferenceTable,
    ) -> Result<Rotation, IdentifyError> {
        let DifferenceTable {
            points,
            spacing,
            difference,
        } = table;
        if !(spacing.is_finite() && spacing > 0.0) {
            return self.refuse(
                format!("{key}.spacing"),
                spacing.to_string(),
                "the distance between neighbouring points in m",
            );
        }
        let order = match points.len() {
            2 => Some(Order::First),
            3 => Some(Order::Second),
            _ => None,
        };
        let found = order.and_then(|order| FiniteDifference::new(difference, order, spacing));
        let Some(found) = found else {
            let expected = match difference {
                Difference::Central => "three points, the joint's in the middle",
                Difference::Forward | Difference::Backward => {
                    "two or three points, the joint's last and the farthest first"
                }
            };
            let count = points.len();
            return self.refuse(format!("{key}.points"), format!("{count} points"), expected);
        };
        let joint = points[found.joint_point()];
        if joint != y {
            let (place, what) = match difference {
                Difference::Central => ("in the middle", "central"),
                Difference::Forward => ("at the end", "forward"),
                Difference::Backward => ("at the end", "backward"),
            };
            return self.refuse(
                format!("{key}.points"),
                format!("{joint} {place}"),
                format!("the joint's own translation {y} there: the difference is {what}"),
            );
        }
        Ok(Rotation::Difference {
            points,
            difference: found,
        })
    }

    fn beam(&self, key: &str, table: BeamTable) -> Result<Beam, IdentifyError> {
        let damping = match (table.damping_ratio, table.loss_factor) {
            (Some(OneOrMore::One(ratio)), None) => Damping::Ratios(vec![ratio]),
            (Some(OneOrMore::More(ratios)), None) => Damping::Ratios(ratios),
            (None, Some(eta)) => Damping::LossFactor(eta),
            (ratio, _) => {
                return self.refuse(
                    format!("{key}.beam"),
                    if ratio.is_some() {
                        "both damping_ratio and loss_factor"
                    } else {
                        "neither damping_ratio nor loss_factor"
                    },
                    "exactly one of them",
                );
            }
        };
        Ok(Beam {
            length_m: table.length,
            width_m: table.width,
            height_m: table.height,
            youngs_modulus_pa: table.youngs_modulus,
            density_kg_per_m3: table.density,
            boundary: table.boundary,
            damping,
        })
    }

    pub(super) fn points(&self, points: Vec<Dof>) -> Result<Vec<Dof>, IdentifyError> {
        if points.is_empty() {
            return self.refuse(
                "assembly.points",
                "an empty list",
                "one or more measured points of B, three for the best result",
            );
        }
        for (index, point) in points.iter().enumerate() {
            let before = &points[..index];
            if let Some(same) = before.iter().find(|&p| p == point || *p == point.flipped()) {
                return self.refuse(
                    "assembly.points",
                    if same == point {
                        format!("{point} twice")
                    } else {
                        format!("both {same} and {point}, which are one point")
                    },
                    "every point once",
                );
            }
        }
        Ok(points)
    }

    pub(super) fn bodies(&self, bodies: &Bodies, dofs: usize) -> Result<(), IdentifyError> {
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

fn keys_given(joint: &JointPlaceTable) -> String {
    let given = [
        ("x", joint.x.is_some()),
        ("y", joint.y.is_some()),
        ("theta", joint.theta.is_some()),
    ];
    names_given("no key", &given)
}

/// The names of the keys that are there, or `none`.
fn names_given(none: &str, keys: &[(&str, bool)]) -> String {
    let given: Vec<&str> = keys
        .iter()
        .filter_map(|&(name, there)| there.then_some(name))
        .collect();
    if given.is_empty() {
        none.to_owned()
    } else {
        given.join(" and ")
    }
}
