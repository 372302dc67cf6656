//! `demo`: the main job on built-in data, and its study as a user's first own one.

use crate::bench::Bench;
use crate::rig::matrix_of;

/// Tol, MSc thesis, Table 5.3, "updated".
const STIFFNESS: [[f64; 2]; 2] = [[5.73e5, 5.82e3], [5.82e3, 1.29e3]];
const DAMPING: [[f64; 2]; 2] = [[10.83, -0.83], [-0.83, 0.083]];

/// Every entry lies within five of the standard deviations that the file states, and those are small.
fn assert_published_joint(bench: &Bench, name: &str) {
    let file = bench.json(name);
    let deviations = &file["uncertainty"]["standard_deviation"];
    for (key, exact) in [("stiffness", STIFFNESS), ("damping", DAMPING)] {
        let found = matrix_of(&file, key);
        for (i, j) in [(0, 0), (0, 1), (1, 1)] {
            let deviation = deviations[key][i][j].as_f64().unwrap();
            let error = found[(i, j)] - exact[i][j];
            let place = format!("{key}[{i}][{j}]: {error} ± {deviation}");
            assert!(error.abs() < 5.0 * deviation, "{place}");
            assert!(deviation < 0.03 * exact[i][j].abs(), "{place}");
        }
    }
}

#[test]
fn the_demo_and_its_study_give_the_published_joint() {
    let bench = Bench::new();
    let outcome = bench.done("demo -o d --seed 7");
    assert!(outcome.stdout.contains("NOT measured"));
    assert_published_joint(&bench, "d/m10x16.joint.json");
    for name in [
        "m10x16-element.fmu",
        "m10x16-lap.fmu",
        "pirdayr-ex03-lap.fmu",
    ] {
        assert!(outcome.stdout.contains(name));
        bench.done(&format!("check d/{name}"));
    }
    bench.done("identify d/study.toml -o o.joint.json --figure o.svg");
    assert_published_joint(&bench, "o.joint.json");
    assert!(bench.text("o.svg").trim_end().ends_with("</svg>"));
    assert_eq!(bench.names(), ["d", "o.joint.json", "o.svg"]);
}

#[test]
fn without_noise_the_published_joint_returns_to_the_digits_of_the_file() {
    let bench = Bench::new();
    bench.done("demo -o d --noise 0");
    let file = bench.json("d/m10x16.joint.json");
    for (key, exact) in [("stiffness", STIFFNESS), ("damping", DAMPING)] {
        let found = matrix_of(&file, key);
        for (i, j) in [(0, 0), (0, 1), (1, 1)] {
            let error = (found[(i, j)] / exact[i][j] - 1.0).abs();
            assert!(error < 1e-6, "{key}[{i}][{j}]: {error}");
        }
    }
}

#[test]
fn what_the_demo_cannot_do_is_refused_before_it_writes() {
    let bench = Bench::new();
    bench.write("taken", "a file");
    for noise in ["-0.1", "1", "nan", "inf"] {
        bench.refused(
            &format!("demo -o d --noise {noise}"),
            &["--noise: found", "0.01 for 1 %"],
        );
    }
    bench.refused("demo -o taken", &["taken: cannot be written"]);
    let mut command = bench.command("demo -o d");
    command.env("SOURCE_DATE_EPOCH", "yesterday");
    let expected = ["SOURCE_DATE_EPOCH: found \"yesterday\"", "unset it"];
    bench.refused_by(&mut command, &expected);
    assert_eq!(bench.names(), ["taken"]);
}
