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

/// Text of `start.txt`, of a lap or an element, with some parameters replaced.
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
    let model = if is_lap { "lap" } else { "element" };
    let mut text = format!("bolted-joint-start/1\nmodel {model}\ndofs {dofs}\ntoken {token}\n");
    for (name, value) in parameters {
        let changed = changes.iter().find(|(changed, _)| *changed == name);
        let value = changed.map_or(value, |(_, value)| *value);
        text += &format!("{name} {value}\n");
    }
    text
}
