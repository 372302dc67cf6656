//! Where results go: files whole or not at all, JSON that a program can read, streams that may be closed.

use std::fs;
use std::process::Stdio;

use crate::bench::{Bench, replaced};
use crate::joint_file::JOINT;
use crate::rig;

const IDENTIFY: [&str; 3] = ["identify", "study.toml", "-o"];

/// A bench with a study and a joint file.
fn bench() -> Bench {
    let bench = rig::ready();
    bench.write("j.joint.json", JOINT);
    bench
}

#[test]
fn outputs_that_cannot_be_written_are_refused() {
    let bench = bench();
    fs::create_dir(bench.path("folder")).unwrap();
    for output in ["missing/o", "folder", "study.toml/o"] {
        let fragment = format!("{output}: cannot be written");
        let fragments = [fragment.as_str(), "give a path in a folder that exists"];
        bench.refused(&[&IDENTIFY[..], &[output]].concat(), &fragments);
        bench.refused(&["export", "j.joint.json", "-o", output], &fragments);
    }
    // The joint file is not written where the figure cannot be.
    let figure = ["o.joint.json", "--figure", "missing/o.svg"];
    bench.refused(
        &[&IDENTIFY[..], &figure].concat(),
        &["missing/o.svg: cannot be written"],
    );
    let figure = ["o.joint.json", "--figure", "o.png"];
    bench.refused(
        &[&IDENTIFY[..], &figure].concat(),
        &["--figure: found o.png", "ends in .svg"],
    );
}

#[test]
fn an_input_is_never_overwritten() {
    let bench = bench();
    bench.refused(
        &[&IDENTIFY[..], &["./study.toml"]].concat(),
        &["same file as study.toml", "a name of its own"],
    );
    bench.refused(
        &["export", "j.joint.json", "-o", "./j.joint.json"],
        &["same file as j.joint.json"],
    );
    let both = ["o.svg", "--figure", "o.svg"];
    bench.refused(&[&IDENTIFY[..], &both].concat(), &["same file as o.svg"]);
}

#[test]
fn an_error_leaves_the_old_output_alone_and_success_replaces_it() {
    let bench = bench();
    bench.write("o.joint.json", "old");
    bench.write("o.fmu", "old");
    let study = bench.text("study.toml");
    bench.write("study.toml", replaced(&study, "from = 2", "from = 900"));
    bench.refused(
        &[&IDENTIFY[..], &["o.joint.json"]].concat(),
        &["`frequency`"],
    );
    bench.refused(&["export", "study.toml", "-o", "o.fmu"], &["is not JSON"]);
    bench.write("study.toml", study);
    bench.done(&[&IDENTIFY[..], &["o.joint.json"]].concat());
    bench.done(&["export", "j.joint.json", "-o", "o.fmu"]);
    assert_eq!(bench.json("o.joint.json")["format"], "bolted-joint/1");
    assert!(fs::read(bench.path("o.fmu")).unwrap().starts_with(b"PK"));
    let names = [
        "a.uff",
        "b.uff",
        "c.uff",
        "j.joint.json",
        "o.fmu",
        "o.joint.json",
        "study.toml",
    ];
    assert_eq!(bench.names(), names);
}

fn keys(value: &serde_json::Value) -> Vec<&str> {
    value
        .as_object()
        .unwrap()
        .keys()
        .map(String::as_str)
        .collect()
}

#[test]
fn json_has_its_keys() {
    let bench = bench();
    let identified = bench
        .done(&[&IDENTIFY[..], &["o.joint.json", "--json"]].concat())
        .json();
    assert_eq!(
        keys(&identified),
        [
            "output",
            "figure",
            "report",
            "joint_file",
            "bolts",
            "starts",
            "reduced_chi_squared",
            "warnings",
            "models",
            "torques",
            "models_not_compared"
        ]
    );
    assert_eq!(identified["joint_file"], bench.json("o.joint.json"));
    assert_eq!(identified["output"], "o.joint.json");

    let exported = bench
        .done(&[
            "export",
            "j.joint.json",
            "-o",
            "o.fmu",
            "--as",
            "lap",
            "--json",
        ])
        .json();
    assert_eq!(
        keys(&exported),
        [
            "output",
            "fmi_version",
            "interface",
            "model_name",
            "token",
            "step_size_max_s",
            "escape_amplitude",
            "platforms",
            "entries",
            "passive"
        ]
    );
    assert_eq!(exported["interface"], "lap");
    assert_eq!(exported["model_name"], "two bodies");
    assert_eq!(exported["passive"], true);
    assert!(exported["step_size_max_s"].as_f64().unwrap() > 0.0);
    assert_eq!(exported["entries"][0]["path"], "modelDescription.xml");

    for (file, of_fmu) in [
        ("j.joint.json", &[][..]),
        ("o.fmu", &["platforms", "step_size_max", "run"]),
    ] {
        let checked = bench.done(&["check", file, "--json"]).json();
        let of_all = ["file", "kind", "sound", "facts", "messages", "findings"];
        assert_eq!(keys(&checked), [&of_all, of_fmu].concat());
        assert_eq!(
            (&checked["file"], &checked["sound"]),
            (&file.into(), &true.into())
        );
    }
    bench.write(
        "active.joint.json",
        replaced(JOINT, "[[6, 0.05], [0.05, 0.02]]", "[[-6, 0], [0, 0.02]]"),
    );
    let outcome = bench.run(&["check", "active.joint.json", "--json"]);
    assert_eq!(outcome.code, Some(1));
    assert_eq!(outcome.json()["sound"], false);
    assert_eq!(outcome.json()["findings"].as_array().unwrap().len(), 1);
}

#[test]
fn an_error_with_json_leaves_stdout_empty() {
    let bench = bench();
    bench.refused(
        &["identify", "no.toml", "-o", "o.json", "--json"],
        &["no.toml"],
    );
    bench.refused(
        &["export", "no.json", "-o", "o.fmu", "--json"],
        &["no.json"],
    );
    bench.refused(&["check", "no.json", "--json"], &["no.json"]);
}

/// Runs a command with one stream closed at its other end before anything is written.
#[cfg(unix)]
fn exit_code_with_closed(bench: &Bench, arguments: &[&str], stderr_too: bool) -> Option<i32> {
    let (reader, writer) = std::io::pipe().unwrap();
    drop(reader);
    let mut command = bench.command(arguments);
    command.stdout(writer.try_clone().unwrap());
    command.stderr(if stderr_too {
        Stdio::from(writer)
    } else {
        Stdio::null()
    });
    command.status().unwrap().code()
}

#[cfg(unix)]
#[test]
fn streams_that_nobody_reads_do_not_matter() {
    let bench = bench();
    for arguments in [
        ["check", "j.joint.json"].as_slice(),
        &["check", "j.joint.json", "--json"],
        &["export", "j.joint.json", "-o", "o.fmu"],
        &["identify", "study.toml", "-o", "o.joint.json", "--json"],
        &["--help"],
    ] {
        for stderr_too in [false, true] {
            assert_eq!(
                exit_code_with_closed(&bench, arguments, stderr_too),
                Some(0),
                "{arguments:?}"
            );
        }
    }
    assert_eq!(
        exit_code_with_closed(&bench, &["check", "missing"], true),
        Some(1)
    );
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_an_error() {
    let bench = bench();
    let full = fs::File::options().write(true).open("/dev/full").unwrap();
    let output = bench
        .command(&["check", "j.joint.json"])
        .stdout(full)
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(1));
    assert!(
        String::from_utf8(output.stderr)
            .unwrap()
            .contains("cannot be printed")
    );
}

#[cfg(target_os = "linux")]
#[test]
fn a_name_that_is_no_text_is_as_good_as_any() {
    use std::os::unix::ffi::OsStrExt as _;
    let bench = bench();
    let name = std::ffi::OsStr::from_bytes(b"\xff.fmu");
    let output = bench
        .command(&["export", "j.joint.json", "--json", "-o"])
        .arg(name)
        .output()
        .unwrap();
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    assert!(fs::metadata(bench.path("").join(name)).is_ok());
}
