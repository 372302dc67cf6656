//! The commands `reproduce` and `respond` from the outside.

use bolted_joint_testing::has;
use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use bolted_joint::reproduce::PublishedTable;
use serde_json::Value;

fn bolted_joint(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_bolted-joint"))
        .args(arguments)
        .current_dir(folder)
        .output()
        .unwrap()
}

#[test]
fn reproduce_prints_published_and_obtained_values_for_people_and_machines() {
    let here = Path::new(".");
    let arguments = ["reproduce", "4.2", "--draws", "3", "--samples", "4096"];
    let output = bolted_joint(here, &arguments);
    assert!(output.status.success());
    let text = String::from_utf8(output.stdout).unwrap();
    has(
        &text,
        &[
            "published",
            "obtained",
            "2008",
            "Not given in the thesis",
            "Differences",
        ],
    );
    let output = bolted_joint(here, &[&arguments[..], &["--json"]].concat());
    let found: Value = serde_json::from_slice(&output.stdout).unwrap();
    let row = &found[0]["rows"][0];
    assert_eq!(found[0]["table"], "4.2");
    assert_eq!(
        (row["quantity"].as_str(), row["published"].as_f64()),
        (Some("k_yy"), Some(2008.0))
    );
    assert_eq!(row["obtained"]["draws"], 3);
    for refused in [
        ["reproduce", "4.1"].as_slice(),
        &["reproduce", "4.3", "--json", "--markdown"],
    ] {
        assert_eq!(bolted_joint(here, refused).status.code(), Some(2));
    }
}

#[test]
fn help_names_every_table() {
    let output = bolted_joint(Path::new("."), &["reproduce", "--help"]);
    let text = String::from_utf8(output.stdout).unwrap();
    for table in PublishedTable::ALL {
        assert!(text.contains(table.title()), "{table} in {text}");
        for name in [&[table.key()], table.aliases()].concat() {
            assert!(text.contains(name), "{name} in {text}");
        }
    }
}

#[test]
fn a_planned_test_identifies_the_joint_that_it_was_planned_with() {
    let folder = tempfile::tempdir().unwrap();
    let example = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/tol-m10x16");
    fs::copy(
        example.join("a-modes.toml"),
        folder.path().join("a-modes.toml"),
    )
    .unwrap();
    let study = fs::read_to_string(example.join("study.toml")).unwrap();
    let study = study.replace("\"assembly.uff\"", "\"plan.uff\"");
    fs::write(folder.path().join("study.toml"), study).unwrap();
    let joint = r#"{"format":"bolted-joint/1","name":"presumed","joint":{"dofs":["y","theta"],
        "stiffness":[[5.73e5,5.82e3],[5.82e3,1.29e3]],"damping":[[10.83,-0.83],[-0.83,0.083]]}}"#;
    fs::write(folder.path().join("presumed.joint.json"), joint).unwrap();
    let plan = |output: &str, noise: &[&str]| {
        let arguments = ["respond", "study.toml", "--joint", "presumed.joint.json"];
        let all = [&arguments[..], &["--step", "1", "-o", output], noise].concat();
        bolted_joint(folder.path(), &all)
    };
    let planned = plan("plan.uff", &["noise", "frf", "--level", "0.01"]);
    let text = String::from_utf8(planned.stdout).unwrap();
    assert!(planned.status.success());
    // The study names bands; they stay.
    has(&text, &["yy = [[330, 360]]  # as in the study"]);
    let found = bolted_joint(
        folder.path(),
        &["identify", "study.toml", "-o", "found.joint.json"],
    );
    assert!(
        found.status.success(),
        "{}",
        String::from_utf8_lossy(&found.stderr)
    );
    let found: Value =
        serde_json::from_slice(&fs::read(folder.path().join("found.joint.json")).unwrap()).unwrap();
    let stiffness = found["joint"]["stiffness"][0][0].as_f64().unwrap();
    assert!((stiffness / 5.73e5 - 1.0).abs() < 0.01, "{stiffness}");

    let exact = plan("plan.csv", &[]);
    assert!(exact.status.success());
    let table = fs::read_to_string(folder.path().join("plan.csv")).unwrap();
    let lines: Vec<&str> = table.lines().collect();
    // 5 to 512 Hz in steps of 1 Hz, nine functions of two columns.
    assert_eq!(
        (lines.len(), lines[0].split(',').count()),
        (1 + 508, 1 + 18)
    );
    assert!(lines[0].starts_with("frequency [Hz],11:+Y/11:+Y receptance real [m/N]"));
    let refused = plan("plan.csv", &["noise", "response", "--samples", "2"]);
    assert_eq!(refused.status.code(), Some(1));
}
