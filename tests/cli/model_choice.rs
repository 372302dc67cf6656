//! Starts that the study gives, and the comparison of joint models where the rotation is known beside a translation.

use crate::bench::{Bench, IDENTIFY, replaced};
use crate::rig::{self, FULL, TRANSLATION, matrix_of};
use bolted_joint_testing::has;

#[test]
fn a_translation_is_compared_with_the_models_that_rotate() {
    let bench = rig::of(&FULL, "translation");
    let outcome = bench.done(IDENTIFY);
    let advice = "\"full\" is the simplest adequate one: consider it instead of \"translation\"";
    // Two numbers on the residual that seem to contradict each other, and what each is.
    let relative = "The residual in % is relative to each computed value";
    has(
        &outcome.stdout,
        &[advice, ", half of the values within", relative],
    );
    has(
        &outcome.stderr,
        &["% r.m.s. of the receptance and more than noise"],
    );
    let models = bench.done(&format!("{IDENTIFY} --json")).json();
    let compared: Vec<&str> = models["models"]["compared"]
        .as_array()
        .unwrap()
        .iter()
        .map(|fit| fit["model"].as_str().unwrap())
        .collect();
    assert_eq!(compared, ["translation", "diagonal", "full"]);
    let dofs = &bench.json("o.joint.json")["joint"]["dofs"];
    assert_eq!(*dofs, serde_json::json!(["y"]));
    // Where there is no stiffness in rotation the simplest model is enough.
    let bench = rig::of(&TRANSLATION, "translation");
    let text = bench.done(IDENTIFY).stdout;
    has(&text, &["\"translation\" is the simplest adequate one"]);
    let found = matrix_of(&bench.json("o.joint.json"), "stiffness");
    assert!((found[(0, 0)] / 8e4 - 1.0).abs() < 1e-8, "{found}");
}

#[test]
fn without_a_rotation_the_output_says_why_models_are_not_compared() {
    let bench = rig::of(&TRANSLATION, "translation");
    let text = bench.text("study.toml");
    let with = ", theta = { points = [\"3:+Y\", \"2:+Y\", \"1:+Y\"], spacing = 0.03 }";
    let without_a = replaced(&text, with, "");
    for (text, keys) in [
        (without_a.clone(), "a.joint.theta is not given"),
        (
            replaced(&without_a, ", theta = \"20:+RZ\"", ""),
            "a.joint.theta and b.joint.theta are not given",
        ),
    ] {
        bench.write("study.toml", text);
        let output = bench.done(&format!("{IDENTIFY} --report o.html")).stdout;
        has(&output, &[format!("joint models are not compared: {keys}")]);
        assert!(bench.text("o.html").contains(keys));
        let found = matrix_of(&bench.json("o.joint.json"), "stiffness");
        assert!((found[(0, 0)] / 8e4 - 1.0).abs() < 1e-8, "{found}");
    }
    let json = bench.done(&format!("{IDENTIFY} --json")).json();
    let (models, reason) = (&json["models"], &json["models_not_compared"]);
    assert!(models.is_null() && reason.is_string(), "{json}");
}

#[test]
fn a_presumed_joint_is_one_start_more() {
    let bench = rig::ready();
    let tried = |bench: &Bench| {
        let json = bench.done(&format!("{IDENTIFY} --json")).json();
        let found = matrix_of(&json["joint_file"], "stiffness");
        assert!((found[(0, 1)] / 600.0 - 1.0).abs() < 1e-6, "{found}");
        json["starts"]["tried"].as_u64().unwrap()
    };
    let without = tried(&bench);
    let start = "\n[start]\nstiffness = [[1e5, 0], [0, 100]]\ndamping = [[1, 0], [0, 0.01]]\n";
    bench.write("study.toml", bench.text("study.toml") + start);
    assert_eq!(tried(&bench), without + 1);
    has(&bench.report(), &["Presumed joint, a start of the search"]);
}

#[test]
fn the_bands_of_the_averages_are_chosen_printed_and_recorded() {
    let bench = rig::ready();
    let text = bench.text("study.toml");
    let output = bench.done(&format!("{IDENTIFY} --report o.html")).stdout;
    let chosen = "Hz, chosen by sensitivity and distance to resonances";
    has(&output, &[chosen]);
    assert!(bench.text("o.html").contains("Hz, chosen"));
    let bands = |bench: &Bench| bench.json("o.joint.json")["provenance"]["bands"].clone();
    let chosen = bands(&bench);
    for entry in ["yy", "ytheta", "thetatheta"] {
        assert_eq!(chosen[entry]["origin"], "automatic", "{chosen}");
        let own = chosen[entry]["frequency_hz"].as_array().unwrap();
        assert!(!own.is_empty() && own.len() < 10, "{chosen}");
    }
    // One entry given, one left to the median, the third chosen as before.
    let given = "\n[bands]\nyy = [[20, 60]]\nytheta = \"median\"\n";
    bench.write("study.toml", text.clone() + given);
    let output = bench.done(IDENTIFY).stdout;
    has(&output, &["yy: 20.00 to 60.00 Hz, as in the study"]);
    let median = "ytheta: all lines, their median, as in the study";
    has(&output, &[median]);
    let mixed = bands(&bench);
    let given = serde_json::json!({ "origin": "study", "frequency_hz": [[20.0, 60.0]] });
    assert_eq!(mixed["yy"], given);
    assert_eq!(mixed["ytheta"], serde_json::json!({ "origin": "median" }));
    assert_eq!(mixed["thetatheta"], chosen["thetatheta"]);
    // Two lines are no band.
    bench.write("study.toml", replaced(&text, "to = 200", "to = 6"));
    let output = bench.done(IDENTIFY).stdout;
    has(&output, &["all lines, their median: no band qualifies"]);
    // The word for all.
    let inside = "bands = \"median\"\n[frequency]";
    bench.write("study.toml", replaced(&text, "[frequency]", inside));
    bench.refused(IDENTIFY, &["unknown field `bands`"]);
    let all = replaced(&text, "name = ", "bands = \"median\"\nname = ");
    bench.write("study.toml", all);
    let output = bench.done(IDENTIFY).stdout;
    has(&output, &["yy: all lines, their median, as in the study"]);
}
