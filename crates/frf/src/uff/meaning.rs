//! What the numbers of a function mean: data types, labels and units put together, and refused where they disagree.

use super::UffProblem;
use super::data_type::{Kind, data_type_name, inverse_name, kind};
use super::header::{Axis, Header, InRecord};
use super::scale::{NO_UNIT, UnitLabels, decide_scale};
use super::units::UnitSystem;
use crate::unit_label::Unit;
use crate::{Quantity, ReadOptions, StatedBy, UnitStatement};

/// The quantity of a function, and what its values are multiplied by to be SI.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Meaning {
    pub(super) quantity: (Quantity, StatedBy),
    pub(super) to_si: f64,
    pub(super) units: UnitStatement,
}

/// A statement of the file, for messages.
struct Statement {
    record: usize,
    text: String,
    quantity: Quantity,
}

/// Decides what a function's values are.
///
/// # Errors
/// The record (8 to 10) at fault, and what is wrong.
pub(super) fn decide(
    header: &Header,
    dataset_164: Option<UnitSystem>,
    options: &ReadOptions,
) -> Result<Meaning, InRecord> {
    check_abscissa(&header.abscissa)?;
    let labels = UnitLabels::read(header)?;
    let quantity = decide_quantity(header, &labels, options)?;
    let (to_si, units) = decide_scale(header, &labels, dataset_164, options)?;
    Ok(Meaning {
        quantity,
        to_si,
        units,
    })
}

pub(super) fn check_abscissa(axis: &Axis) -> Result<(), InRecord> {
    let other_unit = [
        "rad/s", "rad/sec", "1/min", "rpm", "cpm", "khz", "s", "sec", "ms",
    ]
    .contains(&axis.units_label.to_lowercase().as_str());
    let found = match axis.data_type {
        0 | 1 | 18 if other_unit => format!("unit \"{}\"", axis.units_label),
        0 | 1 | 18 => return Ok(()),
        other => data_type_name(other),
    };
    Err((8, UffProblem::AbscissaNotFrequency { found }))
}

fn decide_quantity(
    header: &Header,
    labels: &UnitLabels,
    options: &ReadOptions,
) -> Result<(Quantity, StatedBy), InRecord> {
    let (numerator, denominator) = (header.numerator.data_type, header.denominator.data_type);
    let by_type = match (kind(numerator), kind(denominator)) {
        // An unstated denominator of a frequency response function is its load.
        (Kind::Motion(derivatives), Kind::Load | Kind::Unstated) => {
            Quantity::from_time_derivatives(derivatives)
        }
        (Kind::Unstated, Kind::Load | Kind::Unstated) => None,
        (Kind::Load, Kind::Motion(derivatives)) => {
            let found = inverse_name(derivatives);
            let stated_by = format!(
                "{} per {}",
                data_type_name(numerator),
                data_type_name(denominator)
            );
            return Err((9, UffProblem::Inverse { found, stated_by }));
        }
        _ => {
            return Err((
                9,
                UffProblem::NotMotionPerLoad {
                    numerator: data_type_name(numerator),
                    denominator: data_type_name(denominator),
                },
            ));
        }
    };
    let by_type = by_type.map(|quantity| Statement {
        record: 9,
        text: format!("{} in record 9", data_type_name(numerator)),
        quantity,
    });
    let by_unit = labels
        .ratio
        .or(labels.numerator)
        .filter(|unit| unit.force == -1 || unit.length != 0 || unit.time != 0)
        .and_then(|unit| Quantity::from_time_derivatives(-unit.time))
        .map(|quantity| Statement {
            record: 9,
            text: format!("the unit \"{}\" in record 9", header.numerator.units_label),
            quantity,
        });
    let by_label = quantity_of_axis_label(&header.numerator.label)?;
    if let Some(quantity) = options.quantity {
        return Ok((quantity, StatedBy::Caller));
    }
    let mut statements = [by_type, by_unit, by_label].into_iter().flatten();
    let first = statements.next().ok_or_else(|| (9, unknown(header)))?;
    match statements.find(|statement| statement.quantity != first.quantity) {
        None => Ok((first.quantity, StatedBy::File)),
        Some(second) => Err((
            second.record,
            UffProblem::ContradictingQuantities {
                first_statement: first.text,
                first: first.quantity,
                second_statement: second.text,
                second: second.quantity,
            },
        )),
    }
}

/// Nothing tells the quantity: what the ordinate is labelled with is quoted.
fn unknown(header: &Header) -> UffProblem {
    let axis = &header.numerator;
    let labels = [axis.units_label.trim(), axis.label.trim()];
    let says_something = |label: &&str| {
        let is_none = NO_UNIT.contains(&label.to_lowercase().as_str());
        !is_none && Unit::from_label(label).is_none()
    };
    match labels.into_iter().find(says_something) {
        None => UffProblem::UnknownQuantity,
        Some(label) => UffProblem::UnreadQuantity {
            found: format!("\"{}\"", crate::shown(label)),
        },
    }
}

/// What the label of the ordinate says in words, if it says one thing.
fn quantity_of_axis_label(label: &str) -> Result<Option<Statement>, InRecord> {
    let lower = label.to_lowercase();
    let inverse = [
        "dynamic stiffness",
        "impedance",
        "apparent mass",
        "dynamic mass",
    ];
    if inverse.iter().any(|word| lower.contains(word)) {
        let found = match inverse.iter().position(|word| lower.contains(word)) {
            Some(0) => inverse_name(0),
            Some(1) => inverse_name(1),
            _ => inverse_name(2),
        };
        let stated_by = format!("the label \"{label}\" in record 9");
        return Err((9, UffProblem::Inverse { found, stated_by }));
    }
    let mut named = Quantity::WORDS
        .iter()
        .filter(|(_, words)| words.iter().any(|word| lower.contains(word)))
        .map(|(quantity, _)| *quantity);
    Ok(match (named.next(), named.next()) {
        (Some(quantity), None) => Some(Statement {
            record: 9,
            text: format!("the label \"{label}\" in record 9"),
            quantity,
        }),
        _ => None,
    })
}

/// Headers for the tests of what they mean.
#[cfg(test)]
pub(super) mod examples {
    use super::super::header::Layout;
    use super::*;
    use crate::Selection;

    pub(in crate::uff) fn axis(data_type: i64, label: &str, units_label: &str) -> Axis {
        Axis {
            data_type,
            length_exponent: 0,
            force_exponent: 0,
            label: label.to_owned(),
            units_label: units_label.to_owned(),
        }
    }

    pub(in crate::uff) fn header(numerator: Axis, denominator: Axis) -> Header {
        Header {
            response: "1:Y".parse().unwrap(),
            reference: "2:Y".parse().unwrap(),
            layout: Layout {
                complex: true,
                double: true,
                even: Some((0.0, 1.0)),
                lines: 1,
            },
            abscissa: axis(18, "Frequency", "Hz"),
            numerator,
            denominator,
        }
    }

    pub(in crate::uff) const NO_OPTIONS: ReadOptions = ReadOptions {
        quantity: None,
        units: None,
        averages: None,
        selection: Selection::ALL,
    };

    pub(in crate::uff) fn decided(
        numerator: Axis,
        denominator: Axis,
        units: Option<UnitSystem>,
    ) -> Result<Meaning, UffProblem> {
        decide(&header(numerator, denominator), units, &NO_OPTIONS).map_err(|(_, problem)| problem)
    }

    pub(in crate::uff) fn force() -> Axis {
        axis(13, "", "")
    }
}

#[cfg(test)]
mod tests {
    use super::examples::{NO_OPTIONS, axis, decided, force, header};
    use super::*;
    use Quantity::{Accelerance, Mobility, Receptance};

    #[test]
    fn data_types_decide_the_quantity() {
        for (data_type, quantity) in [(8, Receptance), (11, Mobility), (12, Accelerance)] {
            for denominator in [9, 13, 0] {
                let meaning =
                    decided(axis(data_type, "", ""), axis(denominator, "", ""), None).unwrap();
                assert_eq!(
                    meaning,
                    Meaning {
                        quantity: (quantity, StatedBy::File),
                        to_si: 1.0,
                        units: UnitStatement::Assumed
                    }
                );
            }
        }
    }

    #[test]
    fn labels_decide_where_types_are_unknown() {
        for (label, unit, quantity) in [
            ("Inertance", "", Accelerance),
            ("", "(m/s)/N", Mobility),
            ("Dynamic compliance", "m/N", Receptance),
            ("FRF", "1/kg", Accelerance),
            ("", "g", Accelerance),
        ] {
            let meaning = decided(axis(0, label, unit), axis(0, "", ""), None).unwrap();
            assert_eq!(meaning.quantity.0, quantity, "{label} {unit}");
        }
        for (label, unit, quoted) in [
            ("", "", None),
            ("", "1", None),
            ("FRF", "V/V", Some("\"V/V\"")),
            (
                "velocity/displacement",
                "",
                Some("\"velocity/displacement\""),
            ),
            ("", "furlong/pond", Some("\"furlong/pond\"")),
        ] {
            let problem = decided(axis(0, label, unit), force(), None).unwrap_err();
            let found = match problem {
                UffProblem::UnknownQuantity => None,
                UffProblem::UnreadQuantity { found } => Some(found),
                other => panic!("{label} {unit}: {other}"),
            };
            assert_eq!(found.as_deref(), quoted, "{label} {unit}");
        }
    }

    #[test]
    fn statements_that_disagree_are_refused_with_both_and_the_override_settles_it() {
        for (data_type, label, unit, first, second) in [
            (12, "Receptance", "", Accelerance, Receptance),
            (12, "", "m/N", Accelerance, Receptance),
            (0, "Receptance", "(m/s)/N", Mobility, Receptance),
            (8, "Displacement", "m/s^2", Receptance, Accelerance),
        ] {
            let header = header(axis(data_type, label, unit), force());
            let (record, problem) = decide(&header, None, &NO_OPTIONS).unwrap_err();
            let found = match problem {
                UffProblem::ContradictingQuantities { first, second, .. } => (first, second),
                other => panic!("{other}"),
            };
            assert_eq!((record, found), (9, (first, second)));
            let stated = ReadOptions {
                quantity: Some(Mobility),
                ..ReadOptions::default()
            };
            assert_eq!(
                decide(&header, None, &stated).unwrap().quantity,
                (Mobility, StatedBy::Caller)
            );
        }
    }

    #[test]
    fn loads_per_motion_and_other_ratios_are_refused_by_name() {
        for (numerator, denominator, name) in [
            ((13, "", ""), 8, "dynamic stiffness"),
            ((9, "", ""), 11, "impedance"),
            ((13, "", ""), 12, "apparent mass"),
            ((0, "Apparent Mass", ""), 0, "apparent mass"),
            ((0, "", "N/m"), 0, "dynamic stiffness"),
            ((0, "", "N/(m/s)"), 0, "impedance"),
            ((0, "", "N s^2/m"), 0, "apparent mass"),
        ] {
            let (data_type, label, unit) = numerator;
            let numerator = axis(data_type, label, unit);
            let problem = decided(numerator, axis(denominator, "", ""), None).unwrap_err();
            assert!(
                matches!(&problem, UffProblem::Inverse { found, .. } if *found == name),
                "{problem}"
            );
        }
        for (numerator, denominator) in [(12, 12), (13, 13), (3, 13), (12, 15), (99, 13)] {
            let problem =
                decided(axis(numerator, "", ""), axis(denominator, "", ""), None).unwrap_err();
            assert!(
                matches!(problem, UffProblem::NotMotionPerLoad { .. }),
                "{problem}"
            );
        }
    }

    #[test]
    fn only_frequency_in_hertz_is_an_abscissa() {
        let with_abscissa = |abscissa| {
            let mut header = header(axis(12, "", ""), force());
            header.abscissa = abscissa;
            decide(&header, None, &NO_OPTIONS)
                .map_err(|(record, problem)| (record, problem.to_string()))
        };
        for good in [
            axis(18, "", ""),
            axis(0, "", "Hz"),
            axis(1, "Frequency", "hertz"),
        ] {
            assert!(with_abscissa(good).is_ok());
        }
        for (bad, named) in [
            (axis(17, "", ""), "time"),
            (axis(19, "", "Hz"), "rotational speed"),
            (axis(18, "", "rad/s"), "rad/s"),
        ] {
            let (record, message) = with_abscissa(bad).unwrap_err();
            assert_eq!(record, 8);
            assert!(message.contains(named), "{message}");
        }
    }
}
