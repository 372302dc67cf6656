//! Nastran: CBUSH with PBUSH, or the whole matrices as DMIG, since a CBUSH has no coupling between its motions.
//!
//! A matrix in double precision has `D` for the exponents of its values, and a name of up to eight characters (Quick Reference
//! Guide, DMIG, field NAME and remark 8).

use std::fmt::Write as _;

use crate::head::Head;
use crate::linear::{Linear, Matrix6};
use crate::{ConvertError, Converted, Options};

/// Characters of a wide field.
const WIDTH: usize = 16;
/// Digits behind the point, where the exponent leaves room for them.
const DIGITS: usize = 9;
/// Largest number that stands behind KBJ and CBJ in the name of a matrix.
const LARGEST_BEHIND_THREE_LETTERS: u32 = 99_999;
/// First number that stands behind K and C, and the largest one.
const FIRST_BEHIND_ONE_LETTER: u32 = LARGEST_BEHIND_THREE_LETTERS + 1;
const LARGEST_BEHIND_ONE_LETTER: u32 = 9_999_999;

/// A number in single precision.
fn field(value: f64) -> String {
    let texts = (0..=DIGITS)
        .rev()
        .map(|digits| format!("{value:.digits$E}"));
    let shortest = || format!("{value:E}");
    texts
        .into_iter()
        .find(|text| text.len() <= WIDTH)
        .unwrap_or_else(shortest)
}

/// A number in double precision.
fn double(value: f64) -> String {
    field(value).replace('E', "D")
}

/// Names of the matrices of stiffness and damping.
fn matrix_names(number: u32) -> Result<[String; 2], ConvertError> {
    let named = |prefixes: [&str; 2]| Ok(prefixes.map(|prefix| format!("{prefix}{number}")));
    match number {
        0..=LARGEST_BEHIND_THREE_LETTERS => named(["KBJ", "CBJ"]),
        FIRST_BEHIND_ONE_LETTER..=LARGEST_BEHIND_ONE_LETTER => named(["K", "C"]),
        _ => Err(ConvertError::Numbers {
            key: "--first-number",
            found: number.to_string(),
            expected: format!(
                "up to {LARGEST_BEHIND_ONE_LETTER} for a joint that couples its motions: its matrices are named after it, and \
                 Nastran's names have up to 8 characters"
            ),
        }),
    }
}

/// Fields of 16 characters, four on a line, after the card's name.
fn card(name: &str, fields: &[String]) -> String {
    let lines = fields.chunks(4).enumerate().map(|(line, fields)| {
        let begin = if line == 0 {
            format!("{name}*")
        } else {
            "*".to_owned()
        };
        let fields: String = fields.iter().map(|own| format!("{own:>WIDTH$}")).collect();
        format!("{begin:<8}{fields}\n").trim_end().to_owned() + "\n"
    });
    lines.collect()
}

pub(crate) fn deck(
    linear: &Linear,
    options: &Options,
    mut head: Head,
) -> Result<Converted, ConvertError> {
    let [a, b] = options.nodes;
    let number = options.first_number;
    let mut cards = String::new();
    if linear.is_coupled() {
        let [stiffness, damping] = matrix_names(number)?;
        head.note(format!(
            "the joint couples its motions, which CBUSH cannot: K and C are whole in DMIG entries; put K2GG = {stiffness} and B2GG = \
             {damping} into the case control, or there is no joint"
        ));
        let _ = write!(
            cards,
            "{}{}",
            matrix(&stiffness, &linear.stiffness, [a, b]),
            matrix(&damping, &linear.damping, [a, b])
        );
    } else {
        let entries = |name: &str, matrix: &Matrix6| {
            let values = (0..6).map(|i| match matrix[i][i] {
                0.0 => String::new(),
                value => field(value),
            });
            [name.to_owned()]
                .into_iter()
                .chain(values)
                .collect::<Vec<_>>()
        };
        let mut fields = vec![number.to_string()];
        fields.extend(entries("K", &linear.stiffness));
        fields.push(String::new());
        fields.extend(entries("B", &linear.damping));
        let _ = write!(
            cards,
            "CBUSH,{number},{number},{a},{b},,,,0\n{}",
            card("PBUSH", &fields)
        );
    }
    head.note(format!("grid points {a} (side a) and {b} (side b) coincide; their displacements are along the basic axes"));
    Ok(Converted {
        text: head.comments("$ ") + &cards,
        notes: head.notes,
    })
}

/// [[M, −M], [−M, M]] over both nodes: its upper triangle by columns, as a real symmetric matrix in double precision.
fn matrix(name: &str, own: &Matrix6, nodes: [u32; 2]) -> String {
    let at = |place: usize| (nodes[place / 6], place % 6 + 1);
    let mut text = format!("DMIG,{name},0,6,2,0\n");
    for column in 0..12 {
        let (node, component) = at(column);
        let rows = (0..=column).filter_map(|row| {
            let value = own[row % 6][column % 6];
            let signed = if (row < 6) == (column < 6) {
                value
            } else {
                -value
            };
            (value != 0.0).then(|| {
                let (node, component) = at(row);
                [
                    node.to_string(),
                    component.to_string(),
                    double(signed),
                    String::new(),
                ]
            })
        });
        let rows: Vec<[String; 4]> = rows.collect();
        if !rows.is_empty() {
            let mut fields = vec![
                name.to_owned(),
                node.to_string(),
                component.to_string(),
                String::new(),
            ];
            fields.extend(rows.concat());
            text += &card("DMIG", &fields);
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use bolted_joint_joint::JointFile;

    use super::*;
    use crate::tests::{PLANAR, options};
    use crate::{Target, convert};

    fn planar(first_number: u32) -> Result<Converted, ConvertError> {
        let options = Options {
            first_number,
            ..options(false)
        };
        let file = JointFile::from_json(PLANAR, "j").unwrap();
        convert(&file, Target::Nastran, &options)
    }

    /// Quick Reference Guide, DMIG: NAME has 1 to 8 characters, TIN = 2 is real in double precision, whose values have D.
    #[test]
    fn matrices_in_double_precision_have_its_exponents() {
        let text = planar(500).unwrap().text;
        let types: Vec<&str> = text
            .lines()
            .filter_map(|line| line.strip_prefix("DMIG,")?.split(',').nth(3))
            .collect();
        assert_eq!(types, ["2", "2"]);
        let fields = text
            .lines()
            .filter(|line| line.starts_with('*') || line.starts_with("DMIG*"));
        let values: Vec<&str> = fields
            .flat_map(|line| line.as_bytes()[8..].chunks(16))
            .map(|own| std::str::from_utf8(own).unwrap().trim())
            .filter(|own| own.contains('.'))
            .collect();
        // the upper triangle of [[M, −M], [−M, M]] of two motions that are coupled, for K and C
        assert_eq!(values.len(), 2 * 10);
        assert!(
            values
                .iter()
                .all(|own| own.contains('D') && !own.contains('E')),
            "{values:?}"
        );
        assert!(values.contains(&"5.730000000D5"), "{values:?}");
    }

    #[test]
    fn names_of_matrices_have_up_to_eight_characters() {
        for number in [1, 1001, 99_999, 100_000, 9_999_999] {
            let text = planar(number).unwrap().text;
            let names: Vec<&str> = text
                .lines()
                .filter_map(|line| line.strip_prefix("DMIG,")?.split(',').next())
                .collect();
            assert_eq!(names.len(), 2, "{number}");
            assert_ne!(names[0], names[1], "{number}");
            for name in names {
                assert!(
                    name.len() <= 8 && name.ends_with(&number.to_string()),
                    "{name}"
                );
            }
        }
        let refused = planar(10_000_000).unwrap_err().to_string();
        assert!(
            refused.contains("--first-number: found 10000000, expected up to 9999999"),
            "{refused}"
        );
    }

    #[test]
    fn numbers_stay_in_their_fields() {
        for (value, expected) in [
            (-1.5e-10, "-1.500000000E-10"),
            (-1.5e-100, "-1.50000000E-100"),
            (1.0 / 3.0, "3.333333333E-1"),
        ] {
            assert_eq!(field(value), expected);
        }
    }

    #[test]
    fn cards_keep_their_columns() {
        let text = card(
            "PBUSH",
            &[
                "7".to_owned(),
                "K".to_owned(),
                field(1.5e6),
                String::new(),
                field(-2.0),
            ],
        );
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(&lines[0][..8], "PBUSH*  ");
        assert_eq!(lines[0][8..24].trim(), "7");
        assert_eq!(lines[0][40..56].trim(), "1.500000000E6");
        assert_eq!(
            (&lines[1][..8], lines[1][8..24].trim()),
            ("*       ", "-2.000000000E0")
        );
    }
}
