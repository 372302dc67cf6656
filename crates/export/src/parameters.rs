//! Which number of the joint file each parameter of an FMU starts with.

use bolted_joint_dynamics::DOFS;
use bolted_joint_interface::{At, Filling, LawParameter, law_parameters};

use bolted_joint_joint::{Body, DofSet, HigherTerms, Joint, JointFile};

/// Start value of the parameter `name`, or of the preload, or `None` where the joint file has no such number.
///
/// A law's parameter that the file leaves out is zero.
pub fn start_value(file: &JointFile, longest_step_s: Option<f64>, name: &str) -> Option<f64> {
    let joint = &file.joint;
    match name {
        "step_size_max" => longest_step_s,
        "preload" => joint.over_preload.as_ref().map(|table| table.nominal),
        _ => {
            let parameters = law_parameters(&Filling::PRESENT);
            match parameters.iter().find(|parameter| parameter.name == name) {
                Some(parameter) => of_law(joint, parameter),
                None => of_bodies(file, name),
            }
        }
    }
}

fn of_law(joint: &Joint, parameter: &LawParameter) -> Option<f64> {
    let place = |row| place(joint.dofs, row);
    match parameter.at {
        At::Pair(one, other) => {
            let matrix = match parameter.key {
                "stiffness" => &joint.stiffness,
                "damping" => &joint.damping,
                _ => return None,
            };
            matrix.get(place(one)?)?.get(place(other)?).copied()
        }
        At::Dof(row) => {
            let list = list(joint, parameter.key)?;
            if list.is_empty() {
                Some(0.0)
            } else {
                list.get(place(row)?).copied()
            }
        }
    }
}

/// The list of the joint file with this key; empty where it is left out.
fn list<'j>(joint: &'j Joint, key: &str) -> Option<&'j [f64]> {
    let higher = |list: fn(&HigherTerms) -> &[f64]| joint.higher.as_ref().map_or(&[][..], list);
    Some(match key {
        "cubic" => &joint.cubic,
        "quintic" => higher(|terms| &terms.quintic),
        "septic" => higher(|terms| &terms.septic),
        "damping_quadratic" => higher(|terms| &terms.damping_quadratic),
        "damping_quartic" => higher(|terms| &terms.damping_quartic),
        _ => return None,
    })
}

/// Place of a row of the table of DOFs among the joint's DOFs.
fn place(dofs: DofSet, row: usize) -> Option<usize> {
    dofs.rows().iter().position(|&of_joint| of_joint == row)
}

fn of_bodies(file: &JointFile, name: &str) -> Option<f64> {
    let (side, quantity) = name.split_once('.')?;
    let bodies = file.bodies.as_ref()?;
    let body = match side {
        "a" => &bodies.a,
        "b" => &bodies.b,
        _ => return None,
    };
    let mut rows = file.joint.dofs.rows().iter().enumerate();
    rows.find_map(|(place, &row)| of_body(body, quantity, place, row))
}

/// The body's number on the DOF of a row, at its place among the joint's DOFs, if that is what `quantity` names.
fn of_body(body: &Body, quantity: &str, place: usize, row: usize) -> Option<f64> {
    let dof = &DOFS[row];
    let list = match quantity.split_once('_') {
        None if quantity == dof.inertia => &body.inertia,
        Some(("k", name)) if name == dof.name => &body.stiffness,
        Some(("c", name)) if name == dof.name => &body.damping,
        _ => return None,
    };
    list.get(place).copied()
}
