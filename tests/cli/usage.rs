//! The command line itself: help, version, and what is wrong usage.

use crate::bench::Bench;
use bolted_joint_testing::has;

#[test]
fn wrong_usage_ends_with_2() {
    let bench = Bench::new();
    for arguments in [
        "",
        "weld",
        "identify",
        "identify study.toml",
        "identify study.toml -o",
        "identify study.toml -o o.json --seed 1",
        "export o.joint.json",
        "export o.joint.json -o o.fmu --as spring",
        "export o.joint.json -o o.fmu --fmi 1",
        "export o.joint.json -o o.fmu --step-size-max small",
        "export o.joint.json -o o.fmu --as lap --step-error 1e-6 --step-size-max 1e-5",
        "export -o o.fmu",
        "check",
        "check one two",
        "demo --seed -1",
        "demo --noise much",
    ] {
        let outcome = bench.run(arguments);
        assert_eq!(outcome.code, Some(2), "{arguments}");
        assert_eq!(outcome.stdout, "", "{arguments}");
        assert!(outcome.stderr.contains("Usage:") || outcome.stderr.contains("--help"));
    }
    assert!(bench.names().is_empty());
}

#[test]
fn help_says_what_each_command_needs() {
    let bench = Bench::new();
    #[rustfmt::skip]
    let cases = [
        ("--help", ["demo", "identify", "export", "check", "Exit codes"].as_slice()),
        ("demo --help", &["--output", "--seed", "--noise"]),
        ("identify --help", &["<STUDY>", "TOML", "--output", "--figure", "--json"]),
        ("export --help", &["<JOINT_FILE>", "--output", "element", "lap", "--step-size-max", "--platforms", "--allow-active"]),
        ("check --help", &["<FILE>", "Joint file, assembly file, FMU or SSP", "--json"]),
    ];
    for (arguments, fragments) in cases {
        let outcome = bench.done(arguments);
        has(&outcome.stdout, fragments);
        assert_eq!(outcome.stderr, "");
    }
    let version = bench.done("--version").stdout;
    let expected = format!("bolted-joint {}\n", env!("CARGO_PKG_VERSION"));
    assert_eq!(version, expected);
}

#[test]
fn shells_and_man_know_every_command() {
    let bench = Bench::new();
    for shell in ["bash", "zsh", "fish", "powershell"] {
        let text = bench.done(&format!("completions {shell}")).stdout;
        has(&text, &["identify", "convert", "at-rest"]);
    }
    bench.done("man .");
    let names = bench.names();
    for command in [
        "identify", "predict", "respond", "export", "show", "compare", "convert", "check",
    ] {
        assert!(
            names.contains(&format!("bolted-joint-{command}.1")),
            "{names:?}"
        );
    }
    has(&bench.text("bolted-joint.1"), &[".TH bolted", "Exit codes"]);
    assert!(!names.iter().any(|name| name.contains("run-library")));
    bench.done("man share/man/man1");
    assert!(bench.path("share/man/man1/bolted-joint.1").exists());
    bench.refused(
        "man bolted-joint.1/man1",
        &["cannot be written", "give a path"],
    );
    assert_eq!(bench.run("completions ksh").code, Some(2));
}

#[test]
fn misspelt_commands_and_keys_get_the_ones_that_were_meant() {
    let bench = Bench::new();
    has(&bench.run("identfy study.toml").stderr, &["identify"]);
    bench.write("s.toml", "method = \"frf-decoupling\"\nnane = \"x\"\n");
    bench.refused(
        "identify s.toml -o o.joint.json",
        &["unknown field `nane`", "did you mean `name`?"],
    );
}
