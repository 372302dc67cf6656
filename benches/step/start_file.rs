//! `resources/start.txt` of the two FMUs.

use std::fmt::Write as _;

use bolted_joint_dynamics::{
    DOFS, JointLaw, Lap,
    law::{FIRST_PARAMETER_COUNT, Term, dof_parameters},
};

/// Instantiation token of both.
pub(crate) const TOKEN: &str = "benchmark";

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
            let _ = writeln!(text, "{side}.{} {:e}", dof.inertia, body.inertia[i]);
            let _ = writeln!(text, "{side}.k_{} {:e}", dof.name, body.stiffness[i]);
            let _ = writeln!(text, "{side}.c_{} {:e}", dof.name, body.damping[i]);
        }
    }
    let _ = writeln!(text, "step_size_max {step_size_max_s:e}");
    text
}

fn header(model: &str, dofs: usize) -> String {
    format!("bolted-joint-start/1\nmodel {model}\ndofs {dofs}\ntoken {TOKEN}\n")
}

fn joint<const D: usize>(law: &JointLaw<D>) -> String {
    // the laws that remember, each with all of its parameters
    let has = |name: &str| {
        law.on.iter().any(|laws| {
            let mut own = laws.parameters().iter().zip(dof_parameters());
            own.any(|(&value, (law, _))| law.name == name && value != 0.0)
        })
    };
    let mut remembering: Vec<&str> = dof_parameters()
        .filter(|(law, _)| law.remembers() && has(law.name))
        .map(|(law, _)| law.name)
        .collect();
    remembering.dedup();
    let mut text = String::new();
    if !remembering.is_empty() {
        text += &format!("laws {}\n", remembering.join(" "));
    }
    let (linear, polynomials) = (&law.linear, law.polynomials());
    for i in 0..D {
        let dof = DOFS[i].name;
        for j in i..D {
            let pair = [dof, DOFS[j].name].concat();
            let _ = writeln!(text, "joint.k_{pair} {:e}", linear.stiffness[i][j]);
            let _ = writeln!(text, "joint.c_{pair} {:e}", linear.damping[i][j]);
        }
        for term in Term::ALL {
            let (symbol, value) = (term.row().symbol, polynomials[i].coefficient(term));
            let _ = writeln!(text, "joint.{symbol}_{dof} {value:e}");
        }
        // no law has another of its kind beside it
        let parameters = law.on[i].parameters().iter().take(FIRST_PARAMETER_COUNT);
        for (value, (law, parameter)) in parameters.zip(dof_parameters()) {
            if remembering.contains(&law.name) {
                let _ = writeln!(text, "joint.{}_{dof} {value:e}", parameter.symbol);
            }
        }
    }
    text
}
