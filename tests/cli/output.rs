//! Where results go: files whole or not at all, JSON that a program can read, streams that may be closed.

use std::fs;
use std::process::Stdio;

use bolted_joint_testing::has;

use crate::bench::{Bench, Outcome};
use crate::joint_file::JOINT;
use crate::rig;

const IDENTIFY: &str = "identify study.toml -o";

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
        bench.refused(&format!("{IDENTIFY} {output}"), &fragments);
        bench.refused(&format!("export j.joint.json -o {output}"), &fragments);
    }
    // The joint file is not written where the figure cannot be.
    for (figure, expected) in [
        ("missing/o.svg", ["missing/o.svg: cannot be written", ""]),
        ("o.png", ["--figure: found o.png", "ends in .svg"]),
    ] {
        let command = format!("{IDENTIFY} o.joint.json --figure {figure}");
        bench.refused(&command, &expected);
    }
}

#[test]
fn a_joint_file_is_not_named_like_an_fmu_or_a_table() {
    let bench = bench();
    for output in ["o.fmu", "O.FMU", "o.csv", "other.toml"] {
        let found = format!("--output: found {output}");
        let fragments = [found.as_str(), "such as NAME.joint.json", "`export`"];
        bench.refused(&format!("{IDENTIFY} {output}"), &fragments);
        assert!(!bench.path(output).exists());
    }
}

#[test]
fn an_input_is_never_overwritten() {
    let bench = bench();
    let expected = ["same file as study.toml", "a name of its own"];
    bench.refused(&format!("{IDENTIFY} ./study.toml"), &expected);
    let expected = ["same file as j.joint.json"];
    bench.refused("export j.joint.json -o ./j.joint.json", &expected);
    let both = format!("{IDENTIFY} o.svg --figure o.svg");
    bench.refused(&both, &["same file as o.svg"]);
}

#[test]
fn an_error_leaves_the_old_output_alone_and_success_replaces_it() {
    let bench = bench();
    bench.write("o.joint.json", "old");
    bench.write("o.fmu", "old");
    let study = bench.text("study.toml");
    bench.edit("study.toml", "from = 2", "from = 900");
    bench.refused(&format!("{IDENTIFY} o.joint.json"), &["`frequency`"]);
    bench.refused(
        "export study.toml -o o.fmu",
        &[
            "study.toml: found a study of method",
            "expected a joint file (JSON)",
        ],
    );
    bench.write("study.toml", study);
    bench.done(&format!("{IDENTIFY} o.joint.json"));
    bench.done("export j.joint.json -o o.fmu");
    assert_eq!(bench.json("o.joint.json")["format"], "bolted-joint/1");
    assert!(fs::read(bench.path("o.fmu")).unwrap().starts_with(b"PK"));
    let names = "a.uff b.uff c.uff j.joint.json o.fmu o.joint.json study.toml";
    assert_eq!(bench.names().join(" "), names);
}

fn keys(value: &serde_json::Value) -> String {
    let keys: Vec<&String> = value.as_object().unwrap().keys().collect();
    keys.iter().map(|key| format!(" {key}")).collect()
}

#[test]
fn json_has_its_keys() {
    let bench = bench();
    let command = format!("{IDENTIFY} o.joint.json --json");
    let identified = bench.done(&command).json();
    assert_eq!(
        keys(&identified),
        " output figure report joint_file bolts starts lines reduced_chi_squared budget usable reasons_against warnings models torques models_not_compared"
    );
    assert_eq!(identified["joint_file"], bench.json("o.joint.json"));
    assert_eq!(identified["output"], "o.joint.json");

    let exported = bench
        .done("export j.joint.json -o o.fmu --as lap --json")
        .json();
    assert_eq!(
        keys(&exported),
        " output fmi_version interface model_name token step_size_max_s step_error escape_amplitude platforms entries passive"
    );
    assert_eq!(exported["interface"], "lap");
    assert_eq!(exported["model_name"], "two bodies");
    assert_eq!(exported["passive"], true);
    assert!(exported["step_size_max_s"].as_f64().unwrap() > 0.0);
    assert_eq!(exported["entries"][0]["path"], "modelDescription.xml");

    let of_fmu = " platforms step_size_max run";
    for (file, of_fmu) in [("j.joint.json", ""), ("o.fmu", of_fmu)] {
        let checked = bench.done(&format!("check {file} --json")).json();
        let of_all = " file kind sound facts messages findings usable reasons_against";
        assert_eq!(keys(&checked), of_all.to_owned() + of_fmu);
        assert_eq!(checked["file"], file);
        assert_eq!(checked["sound"], true);
    }
    bench.edit(
        "j.joint.json",
        "[[6, 0.05], [0.05, 0.02]]",
        "[[-6, 0], [0, 0.02]]",
    );
    let outcome = bench.fails("check j.joint.json --json", &[]);
    assert_eq!(outcome.json()["sound"], false);
    assert_eq!(outcome.json()["findings"].as_array().unwrap().len(), 1);
}

#[test]
fn an_error_with_json_leaves_stdout_empty() {
    let bench = bench();
    bench.refused("identify no.toml -o o.json --json", &["no.toml"]);
    bench.refused("export no.json -o o.fmu --json", &["no.json"]);
    bench.refused("check no.json --json", &["no.json"]);
}

/// Runs a command with one stream closed at its other end before anything is written.
#[cfg(unix)]
fn exit_code_with_closed(bench: &Bench, arguments: &str, stderr_too: bool) -> Option<i32> {
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
        "check j.joint.json",
        "check j.joint.json --json",
        "export j.joint.json -o o.fmu",
        "identify study.toml -o o.joint.json --json",
        "--help",
    ] {
        for stderr_too in [false, true] {
            let code = exit_code_with_closed(&bench, arguments, stderr_too);
            assert_eq!(code, Some(0), "{arguments}");
        }
    }
    let code = exit_code_with_closed(&bench, "check missing", true);
    assert_eq!(code, Some(1));
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_an_error() {
    let bench = bench();
    let full = fs::File::options().write(true).open("/dev/full").unwrap();
    let mut command = bench.command("check j.joint.json");
    let outcome = Outcome::of(command.stdout(full).output().unwrap());
    assert_eq!(outcome.code, Some(1));
    has(&outcome.stderr, &["cannot be printed"]);
}

#[cfg(target_os = "linux")]
#[test]
fn a_name_that_is_no_text_is_as_good_as_any() {
    use std::os::unix::ffi::OsStrExt as _;
    let bench = bench();
    let name = std::ffi::OsStr::from_bytes(b"\xff.fmu");
    let mut command = bench.command("export j.joint.json --json -o");
    let outcome = Outcome::of(command.arg(name).output().unwrap());
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    assert!(fs::metadata(bench.path("").join(name)).is_ok());
}

#[test]
fn a_dash_is_standard_output_and_words_go_to_standard_error() {
    let bench = bench();
    let outcome = bench.done(&format!("{IDENTIFY} -"));
    let file: serde_json::Value = serde_json::from_str(&outcome.stdout).unwrap();
    assert_eq!(file["format"], "bolted-joint/1");
    has(&outcome.stderr, &["wrote to standard output"]);
    let outcome = bench.done("convert j.joint.json --to nastran -o -");
    assert!(
        outcome.stdout.starts_with("$ two bodies\n"),
        "{}",
        outcome.stdout
    );
    bench.done("export j.joint.json -o o.fmu");
    let fmu = bench.command("export j.joint.json -o -").output().unwrap();
    assert!(fmu.status.success() && fmu.stdout.starts_with(b"PK"));
    assert!(!bench.names().iter().any(|name| name == "-"));
    bench.refused(
        &format!("{IDENTIFY} - --report -"),
        &["-: found a second output", "one file alone"],
    );
}

#[cfg(unix)]
#[test]
fn a_read_only_file_is_not_replaced_and_a_link_is_told() {
    use std::os::unix::fs::PermissionsExt as _;
    let bench = bench();
    bench.write("o.joint.json", "kept");
    let mode = |mode| fs::Permissions::from_mode(mode);
    fs::set_permissions(bench.path("o.joint.json"), mode(0o444)).unwrap();
    let expected = ["o.joint.json: cannot be written", "the file is read-only"];
    bench.refused(&format!("{IDENTIFY} o.joint.json"), &expected);
    assert_eq!(bench.text("o.joint.json"), "kept");
    fs::set_permissions(bench.path("o.joint.json"), mode(0o644)).unwrap();
    std::os::unix::fs::symlink("o.joint.json", bench.path("link.json")).unwrap();
    let outcome = bench.done(&format!("{IDENTIFY} link.json"));
    has(
        &outcome.stderr,
        &["link.json is a link and stays one: o.joint.json is written"],
    );
    assert_ne!(bench.text("o.joint.json"), "kept");
    // also one that leads to no file yet
    std::os::unix::fs::symlink("new.json", bench.path("to.json")).unwrap();
    let outcome = bench.done(&format!("{IDENTIFY} to.json"));
    has(
        &outcome.stderr,
        &["to.json is a link and stays one: new.json is written"],
    );
    assert!(
        fs::symlink_metadata(bench.path("to.json"))
            .unwrap()
            .is_symlink()
    );
    assert!(bench.path("new.json").is_file());
    // nothing is told of one that is not written
    std::os::unix::fs::symlink("study.toml", bench.path("input.json")).unwrap();
    let refused = bench.run(&format!("{IDENTIFY} input.json"));
    assert!(
        refused.code == Some(1) && !refused.stderr.contains("is written"),
        "{}",
        refused.stderr
    );
}

#[cfg(unix)]
#[test]
fn a_pipe_is_told_from_an_empty_file() {
    let bench = bench();
    for command in [
        "show",
        "check",
        "compare j.joint.json",
        "export -o o.fmu",
        "convert --to nastran -o o.bdf",
        "identify -o o.json",
    ] {
        let mut words = command.split_whitespace();
        let name = words.next().unwrap_or_default();
        let mut run = bench.command(&format!("{name} /dev/stdin"));
        run.args(words).stdin(fs::File::open("/dev/null").unwrap());
        let refused = Outcome::of(run.output().unwrap());
        assert_eq!(refused.code, Some(1), "{command}: {}", refused.stderr);
        has(
            &refused.stderr,
            &[
                "/dev/stdin: found a pipe or a device",
                "save it as a file first",
            ],
        );
    }
}

#[test]
fn nothing_is_written_where_the_report_cannot_be() {
    let bench = bench();
    fs::create_dir(bench.path("closed")).unwrap();
    bench.refused(
        &format!("{IDENTIFY} o.joint.json --report closed"),
        &["--report: found closed"],
    );
    assert!(!bench.names().iter().any(|name| name == "o.joint.json"));
}
