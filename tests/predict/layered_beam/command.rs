//! The commands: from the study to an FMU, and the thesis computed anew.

use bolted_joint_testing::has;
use std::path::Path;
use std::process::{Command, Output};

fn run(arguments: &[&str], folder: &Path) -> Output {
    let program = env!("CARGO_BIN_EXE_bolted-joint");
    Command::new(program)
        .args(arguments)
        .current_dir(folder)
        .output()
        .unwrap()
}

#[track_caller]
fn succeeds(arguments: &[&str], folder: &Path) -> String {
    let output = run(arguments, folder);
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    String::from_utf8(output.stdout).unwrap()
}

#[test]
fn the_example_becomes_an_fmu() {
    let folder = tempfile::tempdir().unwrap();
    let study = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/kavi-layered-beam/study.toml");
    let study = study.to_str().unwrap();
    let written = succeeds(
        &[
            "predict",
            study,
            "-o",
            "beam.joint.json",
            "--damping-csv",
            "damping.csv",
            "--figure",
            "damping.svg",
        ],
        folder.path(),
    );
    has(&written, &["mode 1 at 1.000e-4 m: damping ratio 0.01200"]);
    let csv = std::fs::read_to_string(folder.path().join("damping.csv")).unwrap();
    assert_eq!(csv.lines().count(), 1 + 5 * 21);
    let figure = std::fs::read_to_string(folder.path().join("damping.svg")).unwrap();
    assert!(figure.starts_with("<svg") && figure.contains("joint file"));
    succeeds(&["check", "beam.joint.json"], folder.path());
    for interface in ["lap", "element"] {
        succeeds(
            &[
                "export",
                "beam.joint.json",
                "-o",
                "beam.fmu",
                "--as",
                interface,
            ],
            folder.path(),
        );
        let checked = succeeds(&["check", "beam.fmu"], folder.path());
        assert!(checked.contains("no problem found"), "{checked}");
    }
}

#[test]
fn a_study_over_torques_loosens() {
    let folder = tempfile::tempdir().unwrap();
    let text = super::study::STUDY
        .replace("torque = 4", "torque = [2, 4, 8]")
        .replace("[motion]", "[joint]\ndamping = \"linear\"\n[motion]");
    std::fs::write(folder.path().join("study.toml"), text).unwrap();
    succeeds(
        &["predict", "study.toml", "-o", "beam.joint.json"],
        folder.path(),
    );
    succeeds(
        &["export", "beam.joint.json", "-o", "beam.fmu", "--as", "lap"],
        folder.path(),
    );
    let checked = succeeds(&["check", "beam.fmu"], folder.path());
    assert!(checked.contains("no problem found"), "{checked}");
}

#[test]
fn the_document_is_what_the_command_writes() {
    let folder = tempfile::tempdir().unwrap();
    let written = succeeds(
        &["reproduce", "kavi", "--markdown", "--figure", "kavi.svg"],
        folder.path(),
    );
    let docs = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs");
    assert_eq!(
        written,
        std::fs::read_to_string(docs.join("kavi.md")).unwrap()
    );
    let figure = std::fs::read_to_string(folder.path().join("kavi.svg")).unwrap();
    assert_eq!(
        figure,
        std::fs::read_to_string(docs.join("images/kavi.svg")).unwrap()
    );
}

#[test]
fn kavi_stands_alone() {
    #[rustfmt::skip]
    let cases = [
        (["reproduce", "kavi", "4.6"].as_slice(), "kavi: found 1 tables beside it"),
        (["reproduce", "pirdayr", "--figure", "x.svg"].as_slice(), "--figure"),
    ];
    for (arguments, expected) in cases {
        let output = run(arguments, Path::new("."));
        assert_eq!(output.status.code(), Some(1));
        let message = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(message.contains(expected), "{message}");
    }
    let json = succeeds(&["reproduce", "kavi", "--json"], Path::new("."));
    let json: serde_json::Value = serde_json::from_str(&json).unwrap();
    assert_eq!(json["specimens"].as_array().unwrap().len(), 22);
    let claims = json["claims"].as_array().unwrap();
    let opposite = claims.iter().filter(|claim| claim["verdict"] == "opposite");
    assert_eq!(opposite.count(), 1);
}
