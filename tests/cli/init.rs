//! `init`: a first study from what is in a folder.

use bolted_joint_testing::has;

use crate::bench::Bench;

const MODES: &str = include_str!("../../examples/tol-m10x16/a-modes.toml");
const ASSEMBLY: &[u8] = include_bytes!("../../examples/tol-m10x16/assembly.uff");

#[test]
fn a_study_is_made_of_the_files_that_are_there() {
    let bench = Bench::new();
    bench.write("a-modes.toml", MODES);
    bench.write("b.uff", ASSEMBLY);
    bench.write("joined.uff", ASSEMBLY);
    bench.write("notes.md", "nothing");
    bench.write("zz.uff", b"    -1\n    58\nbroken");
    let outcome = bench.done("init");
    has(
        &outcome.stdout,
        &[
            "part a is taken to be a-modes.toml, part b b.uff, the assembly joined.uff",
            "not read: ./zz.uff",
            "look for CHECK",
            "wrote ./study.toml",
            "wrote ./bolted-joint.schema.json",
        ],
    );
    let text = bench.text("study.toml");
    assert!(text.starts_with("#:schema ./bolted-joint.schema.json\n"));
    let schema = bench.json("bolted-joint.schema.json");
    assert_eq!(
        schema["oneOf"][0]["properties"]["method"]["const"],
        "frf-decoupling"
    );
    assert_eq!(
        bench.done("init --schema").stdout,
        bench.text("bolted-joint.schema.json")
    );
    has(
        &text,
        &[
            "modal = \"a-modes.toml\"",
            "frf = \"b.uff\"",
            "frf = \"joined.uff\"",
            "points = [\"11:+Y\", \"12:+Y\", \"13:+Y\"]",
            "points: 1:+Y 2:+Y 3:+Y",
            // no rotation of b was measured
            "model = \"translation\"",
        ],
    );
    // it is a study that every command understands
    let shown = bench.done("show study.toml").stdout;
    has(
        &shown,
        &[
            "study of method \"frf-decoupling\"",
            "assembly.frf = joined.uff: a universal file",
            "frequency.from",
        ],
    );
    let refused = bench.run("identify study.toml -o o.joint.json");
    assert!(
        !refused.stderr.contains("unknown field") && !refused.stderr.contains("TOML parse"),
        "{}",
        refused.stderr
    );
    bench.refused(
        "init",
        &["--output: found ./study.toml", "there is one already"],
    );
    bench.done("init -o other.toml");
    has(
        &bench.done("init -o -").stdout,
        &["method = \"frf-decoupling\""],
    );
    assert!(!bench.done("init -o -").stdout.contains("#:schema"));
}

#[test]
fn a_folder_without_measurements_is_said_to_be_one() {
    let bench = Bench::new();
    bench.refused(
        "init",
        &["found no such file", "expected measured functions"],
    );
    bench.write("a.uff", b"    -1\n    58\nbroken");
    bench.write("b.uff", ASSEMBLY);
    bench.refused("init", &["found b.uff", "a.uff"]);
    bench.refused(
        "init missing",
        &["missing: cannot be read", "give the folder"],
    );
}
