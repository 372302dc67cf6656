//! `identify` with lap models, from the command line.

use bolted_joint_testing::has;
use std::path::Path;
use std::process::{Command, Output};

fn run(arguments: &[&str], folder: &Path) -> Output {
    Command::new(env!("CARGO_BIN_EXE_bolted-joint"))
        .args(arguments)
        .current_dir(folder)
        .env("SOURCE_DATE_EPOCH", "0")
        .output()
        .unwrap()
}

#[test]
fn each_torque_with_its_own_bodies_gets_a_file_that_exports() {
    let folder = tempfile::tempdir().unwrap();
    let example = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/pirdayr-update/study.toml");
    let example = example.to_str().unwrap();
    let output = run(
        &[
            "identify",
            example,
            "-o",
            "x.joint.json",
            "--report",
            "x.html",
            "--figure",
            "x.svg",
        ],
        folder.path(),
    );
    let (out, errors) = (
        String::from_utf8_lossy(&output.stdout),
        String::from_utf8_lossy(&output.stderr),
    );
    assert!(output.status.success(), "{errors}");
    has(
        &out,
        &[
            "wrote x.8Nm.joint.json",
            "not identified: k, m, k12, c, c12, kN",
        ],
    );
    has(
        &errors,
        &[
            "no parameters within the bounds",
            "c, c12, kN cannot be identified",
        ],
    );
    let page = std::fs::read_to_string(folder.path().join("x.html")).unwrap();
    has(
        &page,
        &[
            "Convergence of the fireflies",
            "not identifiable, at its prior",
        ],
    );
    for torque in [2, 4, 6, 8] {
        let file = format!("x.{torque}Nm.joint.json");
        let exported = run(
            &["export", &file, "-o", "x.fmu", "--as", "lap"],
            folder.path(),
        );
        assert!(
            exported.status.success(),
            "{}",
            String::from_utf8_lossy(&exported.stderr)
        );
    }
    let refused = run(
        &[
            "identify",
            example,
            "-o",
            "y.joint.json",
            "--bootstrap",
            "9",
        ],
        folder.path(),
    );
    assert_eq!(refused.status.code(), Some(1));
}

#[test]
fn the_document_is_what_the_command_writes() {
    let output = run(&["reproduce", "pirdayr", "--markdown"], Path::new("."));
    assert!(output.status.success());
    let written = String::from_utf8(output.stdout).unwrap();
    let document = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/pirdayr.md");
    assert_eq!(written, std::fs::read_to_string(document).unwrap());
}
