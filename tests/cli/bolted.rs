//! Joints of two bolts that are known: one joint for both, or one each.

use bolted_joint_testing::has;

use crate::bench::{Bench, IDENTIFY};
use crate::rig::{
    FULL, Joint, Quantity, TRANSLATION, first_bolt, measure_bolted, second_bolt, study,
};

const ON_A: &str =
    "joint = { y = \"2:+Y\", theta = { points = [\"3:+Y\", \"2:+Y\", \"1:+Y\"], spacing = 0.03 } }";
const TWO_ON_A: &str = r#"joint = [
    { name = "left", y = "2:+Y", theta = { points = ["3:+Y", "2:+Y", "1:+Y"], spacing = 0.03 } },
    { name = "right", y = "4:+Y", theta = { points = ["5:+Y", "4:+Y", "3:+Y"], spacing = 0.03 } },
]"#;
const ON_B: &str = "joint = { y = \"20:+Y\", theta = \"20:+RZ\" }";
const TWO_ON_B: &str = r#"joint = [
    { name = "left", y = "20:+Y", theta = "20:+RZ" },
    { name = "right", y = "30:+Y", theta = "30:+RZ" },
]"#;

fn bolted(joints: [Joint; 2], model: &str, bolts: &str) -> Bench {
    let bench = Bench::new();
    let [first, second] = joints;
    let quantities = [
        Quantity::Mobility,
        Quantity::Accelerance,
        Quantity::Receptance,
    ];
    let bolts_of_both = [first_bolt(first), second_bolt(second)];
    measure_bolted(&bench, &bolts_of_both, quantities);
    bench.write("study.toml", study(model, &[21, 22, 23]));
    bench.edit("study.toml", ON_A, TWO_ON_A);
    bench.edit("study.toml", ON_B, TWO_ON_B);
    let model = format!("model = \"{model}\"");
    let with_bolts = format!("{model}\nbolts = \"{bolts}\"");
    bench.edit("study.toml", &model, &with_bolts);
    bench
}

#[test]
fn two_bolts_that_are_alike_have_one_joint_file() {
    let bench = bolted([FULL, FULL], "full", "alike");
    let outcome = bench.done(&format!("{IDENTIFY} --report o.html"));
    has(&outcome.stdout, &["the same at left and right"]);
    // The data are exact: rounding is no reason to mistrust the joint.
    assert!(!outcome.stderr.contains("search"), "{}", outcome.stderr);
    FULL.is_in(&bench);
    let bolts = &bench.json("o.joint.json")["provenance"]["bolts"];
    assert_eq!(*bolts, serde_json::json!(["left", "right"]));
    let expected = ["the same joint at the bolts left, right"];
    has(&bench.text("o.html"), &expected);
    bench.done("check o.joint.json");
    bench.done("export o.joint.json -o o.fmu");
}

#[test]
fn bolts_that_differ_have_a_joint_file_each() {
    // Rigid bodies tell three stiffnesses between them: those of two springs, not those of two full joints.
    let second = TRANSLATION.times(2.5);
    let bench = bolted([TRANSLATION, second], "translation", "different");
    let before = bench.names();
    let text = bench.done(IDENTIFY).stdout;
    has(
        &text,
        &[
            "one each at left and right",
            "left k_yy",
            "right c_yy",
            "wrote o.left.joint.json\nwrote o.right.joint.json\n",
        ],
    );
    let mut expected = before;
    expected.extend(["o.left.joint.json", "o.right.joint.json"].map(str::to_owned));
    expected.sort();
    assert_eq!(bench.names(), expected);
    for (bolt, joint) in [("left", TRANSLATION), ("right", second)] {
        let file = bench.json(&format!("o.{bolt}.joint.json"));
        let error = joint.error_of(&file["joint"]);
        assert!(error < 1e-6, "{bolt}: {error}");
        assert_eq!(file["name"], format!("two bodies, {bolt}"));
        assert_eq!(file["provenance"]["bolts"], serde_json::json!([bolt]));
        let unknowns = &file["uncertainty"]["correlation"]["unknowns"];
        assert_eq!(*unknowns, serde_json::json!(["k_yy", "c_yy"]));
    }
    let json = bench.done(&format!("{IDENTIFY} --json")).json();
    let right = &json["bolts"][1];
    assert_eq!(right["output"], "o.right.joint.json");
    assert_eq!(right["joint_file"], bench.json("o.right.joint.json"));
}

#[test]
fn of_the_files_of_two_bolts_both_are_written_or_none() {
    let second = TRANSLATION.times(2.5);
    let bench = bolted([TRANSLATION, second], "translation", "different");
    bench.write("o.left.joint.json", "old");
    std::fs::create_dir(bench.path("o.right.joint.json")).unwrap();
    bench.refused(IDENTIFY, &["o.right.joint.json: cannot be written"]);
    assert_eq!(bench.text("o.left.joint.json"), "old");
    std::fs::remove_dir(bench.path("o.right.joint.json")).unwrap();
    // A study in the way of a bolt's file is an input, not an output.
    let study = bench.text("study.toml");
    bench.write("o.left.joint.json", study);
    bench.refused(
        "identify o.left.joint.json -o o.joint.json",
        &["o.left.joint.json: found it to be the same file"],
    );
}

#[test]
fn what_two_bolts_answer_can_be_computed_and_identified_again() {
    let second = TRANSLATION.times(2.5);
    let bench = bolted([TRANSLATION, second], "translation", "different");
    bench.done(IDENTIFY);
    std::fs::remove_file(bench.path("c.uff")).unwrap();
    let outcome = bench.done("respond study.toml --joint o.joint.json -o c.uff --step 3");
    has(&outcome.stdout, &["[bands]  # of right:"]);
    bench.done("identify study.toml -o again.joint.json");
    let again = bench.json("again.right.joint.json");
    let error = second.error_of(&again["joint"]);
    assert!(error < 1e-5, "{error}");
}
