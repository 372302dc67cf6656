//! Abaqus: a spring and a dashpot for each motion, or a connector whose elasticity and damping are whole matrices.

use std::fmt::Write as _;

use crate::head::Head;
use crate::linear::{Linear, Matrix6};
use crate::{Converted, Options};

/// Numbers on a data line.
const ON_A_LINE: usize = 8;

pub(crate) fn deck(linear: &Linear, options: &Options, mut head: Head) -> Converted {
    let [a, b] = options.nodes;
    let mut number = options.first_number;
    let mut text = String::new();
    head.note(format!("nodes {a} (side a) and {b} (side b) coincide; paste this into the part of the model that has them"));
    if linear.is_coupled() {
        head.note("the joint couples its motions, which springs cannot: a connector of type BUSHING carries K and C whole");
        let name = options.identifier.to_uppercase();
        // writing to a String cannot fail
        let _ = write!(
            text,
            "*ELEMENT, TYPE=CONN3D2, ELSET={name}\n{number}, {a}, {b}\n\
             *ORIENTATION, NAME={name}_AXES\n1., 0., 0., 0., 1., 0.\n\
             *CONNECTOR SECTION, ELSET={name}, BEHAVIOR={name}_BEHAVIOR\nBUSHING,\n{name}_AXES,\n\
             *CONNECTOR BEHAVIOR, NAME={name}_BEHAVIOR\n*CONNECTOR ELASTICITY\n{}*CONNECTOR DAMPING\n{}",
            upper_triangle(&linear.stiffness),
            upper_triangle(&linear.damping)
        );
    } else {
        for &axis in &linear.axes {
            let dof = axis + 1;
            for (element, keyword, value) in [
                ("SPRING2", "SPRING", linear.stiffness[axis][axis]),
                ("DASHPOT2", "DASHPOT", linear.damping[axis][axis]),
            ] {
                if value != 0.0 {
                    let set = format!("{}_{keyword}_{dof}", options.identifier.to_uppercase());
                    let _ = write!(
                        text,
                        "*ELEMENT, TYPE={element}, ELSET={set}\n{number}, {a}, {b}\n*{keyword}, ELSET={set}\n{dof}, {dof}\n{value:.12E}\n"
                    );
                    number += 1;
                }
            }
        }
    }
    Converted {
        text: head.comments("** ") + &text,
        notes: head.notes,
    }
}

/// D11, D12, D22, D13, D23, D33, …: the upper triangle column by column.
fn upper_triangle(matrix: &Matrix6) -> String {
    let entries: Vec<String> = (0..6)
        .flat_map(|column| (0..=column).map(move |row| (row, column)))
        .map(|(row, column)| format!("{:.12E}", matrix[row][column]))
        .collect();
    let lines = entries.chunks(ON_A_LINE);
    lines.map(|line| format!("{}\n", line.join(", "))).collect()
}
