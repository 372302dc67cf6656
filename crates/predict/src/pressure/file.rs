//! Pressure fields that a finite-element program has computed, as tables of its nodes.

use std::fmt::Write as _;
use std::path::Path;

use super::{Element, PressureError, PressureField};
use crate::columns::{self, Column, LENGTHS};

/// How far the sum of areas may be from the nominal area, part of it.
const SAME_AREA: f64 = 0.01;

const AREAS: &[(&str, f64)] = &[
    ("mm2", 1e-6),
    ("m2", 1.0),
    ("mm^2", 1e-6),
    ("m^2", 1.0),
    ("mm²", 1e-6),
    ("m²", 1.0),
];
const PRESSURES: &[(&str, f64)] = &[
    ("MPa", 1e6),
    ("Pa", 1.0),
    ("kPa", 1e3),
    ("GPa", 1e9),
    ("N/mm2", 1e6),
    ("N/mm^2", 1e6),
    ("N/mm²", 1e6),
    ("bar", 1e5),
];

impl PressureField {
    /// Reads a table (CSV) with a row for each node: columns `x_mm`, `y_mm`, `area_mm2` and `pressure_MPa`, or in other units.
    ///
    /// Where the interface's nominal area (m²) is known, the rows must add up to it within 1 %.
    ///
    /// # Errors
    /// [`PressureError`] with file and line for what cannot be read, areas that are not positive and negative pressures; for areas
    /// that do not add up.
    pub fn read(
        path: impl AsRef<Path>,
        nominal_area_m2: Option<f64>,
    ) -> Result<Self, PressureError> {
        let column = |name, units| Column { name, units };
        let wanted = [
            column("x", LENGTHS),
            column("y", LENGTHS),
            column("area", AREAS),
            column("pressure", PRESSURES),
        ];
        let table = columns::read(path.as_ref(), "a pressure field (CSV)", wanted)?;
        for &(line, [_, _, area_m2, pressure_pa]) in &table.rows {
            if area_m2 <= 0.0 {
                let found = format!("an area of {area_m2} m²");
                return Err(table.problem(line, found, "a positive one").into());
            }
            if pressure_pa < 0.0 {
                let found = format!("a pressure of {pressure_pa} Pa");
                let expected = "0 or more: contact does not pull; if the program counts compression as negative, \
                                change the sign of the whole column";
                return Err(table.problem(line, found, expected).into());
            }
        }
        let element = |&(_, [x_m, y_m, area_m2, pressure_pa]): &(usize, [f64; 4])| Element {
            x_m,
            y_m,
            area_m2,
            pressure_pa,
        };
        let in_file = |reason: PressureError| PressureError::InFile {
            path: table.path.clone(),
            reason: Box::new(reason),
        };
        let field = Self::new(table.rows.iter().map(element).collect()).map_err(in_file)?;
        let is_same = |nominal_m2: f64| (field.area_m2() / nominal_m2 - 1.0).abs() <= SAME_AREA;
        match nominal_area_m2 {
            Some(nominal_m2) if !is_same(nominal_m2) => Err(in_file(PressureError::Area {
                rows: field.elements().len(),
                found_m2: field.area_m2(),
                nominal_m2,
                percent: 100.0 * SAME_AREA,
            })),
            _ => Ok(field),
        }
    }

    /// The field as [`PressureField::read`] reads it, `comment` above it line by line.
    #[must_use]
    pub fn to_csv(&self, comment: &str) -> String {
        let mut text = String::new();
        for line in comment.lines() {
            let _ = writeln!(text, "# {line}");
        }
        text.push_str("x_mm,y_mm,area_mm2,pressure_MPa\n");
        for element in self.elements() {
            let _ = writeln!(
                text,
                "{},{},{},{}",
                1e3 * element.x_m,
                1e3 * element.y_m,
                1e6 * element.area_m2,
                1e-6 * element.pressure_pa
            );
        }
        text
    }
}
