//! ANSYS: COMBIN14 for each motion, or MATRIX27 for the whole matrices.

use std::fmt::Write as _;

use crate::head::Head;
use crate::linear::{Linear, Matrix6};
use crate::{Converted, Options};

/// Real constants on a line of `R` and of `RMORE`.
const ON_A_LINE: usize = 6;

pub(crate) fn commands(linear: &Linear, options: &Options, mut head: Head) -> Converted {
    let [a, b] = options.nodes;
    let first = options.first_number;
    head.note(format!(
        "in /PREP7; nodes {a} (side a) and {b} (side b) coincide, with nodal axes along x, y, z; element types and sets of real constants \
         from {first} on are taken"
    ));
    let elements = match linear.is_coupled() {
        true => {
            head.note("the joint couples its motions, which COMBIN14 cannot: MATRIX27 carries K and C whole");
            matrix27_pair(
                [&first.to_string(), &(first + 1).to_string()],
                [&a.to_string(), &b.to_string()],
                &linear.stiffness,
                &linear.damping,
            )
        }
        false => combin14(linear, options),
    };
    Converted {
        text: head.comments("! ") + &elements,
        notes: head.notes,
    }
}

/// KEYOPT(2) = 1 … 6: a spring and a damper along UX … about ROTZ.
fn combin14(linear: &Linear, options: &Options) -> String {
    let [a, b] = options.nodes;
    let mut text = String::new();
    for (number, &axis) in (options.first_number..).zip(&linear.axes) {
        let (stiffness, damping) = (linear.stiffness[axis][axis], linear.damping[axis][axis]);
        // writing to a String cannot fail
        let _ = write!(
            text,
            "ET,{number},COMBIN14\nKEYOPT,{number},2,{}\nR,{number},{stiffness:.12E},{damping:.12E}\nTYPE,{number}\nREAL,{number}\nE,{a},{b}\n",
            axis + 1
        );
    }
    text
}

/// Commands for two MATRIX27 elements, stiffness and viscous damping, between two nodes.
///
/// `numbers` are those of the element types and sets of real constants, `nodes` those on sides a and b: numbers or parameters of
/// APDL. The element relates UX, UY, UZ, ROTX, ROTY, ROTZ of two nodes; its matrix [[M, −M], [−M, M]] is given by the 78 constants of
/// the upper triangle, row by row, C1 … C12 being the first row (KEYOPT(2) = 0). KEYOPT(3) = 4 is a stiffness, 5 a viscous damping.
#[must_use]
pub fn matrix27_pair(
    numbers: [&str; 2],
    nodes: [&str; 2],
    stiffness: &Matrix6,
    damping: &Matrix6,
) -> String {
    let mut text = String::new();
    let [a, b] = nodes;
    for ((what, keyopt, matrix), number) in [("stiffness", 4, stiffness), ("damping", 5, damping)]
        .into_iter()
        .zip(numbers)
    {
        // writing to a String cannot fail
        let _ = write!(
            text,
            "! {what}\nET,{number},MATRIX27\nKEYOPT,{number},2,0\nKEYOPT,{number},3,{keyopt}\n{}TYPE,{number}\nREAL,{number}\nE,{a},{b}\n",
            constants(number, matrix)
        );
    }
    text
}

/// `R` and `RMORE` with the upper triangle of the 12×12 matrix.
fn constants(number: &str, matrix: &Matrix6) -> String {
    let entries = upper_triangle(matrix);
    let lines = entries.chunks(ON_A_LINE).enumerate();
    let lines = lines.map(|(line, entries)| {
        let entries = entries.iter().map(|value| format!("{value:.12E}"));
        let entries: Vec<String> = entries.collect();
        let command = match line {
            0 => format!("R,{number}"),
            _ => "RMORE".to_owned(),
        };
        format!("{command},{}\n", entries.join(","))
    });
    lines.collect()
}

/// Of [[M, −M], [−M, M]], row by row.
fn upper_triangle(matrix: &Matrix6) -> Vec<f64> {
    let entry = |i: usize, j: usize| {
        let value = matrix[i % 6][j % 6];
        // + 0.0 makes −0 a plain zero
        if (i < 6) == (j < 6) {
            value
        } else {
            0.0 - value
        }
    };
    let row = |i: usize| (i..12).map(move |j| entry(i, j));
    (0..12).flat_map(row).collect()
}

#[cfg(test)]
mod tests {
    use super::upper_triangle;

    #[test]
    fn the_constants_of_a_spring_are_where_the_element_reference_has_them() {
        let mut spring = [[0.0; 6]; 6];
        spring[0][0] = 3.0;
        let constants = upper_triangle(&spring);
        assert_eq!(constants.len(), 78);
        let named: Vec<(usize, f64)> = (1..)
            .zip(constants)
            .filter(|(_, value)| *value != 0.0)
            .collect();
        // ANSYS Element Reference, MATRIX27: a spring K along x is C1 = C58 = K and C7 = −K
        assert_eq!(named, [(1, 3.0), (7, -3.0), (58, 3.0)]);
    }
}
