//! Which number of the joint file each parameter of an FMU starts with.

use bolted_joint_dynamics::{
    DOFS,
    law::{DECLARATIONS, Term},
};
use bolted_joint_interface::{At, Filling, LawParameter, law_parameters};

use bolted_joint_joint::{Body, Joint, JointFile};

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
            // y has one row in a plane and one in space
            let mut named = parameters.iter().filter(|parameter| parameter.name == name);
            named
                .find_map(|parameter| of_law(joint, parameter))
                .or_else(|| of_bodies(file, name))
        }
    }
}

fn of_law(joint: &Joint, parameter: &LawParameter) -> Option<f64> {
    let place = |row: usize| joint.dofs.indices().iter().position(|&own| own == row);
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
            if let Some(term) = Term::named(parameter.symbol) {
                return match joint.term(term) {
                    [] => Some(0.0),
                    list => list.get(place(row)?).copied(),
                };
            }
            let law = DECLARATIONS.get(parameter.law)?;
            match joint.friction_on(DOFS.get(row)?, law) {
                Some(own) => own.value(law.parameters.get(parameter.parameter)?),
                None => Some(0.0),
            }
        }
    }
}

fn of_bodies(file: &JointFile, name: &str) -> Option<f64> {
    let (side, quantity) = name.split_once('.')?;
    let bodies = file.bodies.as_ref()?;
    let body = match side {
        "a" => &bodies.a,
        "b" => &bodies.b,
        _ => return None,
    };
    let mut rows = file.joint.dofs.indices().iter().enumerate();
    rows.find_map(|(place, &row)| of_body(body, quantity, place, row))
}

/// The body's number on the DOF of a row, at its place among the joint's DOFs, if that is what `quantity` names.
fn of_body(body: &Body, quantity: &str, place: usize, row: usize) -> Option<f64> {
    let dof = &DOFS[row];
    let list = match quantity.split_once('_') {
        _ if quantity == dof.inertia => &body.inertia,
        Some(("k", name)) if name == dof.name => &body.stiffness,
        Some(("c", name)) if name == dof.name => &body.damping,
        _ => return None,
    };
    list.get(place).copied()
}
