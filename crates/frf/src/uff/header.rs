//! The eleven header records of data set 58: which function this is, between what, and how its values are stored.

use std::ops::RangeInclusive;

use super::UffProblem;
use super::degree_of_freedom::dof;
use super::fields::{columns, split_blanks, split_columns};
use super::numbers::parse_number;
use crate::Dof;

/// Header records before the values.
pub(super) const RECORDS: usize = 11;

/// No quantity has a length or a force to a higher power.
const UNIT_EXPONENTS: RangeInclusive<i32> = -9..=9;

/// A problem and the record (1 to 11) in which it is.
pub(super) type InRecord = (usize, UffProblem);

/// How the values are stored (record 7).
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Layout {
    pub(super) complex: bool,
    pub(super) double: bool,
    /// First frequency and increment, if the abscissa is even and not stored.
    pub(super) even: Option<(f64, f64)>,
    /// Lines of the function.
    pub(super) lines: usize,
}

impl Layout {
    /// Numbers stored for one line of the function.
    pub(super) fn numbers_per_line(self) -> usize {
        1 + usize::from(self.complex) + usize::from(self.even.is_none())
    }

    /// Widths of the fields in one text line of values.
    pub(super) fn widths(self) -> &'static [usize] {
        match (self.double, self.even.is_some(), self.complex) {
            (false, ..) => &[13, 13, 13, 13, 13, 13],
            (true, true, _) => &[20, 20, 20, 20],
            (true, false, false) => &[13, 20, 13, 20],
            (true, false, true) => &[13, 20, 20],
        }
    }
}

/// What one axis carries (records 8 to 11).
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Axis {
    /// The standard's code of the specific data type.
    pub(super) data_type: i64,
    pub(super) length_exponent: i32,
    pub(super) force_exponent: i32,
    /// Empty if not used.
    pub(super) label: String,
    /// Empty if not used.
    pub(super) units_label: String,
}

/// The header of one function.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Header {
    pub(super) response: Dof,
    pub(super) reference: Dof,
    pub(super) layout: Layout,
    pub(super) abscissa: Axis,
    pub(super) numerator: Axis,
    pub(super) denominator: Axis,
}

/// The function type, from record 6.
pub(super) fn function_type(records: &[String; RECORDS]) -> Result<i64, InRecord> {
    integer(
        &record_6(&records[5])[0],
        6,
        "the function type",
        "a whole number such as 4",
    )
}

impl Header {
    pub(super) fn from_records(records: &[String; RECORDS]) -> Result<Self, InRecord> {
        let [
            _,
            _,
            _,
            _,
            response_name,
            response_node,
            response_direction,
            reference_name,
            reference_node,
            reference_direction,
        ] = record_6(&records[5]);
        Ok(Self {
            response: dof(
                "response",
                &response_name,
                &response_node,
                &response_direction,
            )?,
            reference: dof(
                "reference",
                &reference_name,
                &reference_node,
                &reference_direction,
            )?,
            layout: layout(&records[6])?,
            abscissa: axis(&records[7], 8)?,
            numerator: axis(&records[8], 9)?,
            denominator: axis(&records[9], 10)?,
        })
    }
}

fn record_6(line: &str) -> [String; 10] {
    // 2(I5,I10),2(1X,10A1,I10,I4)
    let is_integer = |text: &String| text.parse::<i64>().is_ok();
    split_blanks::<10>(line)
        .filter(|fields| {
            [0, 1, 2, 3, 5, 6, 8, 9]
                .iter()
                .all(|&index| is_integer(&fields[index]))
        })
        .unwrap_or_else(|| split_columns(line, [5, 10, 5, 10, 11, 10, 4, 11, 10, 4]))
}

fn layout(line: &str) -> Result<Layout, InRecord> {
    // 3I10,3E13.5
    let [ordinate, lines, spacing, minimum, increment, _] =
        split_blanks(line).unwrap_or_else(|| split_columns(line, [10, 10, 10, 13, 13, 13]));
    let expected_type =
        "2 or 4 (real, single or double precision), 5 or 6 (complex, single or double precision)";
    let (complex, double) = match integer(&ordinate, 7, "the ordinate data type", expected_type)? {
        2 => (false, false),
        4 => (false, true),
        5 => (true, false),
        6 => (true, true),
        _ => return Err(field(7, "the ordinate data type", &ordinate, expected_type)),
    };
    let lines = integer(
        &lines,
        7,
        "the number of values",
        "a whole number that is not negative",
    )?;
    let expected_spacing = "0 (uneven) or 1 (even)";
    let even = match integer(&spacing, 7, "the abscissa spacing", expected_spacing)? {
        0 => None,
        1 => Some((
            real(&minimum, "the abscissa minimum")?,
            real(&increment, "the abscissa increment")?,
        )),
        _ => return Err(field(7, "the abscissa spacing", &spacing, expected_spacing)),
    };
    Ok(Layout {
        complex,
        double,
        even,
        lines,
    })
}

fn axis(line: &str, record: usize) -> Result<Axis, InRecord> {
    // I10,3I5,2(1X,20A1)
    let by_column = split_columns(line, [10, 5, 5, 5]);
    let in_columns = by_column
        .iter()
        .all(|text| text.is_empty() || text.parse::<i32>().is_ok());
    let [data_type, length, force, _] = match in_columns {
        true => by_column.map(|text| {
            if text.is_empty() {
                "0".to_owned()
            } else {
                text
            }
        }),
        false => {
            let mut fields = line.split_whitespace().map(str::to_owned);
            [(); 4].map(|()| fields.next().unwrap_or_default())
        }
    };
    let label = |from, to| match in_columns {
        true => Some(columns(line, from, to))
            .filter(|text| text != "NONE")
            .unwrap_or_default(),
        false => String::new(),
    };
    let expected = "a whole number";
    let exponent = |text: &str, name| -> Result<i32, InRecord> {
        let exponent = integer(text, record, name, expected)?;
        match UNIT_EXPONENTS.contains(&exponent) {
            true => Ok(exponent),
            false => Err(field(record, name, text, "a whole number from -9 to 9")),
        }
    };
    Ok(Axis {
        data_type: integer(&data_type, record, "the specific data type", expected)?,
        length_exponent: exponent(&length, "the length units exponent")?,
        force_exponent: exponent(&force, "the force units exponent")?,
        label: label(25, 46),
        units_label: label(46, 80),
    })
}

pub(super) fn integer<T: std::str::FromStr>(
    text: &str,
    record: usize,
    name: &'static str,
    expected: &'static str,
) -> Result<T, InRecord> {
    text.parse()
        .map_err(|_| field(record, name, text, expected))
}

fn real(text: &str, name: &'static str) -> Result<f64, InRecord> {
    let expected = "a finite number such as 1.25000E-01";
    parse_number(text)
        .filter(|number| number.is_finite())
        .ok_or_else(|| field(7, name, text, expected))
}

fn field(record: usize, name: &'static str, found: &str, expected: &'static str) -> InRecord {
    let found = found.to_owned();
    (
        record,
        UffProblem::Field {
            record,
            field: name,
            found,
            expected,
        },
    )
}

#[cfg(test)]
mod tests {
    use super::super::function_type::FREQUENCY_RESPONSE;
    use super::*;

    fn records() -> [String; RECORDS] {
        [
            "NONE",
            "NONE",
            "NONE",
            "NONE",
            "NONE",
            "    4         1    1         0 NONE              11  -2 NONE               2   6",
            "         6       801         1  5.00000E+00  2.50000D-01  0.00000E+00",
            "        18    0    0    0 Frequency            Hz",
            "        12    1    0    0 Acceleration         m/s^2",
            "        13    0    1    0 NONE                 NONE",
            "         0    0    0    0 NONE                 NONE",
        ]
        .map(str::to_owned)
    }

    #[test]
    fn every_field_is_where_the_standard_puts_it() {
        let header = Header::from_records(&records()).unwrap();
        assert_eq!(function_type(&records()).unwrap(), FREQUENCY_RESPONSE);
        assert_eq!(header.response.to_string(), "11:-Y");
        assert_eq!(header.reference.to_string(), "2:+RZ");
        assert_eq!(
            header.layout,
            Layout {
                complex: true,
                double: true,
                even: Some((5.0, 0.25)),
                lines: 801
            }
        );
        assert_eq!(
            (
                header.abscissa.data_type,
                header.abscissa.units_label.as_str()
            ),
            (18, "Hz")
        );
        assert_eq!(header.numerator.label, "Acceleration");
        assert_eq!(
            (
                header.numerator.length_exponent,
                header.denominator.force_exponent
            ),
            (1, 1)
        );
        assert_eq!(
            (
                header.denominator.data_type,
                header.denominator.label.as_str()
            ),
            (13, "")
        );
    }

    #[test]
    fn names_with_blanks_are_read_by_column_and_loose_columns_by_blanks() {
        let mut records = records();
        let (name, none) = ("left plate", "");
        records[5] = format!(
            "    4         1    1         0 {name:<10}        11  -2 {none:<10}         2   6"
        );
        assert_eq!(
            Header::from_records(&records)
                .unwrap()
                .reference
                .to_string(),
            "2:+RZ"
        );
        records[5] = "4 1 1 0 NONE 11 -2 NONE 2 6".to_owned();
        records[6] = "6 801 0 0.0 0.0 0.0".to_owned();
        records[8] = "12 1 0 0 NONE NONE".to_owned();
        let header = Header::from_records(&records).unwrap();
        assert_eq!(
            (header.response.node(), header.numerator.data_type),
            (11, 12)
        );
        assert_eq!(header.layout.even, None);
        assert_eq!(header.layout.widths(), [13, 20, 20]);
        assert_eq!(header.layout.numbers_per_line(), 3);
    }

    #[test]
    fn a_field_that_cannot_be_read_is_named_with_its_record() {
        for (index, from, to, named) in [
            (5, "11  -2", "1x  -2", "response node"),
            (5, "11  -2", "11  -7", "direction code -7"),
            (5, "               2   6", "", "reference node"),
            (6, "         6", "         3", "ordinate data type"),
            (6, "       801", "       -80", "number of values"),
            (6, "         1  5", "         2  5", "abscissa spacing"),
            (6, "2.50000D-01", "        NaN", "abscissa increment"),
        ] {
            let mut records = records();
            assert!(records[index].contains(from), "{from}");
            records[index] = records[index].replace(from, to);
            refused(&records, index, named);
        }
        for (index, line, named) in [
            (6, "", "ordinate data type"),
            (8, "acceleration", "specific data type"),
            (
                8,
                "8 -2147483648 0 0 NONE NONE",
                "as the length units exponent, expected a whole number from -9 to 9",
            ),
        ] {
            let mut records = records();
            records[index] = line.to_owned();
            refused(&records, index, named);
        }
    }

    fn refused(records: &[String; RECORDS], index: usize, named: &str) {
        let (record, problem) = Header::from_records(records).unwrap_err();
        assert_eq!(record, index + 1);
        assert!(problem.to_string().contains(named), "{problem}");
    }
}
