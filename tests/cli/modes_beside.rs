//! FRFs of a substructure together with its modes, which supply what was not measured.

use crate::bench::{Bench, IDENTIFY};
use crate::rig::{self, FULL, functions_of, modes_of_a};
use bolted_joint_testing::has;

/// The rig's bench with modes of A beside its functions, of which only some are left.
fn bench(keep: impl Fn(usize, usize) -> bool) -> Bench {
    let bench = rig::ready();
    // Nine functions, reference by reference within each response.
    let kept = functions_of(&bench.text("a.uff"), |place| {
        keep(1 + place / 3, 1 + place % 3)
    });
    bench.write("a.uff", kept);
    bench.write("modes.toml", modes_of_a(1.0));
    bench.write("bare.toml", bench.text("study.toml"));
    let beside = "frf = \"a.uff\"\nmodal = \"modes.toml\"";
    bench.edit("study.toml", "frf = \"a.uff\"", beside);
    bench
}

#[test]
fn columns_that_were_not_measured_come_from_the_modes() {
    // Loads at point 2 alone: with reciprocity five of nine functions, where a rotation needs all.
    let bench = bench(|_, reference| reference == 2);
    bench.refused(
        "identify bare.toml -o o.joint.json",
        &["a.uff: no function with response 3:+Y and reference 3:+Y"],
    );
    let text = bench.done(IDENTIFY).stdout;
    FULL.is_in(&bench);
    let told = "from the modes of a: 3:+Y / 3:+Y, 3:+Y / 1:+Y, 1:+Y / 1:+Y, taken as exact; \
                of the measured functions the modes are 0.00 % away";
    has(&text, &[told]);
    let file = bench.json("o.joint.json");
    let provenance = &file["provenance"];
    assert_eq!(
        provenance["from_modes"],
        serde_json::json!([{
            "substructure": "a",
            "file": "modes.toml",
            "functions": [["3:+Y", "3:+Y"], ["3:+Y", "1:+Y"], ["1:+Y", "1:+Y"]]
        }])
    );
    let roles: Vec<&str> = provenance["inputs"]
        .as_array()
        .unwrap()
        .iter()
        .map(|input| input["role"].as_str().unwrap())
        .collect();
    let expected = [
        "study",
        "substructure a",
        "substructure a, modes",
        "substructure b",
        "assembly",
    ];
    assert_eq!(roles, expected);
}

#[test]
fn a_point_that_was_not_measured_comes_from_the_modes() {
    let bench = bench(|response, reference| response != 3 && reference != 3);
    bench.done(IDENTIFY);
    FULL.is_in(&bench);
}

#[test]
fn what_was_measured_wins_over_modes_that_are_wrong() {
    let bench = bench(|_, _| true);
    bench.write("modes.toml", modes_of_a(1.5));
    let text = bench.done(&format!("{IDENTIFY} --report o.html")).stdout;
    FULL.is_in(&bench);
    // Shapes 1.5 times too large make receptances 2.25 times too large.
    let away = "the modes are 125.00 % away";
    has(&text, &["nothing, all functions were measured", away]);
    has(&bench.text("o.html"), &["From modes, substructure A"]);
    let provenance = &bench.json("o.joint.json")["provenance"];
    let functions = &provenance["from_modes"][0]["functions"];
    assert_eq!(*functions, serde_json::json!([]));
}

#[test]
fn what_neither_the_functions_nor_the_modes_have_is_an_error() {
    let bench = bench(|response, reference| response != 3 && reference != 3);
    let without_3 = r#"points = ["1:+Y", "2:+Y"]
[[mode]]
frequency_hz = 30.0
damping_ratio = 0.01
shape = [[0.9, 0.0], [0.9, 0.0]]
"#;
    bench.write("modes.toml", without_3);
    bench.refused(
        IDENTIFY,
        &[
            "a.uff: no function with response 3:+Y and reference 3:+Y",
            "nor do the modes have it",
            "modes.toml: no mode shape at 3:+Y; the points are 1:+Y, 2:+Y",
        ],
    );
    bench.write("modes.toml", without_3.to_owned() + "[[mode]]\n");
    bench.refused(IDENTIFY, &["modes.toml: ", "missing field"]);
}
