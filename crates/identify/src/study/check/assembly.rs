//! `[assembly]`: files of functions, points and torque.

use std::collections::BTreeMap;
use std::path::PathBuf;

use super::super::super::error::IdentifyError;
use super::super::FrfFile;
use super::super::tables::UnitsTable;
use super::Checker;
use bolted_joint_frf::{Dof, Quantity, UnitSystem};

impl Checker<'_> {
    pub(in super::super) fn at_least_one<T>(&self, tables: &[T]) -> Result<(), IdentifyError> {
        if tables.is_empty() {
            return self.refuse("assembly", "an empty list", "one [[assembly]] or more");
        }
        Ok(())
    }

    /// A file of functions with what `[key]` states beside it.
    pub(in super::super) fn frf_file(
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

    pub(in super::super) fn points(&self, points: Vec<Dof>) -> Result<Vec<Dof>, IdentifyError> {
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

    /// Every point of the assembly has a place on the beam B.
    pub(in super::super) fn points_on_beam(
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

    pub(in super::super) fn torque(
        &self,
        torque: Option<f64>,
    ) -> Result<Option<f64>, IdentifyError> {
        match torque {
            Some(value) if !(value.is_finite() && value >= 0.0) => self.refuse(
                "assembly.torque",
                value.to_string(),
                "a tightening torque in N·m that is not negative",
            ),
            _ => Ok(torque),
        }
    }
}
