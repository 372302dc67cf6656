//! Joints of two bolts that are known: one joint for both, or one each.

use bolted_joint_testing::has;
use serde_json::Value;

use crate::bench::{Bench, replaced};
use crate::rig::{
    FULL, Joint, Quantity, TRANSLATION, first_bolt, matrix_of, measure_bolted, second_bolt, study,
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
    measure_bolted(
        &bench,
        &[first_bolt(first), second_bolt(second)],
        quantities,
    );
    let text = replaced(&study(model, &[21, 22, 23]), ON_A, TWO_ON_A);
    let text = replaced(&text, ON_B, TWO_ON_B);
    let model = format!("model = \"{model}\"");
    let text = replaced(&text, &model, &format!("{model}\nbolts = \"{bolts}\""));
    bench.write("study.toml", text);
    bench
}

fn deviation(file: &Value, joint: &Joint) -> f64 {
    let mut largest = 0.0_f64;
    for (key, exact) in [("stiffness", &joint.stiffness), ("damping", &joint.damping)] {
        let found = matrix_of(file, key);
        for i in 0..found.nrows() {
            for j in 0..found.ncols() {
                let scale = (exact[(i, i)] * exact[(j, j)]).sqrt();
                largest = largest.max((found[(i, j)] - exact[(i, j)]).abs() / scale);
            }
        }
    }
    largest
}

/// The same joint with everything multiplied.
fn times(joint: Joint, factor: f64) -> Joint {
    Joint {
        stiffness: joint.stiffness * factor,
        damping: joint.damping * factor,
    }
}

#[test]
fn two_bolts_that_are_alike_have_one_joint_file() {
    let bench = bolted([FULL, FULL], "full", "alike");
    let arguments = [
        "identify",
        "study.toml",
        "-o",
        "o.joint.json",
        "--report",
        "o.html",
    ];
    let text = bench.done(&arguments).stdout;
    assert!(text.contains("the same at left and right"), "{text}");
    let file = bench.json("o.joint.json");
    let error = deviation(&file, &FULL);
    assert!(error < 1e-6, "{error}");
    let bolts: Vec<&str> = file["provenance"]["bolts"]
        .as_array()
        .unwrap()
        .iter()
        .map(|bolt| bolt.as_str().unwrap())
        .collect();
    assert_eq!(bolts, ["left", "right"]);
    assert!(
        bench
            .text("o.html")
            .contains("the same joint at the bolts left, right")
    );
    bench.done(&["check", "o.joint.json"]);
    bench.done(&["export", "o.joint.json", "-o", "o.fmu"]);
}

#[test]
fn bolts_that_differ_have_a_joint_file_each() {
    // Rigid bodies tell three stiffnesses between them: those of two springs, not those of two full joints.
    let second = times(TRANSLATION, 2.5);
    let bench = bolted([TRANSLATION, second], "translation", "different");
    let before = bench.names();
    let arguments = ["identify", "study.toml", "-o", "o.joint.json"];
    let text = bench.done(&arguments).stdout;
    has(
        &text,
        &[
            "one each at left and right",
            "left k_yy",
            "right c_yy",
            "wrote o.left.joint.json\nwrote o.right.joint.json\n",
        ],
    );
    let mut expected = before.clone();
    expected.extend(["o.left.joint.json", "o.right.joint.json"].map(str::to_owned));
    expected.sort();
    assert_eq!(bench.names(), expected);
    for (bolt, joint) in [("left", TRANSLATION), ("right", second)] {
        let file = bench.json(&format!("o.{bolt}.joint.json"));
        let error = deviation(&file, &joint);
        assert!(error < 1e-6, "{bolt}: {error}");
        assert_eq!(file["name"], format!("two bodies, {bolt}"));
        assert_eq!(file["provenance"]["bolts"], serde_json::json!([bolt]));
        let unknowns = &file["uncertainty"]["correlation"]["unknowns"];
        assert_eq!(*unknowns, serde_json::json!(["k_yy", "c_yy"]));
    }
    let json = bench.done(&[&arguments[..], &["--json"]].concat()).json();
    assert_eq!(json["bolts"][1]["output"], "o.right.joint.json");
    assert_eq!(
        json["bolts"][1]["joint_file"],
        bench.json("o.right.joint.json")
    );
}

#[test]
fn of_the_files_of_two_bolts_both_are_written_or_none() {
    let bench = bolted(
        [TRANSLATION, times(TRANSLATION, 2.5)],
        "translation",
        "different",
    );
    bench.write("o.left.joint.json", "old");
    std::fs::create_dir(bench.path("o.right.joint.json")).unwrap();
    bench.refused(
        &["identify", "study.toml", "-o", "o.joint.json"],
        &["o.right.joint.json: cannot be written"],
    );
    assert_eq!(bench.text("o.left.joint.json"), "old");
    std::fs::remove_dir(bench.path("o.right.joint.json")).unwrap();
    // A study in the way of a bolt's file is an input, not an output.
    let study = bench.text("study.toml");
    bench.write("o.left.joint.json", study);
    bench.refused(
        &["identify", "o.left.joint.json", "-o", "o.joint.json"],
        &["o.left.joint.json: found it to be the same file"],
    );
}

#[test]
fn what_two_bolts_answer_can_be_computed_and_identified_again() {
    let second = times(TRANSLATION, 2.5);
    let bench = bolted([TRANSLATION, second], "translation", "different");
    bench.done(&["identify", "study.toml", "-o", "o.joint.json"]);
    let respond = [
        "respond",
        "study.toml",
        "--joint",
        "o.joint.json",
        "-o",
        "c.uff",
        "--step",
        "3",
    ];
    let text = bench.done(&respond).stdout;
    assert!(text.contains("[bands]  # of right:"), "{text}");
    bench.done(&["identify", "study.toml", "-o", "again.joint.json"]);
    let again = bench.json("again.right.joint.json");
    let error = deviation(&again, &second);
    assert!(error < 1e-5, "{error}");
}
