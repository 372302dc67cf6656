//! Joints that are not to be relied on: they are written, and every command says so, with exit code 3.

use bolted_joint_testing::has;

use crate::bench::Bench;
use crate::joint_file::JOINT;

const STUDY: &str = include_str!("../../examples/tol-m10x16/study.toml");

/// The demo's study and data.
fn bench() -> Bench {
    let bench = Bench::new();
    bench.write("study.toml", STUDY);
    for name in ["a-modes.toml", "assembly.uff"] {
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/tol-m10x16");
        let contents = std::fs::read(format!("{folder}/{name}")).unwrap();
        bench.write(name, contents);
    }
    bench
}

const IDENTIFY: &str = "identify study.toml -o o.joint.json --report o.html";
const WRONG: &str = "not to be relied on";

/// Lengths in mm and moduli in GPa are no joint's fault, but nothing that comes of them is a joint.
#[test]
fn what_comes_of_a_slip_is_marked_wherever_it_goes() {
    let bench = bench();
    bench.edit("study.toml", "height = 0.006", "height = 0.06");
    let outcome = bench.run(IDENTIFY);
    assert_eq!(outcome.code, Some(3), "{}", outcome.stderr);
    has(&outcome.stdout, &["wrote o.joint.json", "wrote o.html"]);
    has(
        &outcome.stderr,
        &["error: o.joint.json: ", WRONG, "% off the model"],
    );
    let file = bench.json("o.joint.json");
    assert_eq!(file["status"]["usable"], false);
    has(
        &bench.text("o.html"),
        &[
            "Not to be relied on",
            "The residual in % is relative to each",
        ],
    );

    let checked = bench.run("check o.joint.json");
    assert_eq!(checked.code, Some(3));
    assert!(!checked.stdout.contains("no problem found"));
    has(&checked.stdout, &[WRONG]);
    assert_eq!(
        bench.run("check o.joint.json --json").json()["usable"],
        false
    );

    bench.fails("export o.joint.json -o o.fmu", &[WRONG, "--unusable"]);
    let outcome = bench.done("export o.joint.json -o o.fmu --unusable --allow-active");
    has(&outcome.stderr, &["warning: ", WRONG]);
    has(&bench.member("o.fmu", "documentation/index.html"), &[WRONG]);
    let checked = bench.run("check --no-run o.fmu");
    assert_eq!(checked.code, Some(3), "{}", checked.stderr);

    let outcome = bench.run("respond study.toml --joint o.joint.json -o o.csv");
    assert_eq!(outcome.code, Some(3), "{}", outcome.stderr);
    has(&outcome.stdout, &["wrote o.csv"]);
}

#[test]
fn numbers_that_no_test_has_are_refused_with_the_slip_they_look_like() {
    for (from, to, named) in [
        (
            "length = 0.221",
            "length = 221",
            "`b.beam.length`: found 221, expected a length in m, from 0.001 to 20 (is it in millimetres?)",
        ),
        ("height = 0.006", "height = 6", "`b.beam.height`: found 6"),
        ("width = 0.025", "width = 25", "`b.beam.width`: found 25"),
        (
            "youngs_modulus = 70e9",
            "youngs_modulus = 70",
            "in GPa or MPa?",
        ),
        ("density = 2700", "density = 2.7", "in g/cm³ or t/mm³?"),
        (
            "spacing = 0.015",
            "spacing = 15",
            "spacing`: found 15, expected a distance in m, at most 2",
        ),
    ] {
        let bench = bench();
        bench.edit("study.toml", from, to);
        bench.fails(IDENTIFY, &["study.toml: ", named]);
    }
}

#[test]
fn machines_are_told_too() {
    let bench = bench();
    bench.edit("study.toml", "height = 0.006", "height = 0.06");
    let outcome = bench.run(&format!("{IDENTIFY} --json"));
    assert_eq!(outcome.code, Some(3));
    let value = outcome.json();
    assert_eq!(value["usable"], false);
    assert!(value["reasons_against"][0].is_string());
}

#[test]
fn a_good_joint_has_no_status() {
    let bench = bench();
    let outcome = bench.done(&format!("{IDENTIFY} --json"));
    assert_eq!(outcome.json()["usable"], true);
    assert!(bench.json("o.joint.json")["status"].is_null());
    assert!(!bench.text("o.html").contains("to be relied on"));
}

#[test]
fn a_status_that_contradicts_itself_is_refused() {
    let bench = Bench::new();
    let name = r#""name": "#;
    for (status, found) in [
        (r#"{ "usable": false }"#, "usable = false with 0 reasons"),
        (
            r#"{ "usable": true, "reasons": ["no"] }"#,
            "usable = true with 1 reasons",
        ),
        (
            r#"{ "usable": false, "reasons": ["a\nb"] }"#,
            "one line of text each",
        ),
        (r#"{ "reasons": ["a"] }"#, "usable"),
    ] {
        let text = JOINT.replacen(name, &format!(r#""status": {status}, {name}"#), 1);
        bench.write("o.joint.json", text);
        bench.fails("check o.joint.json", &["o.joint.json", found]);
    }
}
