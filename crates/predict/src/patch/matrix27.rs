//! The interface for ANSYS: an APDL macro that makes two MATRIX27 elements, stiffness and damping, between two nodes.

use bolted_joint_convert::matrix27_pair;

use super::interface::InterfaceJoint;
use crate::NumberError;

/// The macro. Its arguments are the node on side a, the node on side b, both at the reference point with nodal axes along x, y
/// and z of the interface, and a number from which two element types and two sets of real constants are free.
/// All damping is viscous, as it is at the frequency (Hz).
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
    text += &matrix27_pair(
        ["ARG3", "ARG3+1"],
        ["ARG1", "ARG2"],
        &interface.stiffness,
        &damping,
    );
    Ok(text)
}
