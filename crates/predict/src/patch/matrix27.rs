//! The interface for ANSYS: an APDL macro that makes two MATRIX27 elements, stiffness and damping, between two nodes.

use std::fmt::Write as _;

use super::interface::{InterfaceJoint, Matrix6};
use crate::NumberError;

/// Real constants on a line of `R` and of `RMORE`.
const ON_A_LINE: usize = 6;

/// The macro. Its arguments are the node on side a, the node on side b, both at the reference point with nodal axes along x, y
/// and z of the interface, and a number from which two element types and two sets of real constants are free.
///
/// The element relates UX, UY, UZ, ROTX, ROTY, ROTZ of two nodes; its matrix [[M, −M], [−M, M]] is given by the 78 constants of the
/// upper triangle, row by row, C1 … C12 being the first row (KEYOPT(2) = 0). KEYOPT(3) = 4 is a stiffness, 5 a viscous damping:
/// all damping at the frequency (Hz).
///
/// # Errors
/// The frequency is not positive.
pub fn matrix27(
    name: &str,
    interface: &InterfaceJoint,
    frequency_hz: f64,
) -> Result<String, NumberError> {
    let damping = interface.viscous_at(frequency_hz)?;
    let [x, y, z] = interface.reference_m;
    // A comment ends with its line, and APDL has `$` between commands.
    let name = name.replace(['\n', '\r', '$'], " ");
    let mut text = format!(
        "! {name}\n! ARG1 node on side a, ARG2 node on side b, both at x = {x}, y = {y}, z = {z} m\n\
         ! ARG3 first of two free numbers of element types and of sets of real constants\n\
         ! N, m, rad, s; z normal to the interface; damping converted to viscous at {frequency_hz} Hz\n"
    );
    for (what, keyopt, number, matrix) in [
        ("stiffness", 4, "ARG3", &interface.stiffness),
        ("damping", 5, "ARG3+1", &damping),
    ] {
        // writing to a String cannot fail
        let _ = write!(
            text,
            "! {what}\nET,{number},MATRIX27\nKEYOPT,{number},2,0\nKEYOPT,{number},3,{keyopt}\n{}TYPE,{number}\nREAL,{number}\nE,ARG1,ARG2\n",
            constants(number, matrix)
        );
    }
    Ok(text)
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
