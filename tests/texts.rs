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
const PREDICTION: &str = include_str!("data/studies/two-bolts.toml");
const MODES: &str = include_str!("../examples/tol-m10x16/a-modes.toml");
const JOINT: &str = include_str!("data/joint/m10-aluminium.joint.json");
const PRELOAD: &str = include_str!("data/joint/over-preload.joint.json");

/// What a writer by hand, or by accident, puts into such files.
#[rustfmt::skip]
const TOKENS: [&str; 28] = [
    "-1", "1e999", "nan", "inf", "99999999999999999999", "\"", "[", "]", "{", "}", ",", "=", "\n", "null", "true", "[[",
    "\\u0000", "\u{0}", "ü", "[a]\n", "frf = \"x.csv\"\n", "units = { length = \"mm\", force = \"N\" }\n", "averages = 0\n",
    "\"11:+Y\"", "bands = \"median\"\n", "bolts = \"different\"\n",
    "joint = [{ name = \"x\", x = 0.1 }, { name = \"y\", x = 0.2 }]\n", "start = { stiffness = [[1]], damping = [[]] }\n",
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
    let is_good = |text: &str| JointFile::from_json(text, "joint.json").is_ok();
    run(JOINT, is_good);
    run(PRELOAD, is_good);
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
    let file = std::fs::File::create(&path).unwrap();
    file.set_len(20_000_000_000).unwrap();
    let expected = ["long.toml: found more than 16777216 bytes, expected"];
    has(&Study::read(&path).unwrap_err().to_string(), &expected);
    has(&ModalModel::read(&path).unwrap_err().to_string(), &expected);
    has(&JointFile::read(&path).unwrap_err().to_string(), &expected);
}
