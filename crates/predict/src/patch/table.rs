//! The matrices of an interface as a table (CSV) that spreadsheets and scripts read.

use std::fmt::Write as _;

use super::interface::{DOFS, InterfaceJoint, Matrix6};
use crate::NumberError;

/// The text: a row for each matrix and DOF. K is the stiffness, D the hysteretic damping, C the viscous one, and `C_total` all of
/// it as a dashpot at the frequency (Hz).
///
/// # Errors
/// The frequency is not positive.
pub fn table(
    name: &str,
    interface: &InterfaceJoint,
    frequency_hz: f64,
) -> Result<String, NumberError> {
    let total = interface.viscous_at(frequency_hz)?;
    let [x, y, z] = interface.reference_m;
    let name = name.replace(['\n', '\r'], " ");
    let mut text = format!(
        "# {name}\n# relative motion of two nodes at x = {x} m, y = {y} m, z = {z} m; interface normal z; N, m, rad, s\n\
         # K stiffness, D hysteretic damping, C viscous damping, C_total all damping as viscous at {frequency_hz} Hz\n\
         matrix,row,{}\n",
        DOFS.join(",")
    );
    let mut append = |symbol: &str, matrix: &Matrix6| {
        for (dof, row) in DOFS.iter().zip(matrix) {
            let values = row.map(|value| format!("{value:e}"));
            // writing to a String cannot fail
            let _ = writeln!(text, "{symbol},{dof},{}", values.join(","));
        }
    };
    append("K", &interface.stiffness);
    append("D", &interface.hysteretic);
    append("C", &interface.viscous);
    append("C_total", &total);
    Ok(text)
}
