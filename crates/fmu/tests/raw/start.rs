//! The start-value file of FMUs for tests.

/// Parameters of the FMUs with round values, so that expected results can be worked out by hand.
const JOINT: [(&str, f64); 16] = [
    ("joint.k_yy", 4.0e6),
    ("joint.k_ytheta", 1.0e4),
    ("joint.k_thetatheta", 2.0e3),
    ("joint.c_yy", 8.0),
    ("joint.c_ytheta", 0.5),
    ("joint.c_thetatheta", 0.25),
    ("joint.k3_y", 0.0),
    ("joint.k3_theta", 0.0),
    ("joint.k5_y", 0.0),
    ("joint.k5_theta", 0.0),
    ("joint.k7_y", 0.0),
    ("joint.k7_theta", 0.0),
    ("joint.c2_y", 0.0),
    ("joint.c2_theta", 0.0),
    ("joint.c4_y", 0.0),
    ("joint.c4_theta", 0.0),
];

const BODY: [(&str, f64); 6] = [
    ("m", 2.0),
    ("J", 1e-3),
    ("k_y", 8.0e5),
    ("k_theta", 1.0e3),
    ("c_y", 1.0),
    ("c_theta", 1e-3),
];

/// The DOFs in space.
pub(crate) const SPACE: [&str; 6] = ["x", "y", "z", "rx", "ry", "rz"];

/// Parameters of a joint in space, and of both bodies of a lap in space; the stiffness is coupled but between x and y.
fn in_space(is_lap: bool) -> Vec<(String, f64)> {
    let mut all = Vec::new();
    let of =
        |i: usize, [translation, rotation]: [f64; 2]| if i < 3 { translation } else { rotation };
    for (symbol, own) in [("k", [4.0e6, 2.0e3]), ("c", [8.0, 0.25])] {
        for (i, row) in SPACE.iter().enumerate() {
            for (j, column) in SPACE.iter().enumerate().skip(i) {
                let value = match (i, j) {
                    _ if i == j => of(i, own),
                    (0, 1) => 0.0,
                    _ => 0.1 * (of(i, own) * of(j, own)).sqrt() / (1 + j - i) as f64,
                };
                all.push((format!("joint.{symbol}_{row}{column}"), value));
            }
        }
    }
    for symbol in ["k3", "k5", "k7", "c2", "c4"] {
        all.extend(
            SPACE
                .iter()
                .map(|dof| (format!("joint.{symbol}_{dof}"), 0.0)),
        );
    }
    for side in ["a", "b"].iter().filter(|_| is_lap) {
        for (i, dof) in SPACE.iter().enumerate() {
            let axis = &dof[dof.len() - 1..];
            let inertia = if i < 3 { "m" } else { "J" };
            all.push((format!("{side}.{inertia}_{axis}"), of(i, [2.0, 1e-3])));
            all.push((format!("{side}.k_{dof}"), of(i, [8.0e5, 1.0e3])));
            all.push((format!("{side}.c_{dof}"), of(i, [1.0, 1e-3])));
        }
    }
    if is_lap {
        all.push(("step_size_max".to_owned(), 2e-5));
    }
    all
}

/// Text of `start.txt`, of a lap or an element with one or two DOFs in a plane or six in space, with some parameters replaced.
pub(crate) fn start_text(is_lap: bool, dofs: u8, token: &str, changes: &[(&str, f64)]) -> String {
    let own = |(name, value): &(&str, f64)| ((*name).to_owned(), *value);
    let mut parameters: Vec<(String, f64)> = JOINT.iter().map(own).collect();
    if is_lap {
        for side in ["a", "b"] {
            let of_side = |(name, value): &(&str, f64)| (format!("{side}.{name}"), *value);
            parameters.extend(BODY.iter().map(of_side));
        }
        parameters.push(("step_size_max".to_owned(), 2e-5));
    }
    if dofs == 1 {
        parameters.retain(|(name, _)| !name.ends_with("theta") && !name.ends_with(".J"));
    }
    let mut dofs_text = dofs.to_string();
    if dofs == 6 {
        (parameters, dofs_text) = (in_space(is_lap), SPACE.join(" "));
    }
    let model = if is_lap { "lap" } else { "element" };
    let mut text =
        format!("bolted-joint-start/1\nmodel {model}\ndofs {dofs_text}\ntoken {token}\n");
    for (name, value) in parameters {
        let changed = changes.iter().find(|(changed, _)| *changed == name);
        let value = changed.map_or(value, |(_, value)| *value);
        text += &format!("{name} {value}\n");
    }
    text
}
