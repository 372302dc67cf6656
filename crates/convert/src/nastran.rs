//! Nastran: CBUSH with PBUSH, or the whole matrices as DMIG, since a CBUSH has no coupling between its motions.

use std::fmt::Write as _;

use crate::head::Head;
use crate::linear::{Linear, Matrix6};
use crate::{Converted, Options};

/// A number in a field of 16 characters.
fn field(value: f64) -> String {
    format!("{value:>16.9E}")
}

/// Fields of 16 characters, four on a line, after the card's name.
fn card(name: &str, fields: &[String]) -> String {
    let lines = fields.chunks(4).enumerate().map(|(line, fields)| {
        let begin = if line == 0 {
            format!("{name}*")
        } else {
            "*".to_owned()
        };
        let fields: String = fields.iter().map(|own| format!("{own:>16}")).collect();
        format!("{begin:<8}{fields}\n").trim_end().to_owned() + "\n"
    });
    lines.collect()
}

pub(crate) fn deck(linear: &Linear, options: &Options, mut head: Head) -> Converted {
    let [a, b] = options.nodes;
    let number = options.first_number;
    let mut cards = String::new();
    if linear.is_coupled() {
        head.note(format!(
            "the joint couples its motions, which CBUSH cannot: K and C are whole in DMIG entries; put K2GG = KBJ{number} and B2GG = \
             CBJ{number} into the case control, or there is no joint"
        ));
        let _ = write!(
            cards,
            "{}{}",
            matrix(&format!("KBJ{number}"), &linear.stiffness, [a, b]),
            matrix(&format!("CBJ{number}"), &linear.damping, [a, b])
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
    Converted {
        text: head.comments("$ ") + &cards,
        notes: head.notes,
    }
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
                    field(signed),
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
    use super::*;

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
