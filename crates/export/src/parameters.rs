//! Which number of the joint file each parameter of an FMU starts with.

use bolted_joint_joint::{Body, HigherTerms, JointFile};

/// Start value of the parameter `name`, or of the preload, or `None` where the joint file has no such number.
///
/// A cubic stiffness or a term of higher order that the file leaves out is zero.
pub fn start_value(file: &JointFile, longest_step_s: Option<f64>, name: &str) -> Option<f64> {
    let joint = &file.joint;
    let entry = |matrix: &[Vec<f64>], i: usize, j: usize| matrix.get(i)?.get(j).copied();
    let or_zero = |list: &[f64], i: usize| {
        if list.is_empty() {
            Some(0.0)
        } else {
            list.get(i).copied()
        }
    };
    let higher = |terms: fn(&HigherTerms) -> &[f64], i: usize| {
        or_zero(joint.higher.as_ref().map_or(&[], terms), i)
    };
    match name {
        "joint.k_yy" => entry(&joint.stiffness, 0, 0),
        "joint.k_ytheta" => entry(&joint.stiffness, 0, 1),
        "joint.k_thetatheta" => entry(&joint.stiffness, 1, 1),
        "joint.c_yy" => entry(&joint.damping, 0, 0),
        "joint.c_ytheta" => entry(&joint.damping, 0, 1),
        "joint.c_thetatheta" => entry(&joint.damping, 1, 1),
        "joint.k3_y" => or_zero(&joint.cubic, 0),
        "joint.k3_theta" => or_zero(&joint.cubic, 1),
        "joint.k5_y" => higher(|terms| &terms.quintic, 0),
        "joint.k5_theta" => higher(|terms| &terms.quintic, 1),
        "joint.k7_y" => higher(|terms| &terms.septic, 0),
        "joint.k7_theta" => higher(|terms| &terms.septic, 1),
        "joint.c2_y" => higher(|terms| &terms.damping_quadratic, 0),
        "joint.c2_theta" => higher(|terms| &terms.damping_quadratic, 1),
        "joint.c4_y" => higher(|terms| &terms.damping_quartic, 0),
        "joint.c4_theta" => higher(|terms| &terms.damping_quartic, 1),
        "step_size_max" => longest_step_s,
        "preload" => joint.over_preload.as_ref().map(|table| table.nominal),
        _ => {
            let (side, quantity) = name.split_once('.')?;
            let bodies = file.bodies.as_ref()?;
            match side {
                "a" => of_body(&bodies.a, quantity),
                "b" => of_body(&bodies.b, quantity),
                _ => None,
            }
        }
    }
}

fn of_body(body: &Body, quantity: &str) -> Option<f64> {
    let (list, dof) = match quantity {
        "m" => (&body.inertia, 0),
        "J" => (&body.inertia, 1),
        "k_y" => (&body.stiffness, 0),
        "k_theta" => (&body.stiffness, 1),
        "c_y" => (&body.damping, 0),
        "c_theta" => (&body.damping, 1),
        _ => return None,
    };
    list.get(dof).copied()
}
