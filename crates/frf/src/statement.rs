//! What the header of a table or an array says of a function, made into a quantity and a factor to SI.

use super::unit_label::Unit;
use super::{Dof, Quantity, ReadOptions, StatedBy, TableProblem, UnitStatement};

/// What is stated of one function.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Statement<'a> {
    pub(super) response: Dof,
    pub(super) reference: Dof,
    pub(super) quantity: Option<Quantity>,
    /// Unit of the ratio, such as `m/N`.
    pub(super) unit: Option<&'a str>,
}

/// The quantity of a function, and what its values are multiplied by to be SI.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Stated {
    pub(super) quantity: (Quantity, StatedBy),
    pub(super) to_si: f64,
    pub(super) units: UnitStatement,
}

/// What the user can do about a unit.
const STATE_UNITS: &str =
    "state units in the study, such as units = { length = \"mm\", force = \"N\" } beside frf";

impl Statement<'_> {
    /// Decides what the values are, the caller's word first.
    pub(super) fn decide(self, options: &ReadOptions) -> Result<Stated, TableProblem> {
        let (response, reference) = (self.response, self.reference);
        let unit = match self.unit {
            None => None,
            Some(label) => {
                let read =
                    Unit::from_label(label).filter(|u| u.force == -1 && (-2..=0).contains(&u.time));
                if read.is_none()
                    && (options.units.is_none() || options.quantity.or(self.quantity).is_none())
                {
                    return Err(TableProblem::of_function(
                        (response, reference),
                        format_args!("the unit \"{label}\""),
                        format_args!(
                            "a unit of motion per load such as m/N, (m/s^2)/N, 1/kg, g/lbf or rad/N·m; correct the file, or {STATE_UNITS}"
                        ),
                    ));
                }
                read.map(|unit| (label, unit))
            }
        };
        let by_unit =
            unit.and_then(|(label, u)| Some((label, Quantity::from_time_derivatives(-u.time)?)));
        let quantity = match (options.quantity, self.quantity, by_unit) {
            (Some(quantity), ..) => (quantity, StatedBy::Caller),
            (None, Some(stated), Some((label, by_unit))) if stated != by_unit => {
                return Err(TableProblem::of_function(
                    (response, reference),
                    format_args!(
                        "the quantity {stated} and the unit \"{label}\", which means {by_unit}"
                    ),
                    format_args!(
                        "one quantity. Correct the file, or state the right one in the study, such as quantity = \"{stated}\" beside frf"
                    ),
                ));
            }
            (None, Some(quantity), _) | (None, None, Some((_, quantity))) => {
                (quantity, StatedBy::File)
            }
            (None, None, None) => {
                return Err(TableProblem::of_function(
                    (response, reference),
                    "neither a quantity nor a unit",
                    "receptance, mobility or accelerance, or a unit such as [m/s^2/N]; state it in the file, or in the study, such as \
                     quantity = \"accelerance\" beside frf",
                ));
            }
        };
        let (motion, load) = (motion_exponents(response), load_exponents(reference));
        if let Some(units) = options.units {
            let to_si = units.to_si(motion.0, motion.1) / units.to_si(load.0, load.1);
            return Ok(Stated {
                quantity,
                to_si,
                units: UnitStatement::Caller(units),
            });
        }
        match unit {
            Some((label, unit)) if unit.length != motion.0 - load.0 => {
                Err(TableProblem::of_function(
                    (response, reference),
                    format_args!(
                        "the unit \"{label}\", which is not one of that response per that reference"
                    ),
                    format_args!(
                        "metres or radians per newton or newton metre as their directions say. Correct the directions or the unit, or {STATE_UNITS}"
                    ),
                ))
            }
            _ => Ok(Stated {
                quantity,
                to_si: unit.map_or(1.0, |(_, unit)| unit.to_si),
                units: unit.map_or(UnitStatement::Assumed, |(label, _)| {
                    UnitStatement::Label(label.to_owned())
                }),
            }),
        }
    }
}

/// Length and force exponents of a motion: m, or rad.
fn motion_exponents(response: Dof) -> (i32, i32) {
    match response.direction().is_rotation() {
        true => (0, 0),
        false => (1, 0),
    }
}

/// Length and force exponents of a load: N, or N·m.
fn load_exponents(reference: Dof) -> (i32, i32) {
    match reference.direction().is_rotation() {
        true => (1, 1),
        false => (0, 1),
    }
}
