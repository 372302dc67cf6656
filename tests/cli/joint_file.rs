//! Joint files that are wrong are refused by `export` and `check` alike, with one message.

use crate::bench::{Bench, PNG, replaced};

pub(crate) const JOINT: &str = include_str!("../data/joint/two-bodies.joint.json");

/// Both commands that read a joint file.
const COMMANDS: [&str; 2] = [
    "check j.joint.json",
    "export j.joint.json -o o.fmu --as lap",
];

#[test]
fn what_is_no_joint_file_is_said_to_be_none() {
    let bench = Bench::new();
    let cut = JOINT.find(", 0.05], [").unwrap();
    for command in COMMANDS {
        bench.refused(command, &["j.joint.json: cannot be read", "give the path"]);
    }
    #[rustfmt::skip]
    let cases = [
        (b"".as_slice(), ["j.joint.json: found an empty file", "expected a joint file"]),
        (b"\n\n", ["j.joint.json: found an empty file", "expected a joint file"]),
        (PNG, ["j.joint.json: found bytes that are no text", "JSON text in UTF-8"]),
        (JOINT.split_at(cut).0.as_bytes(), ["j.joint.json:7:", "the file ends too early, in joint.damping"]),
        (b"method = 1\n", ["j.joint.json:1:1: is not JSON", "give the NAME.joint.json"]),
        (b"[]", ["found a list, expected an object", "give the NAME.joint.json"]),
        (b"\n[[1.0, 2.0],\n", ["found a list, expected an object", "give the NAME.joint.json"]),
        (b"[{\"format\": \"bolted-joint/1\"}]", ["found a list, expected an object", "take the joint file that is in it out of the brackets"]),
        (b"[frequency]\nfrom = 1\n", ["found the table header [frequency] of TOML", "give the NAME.joint.json"]),
        (b"{}", ["j.joint.json:1:2: format: not found", "add it"]),
    ];
    for command in COMMANDS {
        bench.refused_contents(command, "j.joint.json", &cases);
    }
}

#[test]
fn every_wrong_entry_is_named() {
    let bench = Bench::new();
    #[rustfmt::skip]
    let cases = [
        ("bolted-joint/1", "bolted-joint/9", ["format: found \"bolted-joint/9\"", "expected \"bolted-joint/1\""]),
        ("\"two bodies\"", "\"\"", ["name: found \"\"", "one line of text"]),
        ("\"cubic\"", "\"qubic\"", [":8:11: joint.qubic: unknown key", "did you mean \"cubic\"?"]),
        ("\"bodies\"", "\"bodys\"", [":10:9: bodys: unknown key", "did you mean \"bodies\"?"]),
        ("\"a\": { \"inertia\"", "\"a\": { \"innertia\"", [": bodies.a.innertia: unknown key", "did you mean \"inertia\"?"]),
        ("[\"y\", \"theta\"]", "[\"theta\", \"y\"]", ["joint.dofs: found [\"theta\", \"y\"]", "expected [\"y\"] or [\"y\", \"theta\"]"]),
        ("[[8e4, 600], [600, 120]]", "[[8e4]]", ["joint.stiffness: found 1 entry", "expected 2, one for each of joint.dofs"]),
        ("[[8e4, 600], [600, 120]]", "[[8e4, 600], [600]]", ["joint.stiffness[1]: found 1 entry", "expected 2"]),
        ("[[8e4, 600], [600, 120]]", "8e4", ["joint.stiffness: found 80000.0", "expected a list"]),
        ("\"cubic\": [0, 0]", "\"cubic\": [0, 0], \"cubic\": [0, 1]", ["joint.cubic: found twice", "take one of them out"]),
        ("8e4, 600", "\"8e4\", 600", [":6:", "joint.stiffness[0][0]: found string \"8e4\", expected a number"]),
        ("8e4, 600", "1e999, 600", [":6:", "joint.stiffness[0][0]: found 1e999, expected a finite number"]),
        ("8e4, 600", "NaN, 600", [":6:", "joint.stiffness[0][0]: found NaN, expected a finite number"]),
        ("[600, 120]", "[601, 120]", ["joint.stiffness: found 600.0 at [0][1] and 601.0 at [1][0]", "give both entries the same value"]),
        ("\"inertia\": [1.2, 8e-3]", "\"inertia\": [1.2, 0]", ["bodies.a.inertia[1]: found 0.0", "greater than zero"]),
        ("\"damping\": [3, 0.01]", "\"damping\": [-3, 0.01]", ["bodies.a.damping[0]: found -3.0", "zero or more"]),
        ("\"cubic\": [0, 0]", "\"cubic\": [0]", ["joint.cubic: found 1 entry", "expected 2"]),
        ("    \"damping\": [[6, 0.05], [0.05, 0.02]],\n", "", ["joint.damping: not found", "a symmetric matrix"]),
    ];
    for command in COMMANDS {
        bench.refused_edits(command, ("j.joint.json", JOINT), &cases);
    }
}

#[test]
fn several_faults_are_told_at_once() {
    let bench = Bench::new();
    bench.write("j.joint.json", replaced(JOINT, "[600, 120]", "[601, 120]"));
    bench.edit("j.joint.json", "\"cubic\": [0, 0]", "\"cubic\": [0]");
    let both = ["joint.stiffness: found 600.0", "joint.cubic: found 1 entry"];
    bench.refused(COMMANDS[0], &both);
}
