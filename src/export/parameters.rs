//! Which number of the joint file each parameter of an FMU starts with.

use crate::joint::{Body, JointFile};

/// Start value of the parameter `name`, or `None` where the joint file has no such number.
///
/// A cubic stiffness that the file leaves out is zero.
pub(crate) fn start_value(
    file: &JointFile,
    longest_step_s: Option<f64>,
    name: &str,
) -> Option<f64> {
    let joint = &file.joint;
    let entry = |matrix: &[Vec<f64>], i: usize, j: usize| matrix.get(i)?.get(j).copied();
    let cubic = |i: usize| {
        if joint.cubic.is_empty() {
            Some(0.0)
        } else {
            joint.cubic.get(i).copied()
        }
    };
    match name {
        "joint.k_yy" => entry(&joint.stiffness, 0, 0),
        "joint.k_ytheta" => entry(&joint.stiffness, 0, 1),
        "joint.k_thetatheta" => entry(&joint.stiffness, 1, 1),
        "joint.c_yy" => entry(&joint.damping, 0, 0),
        "joint.c_ytheta" => entry(&joint.damping, 0, 1),
        "joint.c_thetatheta" => entry(&joint.damping, 1, 1),
        "joint.k3_y" => cubic(0),
        "joint.k3_theta" => cubic(1),
        "step_size_max" => longest_step_s,
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
