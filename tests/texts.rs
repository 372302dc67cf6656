//! Damaged studies, modal data and joint files: an error or a file that is still good, and never a panic.
#![allow(
    clippy::unwrap_used,
    clippy::panic,
    reason = "helpers of tests fail as the tests do"
)]

use bolted_joint_testing::has;
use std::path::Path;

use bolted_joint::identify::Study;
use bolted_joint::joint::JointFile;
use bolted_joint::predict::study::{InterfaceStudy, Prediction};
use bolted_joint::structure::ModalModel;
use bolted_joint::study::StudyText;
use proptest::prelude::*;
use proptest::test_runner::TestRunner;

const STUDY: &str = include_str!("../examples/tol-m10x16/study.toml");
const PREDICTION: &str = r#"method = "fractal-contact"
name = "two bolts"
[materials]
a = { youngs_modulus = 2.1e11, poissons_ratio = "0.3 ± 0.01" }
b = { youngs_modulus = 2.1e11, poissons_ratio = 0.3 }
[surface]
fractal_dimension = "1.42 ± 0.02"
roughness = { value = 1.2e-8, standard_deviation = 1e-9 }
correlation = 0.9
[contact]
hardness = 1.8e9
friction = 0.25
shear_strength = 5e7
[interface]
x = [-0.05, 0.05]
y = [-0.03, 0.03]
elements = [6, 4]
[pressure]
model = "cone"
half_angle = 30
head_diameter = 0.013
depth = 0.012
bending_moment = [0, "10 ± 1"]
[[bolts]]
x = -0.02
y = 0
diameter = 0.008
torque = 20
[[bolts]]
x = 0.02
y = 0
diameter = 0.008
preload = "9000 ± 450"
[tightening]
thread = { friction = "0.12 ± 0.01", head_friction = 0.1, head_diameter = 0.013, hole_diameter = 0.009 }
scatter = "common"
[joint]
translation = "z"
rotation = "-y"
reference = [0, 0, 0.001]
[damping]
frequency = 300
normal = "viscous"
mass = 3
[uncertainty]
draws = 20
"#;
const MODES: &str = include_str!("../examples/tol-m10x16/a-modes.toml");
const JOINT: &str = include_str!("data/joint/m10-aluminium.joint.json");
const PRELOAD: &str = include_str!("data/joint/over-preload.joint.json");

/// What a writer by hand, or by accident, puts into such files.
const TOKENS: [&str; 28] = [
    "-1",
    "1e999",
    "nan",
    "inf",
    "99999999999999999999",
    "\"",
    "[",
    "]",
    "{",
    "}",
    ",",
    "=",
    "\n",
    "null",
    "true",
    "[[",
    "\\u0000",
    "\u{0}",
    "ü",
    "[a]\n",
    "frf = \"x.csv\"\n",
    "units = { length = \"mm\", force = \"N\" }\n",
    "averages = 0\n",
    "\"11:+Y\"",
    "bands = \"median\"\n",
    "bolts = \"different\"\n",
    "joint = [{ name = \"x\", x = 0.1 }, { name = \"y\", x = 0.2 }]\n",
    "start = { stiffness = [[1]], damping = [[]] }\n",
];

fn damaged(text: &str, damages: &[(usize, usize, Option<usize>)]) -> String {
    let mut characters: Vec<char> = text.chars().collect();
    for &(at, length, token) in damages {
        let at = at % (characters.len() + 1);
        let to = (at + length).min(characters.len());
        let inserted = token.map_or("", |token| TOKENS[token]).chars();
        drop(characters.splice(at..to, inserted));
    }
    characters.into_iter().collect()
}

fn run(text: &'static str, read: fn(&str) -> bool) {
    assert!(read(text), "the file is good as it is");
    let config = ProptestConfig {
        cases: 1500,
        failure_persistence: None,
        ..ProptestConfig::default()
    };
    let token = prop::option::of(0..TOKENS.len());
    let damages = prop::collection::vec((any::<usize>(), 0..12_usize, token), 1..5);
    TestRunner::new(config)
        .run(&damages, |damages| {
            read(&damaged(text, &damages));
            Ok(())
        })
        .unwrap();
}

#[test]
fn damaged_studies_do_not_panic() {
    run(STUDY, |text| {
        Study::from_toml(text, Path::new("study.toml")).is_ok()
    });
}

#[test]
fn damaged_predictions_do_not_panic() {
    run(PREDICTION, |text| {
        InterfaceStudy::of(&StudyText::new(text, Path::new("study.toml")))
            .is_ok_and(|study| Prediction::of(&study, &|| {}).is_ok())
    });
}

#[test]
fn damaged_modal_data_do_not_panic() {
    run(MODES, |text| {
        ModalModel::from_toml(text, Path::new("modes.toml")).is_ok()
    });
}

#[test]
fn damaged_joint_files_do_not_panic() {
    run(JOINT, |text| {
        JointFile::from_json(text, "joint.json").is_ok()
    });
    run(PRELOAD, |text| {
        JointFile::from_json(text, "joint.json").is_ok()
    });
}

/// Nesting takes no more stack than the readers allow.
#[test]
fn deep_nesting_is_an_error() {
    for open in ["[", "{\"a\":", "a = [", "[[a.", "a = {a = "] {
        let text = open.repeat(100_000);
        assert!(JointFile::from_json(&text, "joint.json").is_err());
        assert!(Study::from_toml(&text, Path::new("study.toml")).is_err());
    }
}

/// A path to something else, such as a measurement, does not fill the memory.
#[test]
fn files_of_texts_are_not_read_to_an_end_that_is_far() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("long.toml");
    std::fs::File::create(&path)
        .unwrap()
        .set_len(20_000_000_000)
        .unwrap();
    let messages = [
        Study::read(&path).unwrap_err().to_string(),
        ModalModel::read(&path).unwrap_err().to_string(),
        JointFile::read(&path).unwrap_err().to_string(),
    ];
    for message in messages {
        has(
            &message,
            &["long.toml: found more than 16777216 bytes, expected"],
        );
    }
}
