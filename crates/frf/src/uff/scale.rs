//! From the units of a file to SI: data set 164, unit labels and the caller's word, refused where they disagree.

use super::UffProblem;
use super::data_type::{inverse_name, is_load};
use super::header::{Axis, Header, InRecord};
use super::units::{UnitSystem, agree};
use crate::unit_label::Unit;
use crate::{Direction, ReadOptions, UnitStatement};

/// The unit labels of records 9 and 10, as far as they can be read.
pub(super) struct UnitLabels {
    /// Unit of the whole ratio, in record 9.
    pub(super) ratio: Option<Unit>,
    /// Unit of the numerator alone, in record 9.
    pub(super) numerator: Option<Unit>,
    /// Unit of the denominator, in record 10.
    denominator: Option<Unit>,
}

impl UnitLabels {
    pub(super) fn read(header: &Header) -> Result<Self, InRecord> {
        let label = &header.numerator.units_label;
        let ordinate = Unit::from_label(label).filter(|unit| (-2..=2).contains(&unit.time));
        if let Some(unit) =
            ordinate.filter(|unit| unit.force == 1 && !is_load(header.numerator.data_type))
        {
            // F/x has the time dimension of the motion with its sign turned.
            let found = inverse_name(unit.time);
            let stated_by = format!("the unit \"{label}\" in record 9");
            return Err((9, UffProblem::Inverse { found, stated_by }));
        }
        let motion = ordinate.filter(|unit| unit.time <= 0);
        Ok(Self {
            ratio: motion.filter(|unit| unit.force == -1),
            numerator: motion.filter(|unit| unit.force == 0),
            denominator: Unit::from_label(&header.denominator.units_label)
                .filter(|unit| unit.force == 1 && unit.time == 0),
        })
    }
}

/// What analysers write where they know no unit, in lower case.
pub(super) const NO_UNIT: &[&str] = &["", "-", "none", "no units", "unitless", "unknown", "n/a"];

/// Length and force exponents of one axis: from its direction, or from its record where there is no direction.
fn exponents(
    axis: &Axis,
    direction: Direction,
    translation: (i32, i32),
    rotation: (i32, i32),
) -> (i32, i32) {
    let stated = (axis.length_exponent, axis.force_exponent);
    match direction {
        Direction::Scalar if stated != (0, 0) => stated,
        _ if direction.is_rotation() => rotation,
        _ => translation,
    }
}

/// The factor to SI, and who states the units.
pub(super) fn decide_scale(
    header: &Header,
    labels: &UnitLabels,
    dataset_164: Option<UnitSystem>,
    options: &ReadOptions,
) -> Result<(f64, UnitStatement), InRecord> {
    // Motion is a length or an angle; the load is a force or a moment (Addendum A of the standard).
    let motion = exponents(
        &header.numerator,
        header.response.direction(),
        (1, 0),
        (0, 0),
    );
    let load = exponents(
        &header.denominator,
        header.reference.direction(),
        (0, 1),
        (1, 1),
    );
    let factors =
        |units: UnitSystem| (units.to_si(motion.0, motion.1), units.to_si(load.0, load.1));
    if let Some(units) = options.units {
        let (numerator, denominator) = factors(units);
        return Ok((numerator / denominator, UnitStatement::Caller(units)));
    }
    check_dimensions(header, labels, motion, load)?;
    let numerator_name = format!("the unit \"{}\" in record 9", header.numerator.units_label);
    let denominator_name = format!(
        "the unit \"{}\" in record 10",
        header.denominator.units_label
    );
    if let Some(units) = dataset_164 {
        let (numerator, denominator) = factors(units);
        let compared = [
            (labels.ratio, numerator / denominator, numerator_name, 9),
            (
                labels.numerator,
                numerator,
                format!("the unit \"{}\" in record 9", header.numerator.units_label),
                9,
            ),
            (labels.denominator, denominator, denominator_name, 10),
        ];
        for (label, factor, name, record) in compared {
            if let Some(unit) = label.filter(|unit| !agree(unit.to_si, factor)) {
                return Err((
                    record,
                    UffProblem::ContradictingUnits {
                        first_statement: "data set 164".to_owned(),
                        first_factor: factor,
                        second_statement: name,
                        second_factor: unit.to_si,
                    },
                ));
            }
        }
        return Ok((numerator / denominator, UnitStatement::Dataset164(units)));
    }
    let above = &header.numerator.units_label;
    let below = &header.denominator.units_label;
    Ok(match (labels.ratio, labels.numerator, labels.denominator) {
        (Some(ratio), ..) => (ratio.to_si, UnitStatement::Label(above.clone())),
        (None, None, None) => {
            numerator_is_silent(header)?;
            denominator_is_silent(header)?;
            (1.0, UnitStatement::Assumed)
        }
        (None, Some(above_unit), None) => {
            denominator_is_silent(header)?;
            (above_unit.to_si, UnitStatement::Label(above.clone()))
        }
        (None, None, Some(below_unit)) => {
            numerator_is_silent(header)?;
            // a force that is stated says nothing of the motion, whose unit matters more
            (below_unit.to_si.recip(), UnitStatement::Assumed)
        }
        (None, Some(above_unit), Some(below_unit)) => {
            let label = UnitStatement::Label(format!("{above} per {below}"));
            (above_unit.to_si / below_unit.to_si, label)
        }
    })
}

fn numerator_is_silent(header: &Header) -> Result<(), InRecord> {
    is_silent(9, &header.numerator.units_label)
}

fn denominator_is_silent(header: &Header) -> Result<(), InRecord> {
    is_silent(10, &header.denominator.units_label)
}

/// Refuses a label that says something, but not what was understood. Taken as SI it would be wrong by a factor that nobody sees.
fn is_silent(record: usize, label: &str) -> Result<(), InRecord> {
    let label = label.trim();
    if NO_UNIT.contains(&label.to_lowercase().as_str()) {
        return Ok(());
    }
    let found = crate::shown(label);
    Err((record, UffProblem::UnreadUnit { found }))
}

/// Checks that labelled units have the length dimension that the two directions give the ratio.
fn check_dimensions(
    header: &Header,
    labels: &UnitLabels,
    motion: (i32, i32),
    load: (i32, i32),
) -> Result<(), InRecord> {
    let expected = [
        (labels.ratio, motion.0 - load.0, &header.numerator, 9),
        (labels.numerator, motion.0, &header.numerator, 9),
        (labels.denominator, load.0, &header.denominator, 10),
    ];
    match expected
        .into_iter()
        .find(|(unit, length, ..)| unit.is_some_and(|unit| unit.length != *length))
    {
        None => Ok(()),
        Some((_, _, axis, record)) => Err((
            record,
            UffProblem::UnitNotOfDirections {
                statement: format!("the unit \"{}\" in record {record}", axis.units_label),
                response: header.response,
                reference: header.reference,
            },
        )),
    }
}

#[cfg(test)]
mod tests {
    use super::super::meaning::decide;
    use super::super::meaning::examples::{NO_OPTIONS, axis, decided, force, header};
    use super::*;

    #[test]
    fn units_come_from_labels_or_from_the_file_and_must_agree() {
        let millimetres = UnitSystem::new(1e3, 1.0).unwrap();
        let scale = |unit: &str, load: &str, units| {
            decided(axis(12, "", unit), axis(13, "", load), units)
                .map(|meaning| (meaning.to_si, meaning.units))
        };
        for (unit, load) in [("", ""), ("mm/s^2", "N"), ("mm/s^2/N", "")] {
            let found = scale(unit, load, Some(millimetres)).unwrap();
            assert_eq!(found, (1e-3, UnitStatement::Dataset164(millimetres)));
        }
        for (unit, load, to_si, label) in [
            ("g", "", 9.806_65, "g"),
            ("g/kN", "", 9.806_65e-3, "g/kN"),
            ("g", "kN", 9.806_65e-3, "g per kN"),
        ] {
            let found = scale(unit, load, None).unwrap();
            assert_eq!(found, (to_si, UnitStatement::Label(label.to_owned())));
        }
        for (none, load, to_si) in [("", "", 1.0), ("NONE", "", 1.0), ("-", "kN", 1e-3)] {
            let found = scale(none, load, None).unwrap();
            assert_eq!(found, (to_si, UnitStatement::Assumed));
        }
        // a volt per newton is no receptance, and a superscript that was read in another encoding is no unit
        for (unit, load, named) in [
            ("V", "", "\"V\""),
            ("(m/s≤)/N", "", "\"(m/s≤)/N\""),
            ("", "pond", "\"pond\""),
            ("nm", "N", "\"nm\""),
            ("ips", "N", "\"ips\""),
            ("mm/s^2", "stone", "\"stone\""),
        ] {
            let problem = scale(unit, load, None).unwrap_err().to_string();
            assert!(problem.contains(named), "{problem}");
            assert!(scale(unit, load, Some(millimetres)).is_ok());
        }
        for (unit, load) in [("g", ""), ("m/s^2/N", ""), ("", "kN")] {
            let problem = scale(unit, load, Some(millimetres)).unwrap_err();
            assert!(
                matches!(problem, UffProblem::ContradictingUnits { .. }),
                "{problem}"
            );
        }
        let stated = ReadOptions {
            quantity: None,
            units: Some(UnitSystem::SI),
            ..ReadOptions::default()
        };
        let meaning = decide(
            &header(axis(12, "", "g"), force()),
            Some(millimetres),
            &stated,
        )
        .unwrap();
        let caller = UnitStatement::Caller(UnitSystem::SI);
        assert_eq!((meaning.to_si, meaning.units), (1.0, caller));
    }

    #[test]
    fn rotations_and_moments_have_their_own_exponents() {
        let scale = |response: &str, reference: &str, unit: &str| {
            let mut header = header(axis(8, "", unit), force());
            header.response = response.parse().unwrap();
            header.reference = reference.parse().unwrap();
            decide(
                &header,
                Some(UnitSystem::new(1e3, 1e3).unwrap()),
                &NO_OPTIONS,
            )
            .map(|meaning| meaning.to_si)
            .map_err(|(_, problem)| problem)
        };
        let close = |found: f64, expected: f64| (found / expected - 1.0).abs() < 1e-14;
        // mm/mN = m/N; rad/mN = 1e3 rad/N; mm/(mN·mm) = 1e3 m/(N·m); rad/(mN·mm) = 1e6 rad/(N·m)
        assert!(close(scale("1:Y", "2:Y", "").unwrap(), 1.0));
        assert!(close(scale("1:RZ", "2:Y", "").unwrap(), 1e3));
        assert!(close(scale("1:Y", "2:RZ", "").unwrap(), 1e3));
        assert!(close(scale("1:RZ", "2:RZ", "").unwrap(), 1e6));
        assert!(close(scale("1:RZ", "2:Y", "rad/mN").unwrap(), 1e3));
        let problem = scale("1:RZ", "2:Y", "mm/mN").unwrap_err();
        assert!(
            matches!(problem, UffProblem::UnitNotOfDirections { .. }),
            "{problem}"
        );
    }

    #[test]
    fn scalar_points_use_the_exponents_of_their_records() {
        let mut scalar = header(axis(8, "", ""), force());
        scalar.response = "1:0".parse().unwrap();
        scalar.reference = "2:0".parse().unwrap();
        let units = UnitSystem::new(1e3, 1.0).ok();
        let to_si = |header: &Header| decide(header, units, &NO_OPTIONS).unwrap().to_si;
        assert_eq!(to_si(&scalar), 1e-3);
        scalar.denominator.length_exponent = 1;
        scalar.denominator.force_exponent = 1;
        assert_eq!(to_si(&scalar), 1.0);
    }
}
