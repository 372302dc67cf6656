//! `resources/start.txt` of the two FMUs.

use std::fmt::Write as _;

use bolted_joint_dynamics::{JointLaw, Lap};

/// Instantiation token of both.
pub(crate) const TOKEN: &str = "benchmark";

const DOFS: [&str; 2] = ["y", "theta"];
const INERTIAS: [&str; 2] = ["m", "J"];

/// Start values of an element FMU.
pub(crate) fn element<const D: usize>(law: &JointLaw<D>) -> String {
    header("element", D) + &joint(law)
}

/// Start values of a lap FMU.
pub(crate) fn lap<const D: usize>(lap: &Lap<D>, step_size_max_s: f64) -> String {
    let mut text = header("lap", D) + &joint(&lap.joint);
    for (side, body) in [("a", &lap.a), ("b", &lap.b)] {
        for (i, dof) in DOFS.iter().take(D).enumerate() {
            // writing to a String cannot fail
            let _ = writeln!(text, "{side}.{} {:e}", INERTIAS[i], body.inertia[i]);
            let _ = writeln!(text, "{side}.k_{dof} {:e}", body.stiffness[i]);
            let _ = writeln!(text, "{side}.c_{dof} {:e}", body.damping[i]);
        }
    }
    let _ = writeln!(text, "step_size_max {step_size_max_s:e}");
    text
}

fn header(model: &str, dofs: usize) -> String {
    format!("bolted-joint-start/1\nmodel {model}\ndofs {dofs}\ntoken {TOKEN}\n")
}

fn joint<const D: usize>(law: &JointLaw<D>) -> String {
    let mut text = String::new();
    for i in 0..D {
        for j in i..D {
            let pair = [DOFS[i], DOFS[j]].concat();
            let _ = writeln!(text, "joint.k_{pair} {:e}", law.stiffness[i][j]);
            let _ = writeln!(text, "joint.c_{pair} {:e}", law.damping[i][j]);
        }
        let _ = writeln!(text, "joint.k3_{} {:e}", DOFS[i], law.cubic[i]);
        let higher = &law.higher;
        for (name, list) in [
            ("k5", &higher.quintic),
            ("k7", &higher.septic),
            ("c2", &higher.damping_quadratic),
            ("c4", &higher.damping_quartic),
        ] {
            let _ = writeln!(text, "joint.{name}_{} {:e}", DOFS[i], list[i]);
        }
    }
    text
}
