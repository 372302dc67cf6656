//! What the estimate does beyond the simplest study: few functions, several assemblies, active joints, models beside each
//! other.

use bolted_joint_testing::has;
use nalgebra::matrix;

use crate::bench::Bench;
use crate::rig::{DIAGONAL, FULL, Joint, Quantity, matrix_of, measure, ready, study};

const IDENTIFY: [&str; 4] = ["identify", "study.toml", "-o", "o.joint.json"];

fn error(file: &serde_json::Value, exact: &Joint) -> f64 {
    let mut largest: f64 = 0.0;
    for (key, exact) in [("stiffness", exact.stiffness), ("damping", exact.damping)] {
        let found = matrix_of(file, key);
        for (i, j) in [(0, 0), (0, 1), (1, 1)] {
            let scale = (exact[(i, i)] * exact[(j, j)]).sqrt();
            largest = largest.max((found[(i, j)] - exact[(i, j)]).abs() / scale);
        }
    }
    largest
}

/// The functions of a file for which `keep` holds, by their place.
fn functions_of(text: &str, keep: impl Fn(usize) -> bool) -> String {
    let begin = "    -1\n    58\n";
    let functions = text.split(begin).skip(1).enumerate();
    functions
        .filter(|(index, _)| keep(*index))
        .map(|(_, function)| format!("{begin}{function}"))
        .collect()
}

#[test]
fn a_single_column_is_enough_and_decoupling_is_left_out_with_a_remark() {
    let bench = ready();
    // Responses at three points to the load at the last.
    let column = functions_of(&bench.text("c.uff"), |index| index % 3 == 2);
    bench.write("c.uff", column);
    let outcome = bench.done(&IDENTIFY);
    has(&outcome.stderr, &["no decoupling"]);
    let file = bench.json("o.joint.json");
    assert!(error(&file, &FULL) < 1e-6);
    assert_eq!(file["residual"]["functions"].as_array().unwrap().len(), 3);
}

#[test]
fn several_assemblies_of_one_joint_are_estimated_together() {
    let bench = ready();
    std::fs::copy(bench.path("c.uff"), bench.path("d.uff")).unwrap();
    let first = "[assembly]\nfrf = \"c.uff\"\npoints = [\"21:+Y\", \"22:+Y\", \"23:+Y\"]";
    let text = study("full", &[21, 22, 23]);
    assert!(text.contains(first));
    let several = text.replace(
        first,
        "[[assembly]]\nfrf = \"c.uff\"\npoints = [\"21:+Y\", \"22:+Y\"]\ntorque = 10\n\
         [[assembly]]\nfrf = \"d.uff\"\npoints = [\"22:+Y\", \"23:+Y\"]\ntorque = 20",
    );
    bench.write("study.toml", several);
    bench.done(&IDENTIFY);
    let file = bench.json("o.joint.json");
    assert!(error(&file, &FULL) < 1e-6);
    assert_eq!(
        file["validity"]["torque_n_m"],
        serde_json::json!([10.0, 20.0])
    );
    assert_eq!(file["residual"]["functions"].as_array().unwrap().len(), 8);
    let inputs = file["provenance"]["inputs"].as_array().unwrap();
    let names: Vec<&str> = inputs.iter().map(|i| i["file"].as_str().unwrap()).collect();
    assert_eq!(names, ["study.toml", "a.uff", "b.uff", "c.uff", "d.uff"]);
}

#[test]
fn an_active_estimate_is_reported_and_its_passive_neighbour_is_written() {
    // Tol's Table 5.4 is such a joint: coupling in the damping without damping of the rotation.
    let active = Joint {
        stiffness: FULL.stiffness,
        damping: matrix![6.0, 0.3; 0.3, 0.005],
    };
    let bench = Bench::new();
    measure(&bench, &active, [Quantity::Receptance; 3]);
    bench.write("study.toml", study("full", &[21, 22, 23]));
    let outcome = bench.done(&IDENTIFY);
    has(&outcome.stdout, &["free estimate"]);
    let file = bench.json("o.joint.json");
    let damping = matrix_of(&file, "damping");
    // On the boundary of the cone: singular, not negative.
    let ratio = damping[(0, 1)].powi(2) / (damping[(0, 0)] * damping[(1, 1)]);
    assert!((ratio - 1.0).abs() < 1e-12, "{ratio}");
    let free = &file["uncertainty"]["free_estimate"]["damping"];
    assert!((free[0][1].as_f64().unwrap() - 0.3).abs() < 1e-6);
    bench.done(&["export", "o.joint.json", "-o", "o.fmu"]);
}

#[test]
fn the_simplest_model_that_leaves_nothing_is_recommended() {
    let bench = Bench::new();
    measure(&bench, &DIAGONAL, [Quantity::Receptance; 3]);
    bench.write("study.toml", study("full", &[21, 22, 23]));
    let found = bench.done(&[&IDENTIFY[..], &["--json"]].concat()).json();
    // Exact data: both models fit to rounding, the translation alone does not.
    let compared = found["models"]["compared"].as_array().unwrap();
    let adequate: Vec<bool> = compared
        .iter()
        .map(|fit| fit["adequate"].as_bool().unwrap())
        .collect();
    assert_eq!(adequate, [false, true, true], "{compared:?}");
    assert_ne!(found["models"]["recommended"], "translation");
}

#[test]
fn a_bootstrap_is_reproducible_and_agrees_with_the_linear_theory() {
    let bench = Bench::new();
    bench.done(&["demo", "-o", "d", "--seed", "3"]);
    let text = bench.text("d/study.toml").replace("to = 512", "to = 150");
    bench.write("d/study.toml", text);
    let run = |name: &str| {
        let command = [
            "identify",
            "d/study.toml",
            "-o",
            name,
            "--bootstrap",
            "200",
            "--seed",
            "5",
        ];
        bench.done(&command);
        bench.json(name)["uncertainty"].clone()
    };
    let one = run("o.joint.json");
    assert_eq!(one, run("p.joint.json"));
    assert_eq!(one["bootstrap"]["converged"], 200);
    for key in ["stiffness", "damping"] {
        for (i, j) in [(0, 0), (0, 1), (1, 1)] {
            let of = |value: &serde_json::Value| value[key][i][j].as_f64().unwrap();
            let ratio =
                of(&one["bootstrap"]["standard_deviation"]) / of(&one["standard_deviation"]);
            // 200 draws know a standard deviation to 5 %.
            assert!((ratio - 1.0).abs() < 0.25, "{key}[{i}][{j}]: {ratio}");
        }
    }
}

#[test]
fn repeated_measurements_tell_the_noise() {
    let bench = Bench::new();
    for seed in ["1", "2", "3"] {
        bench.done(&["demo", "-o", &format!("d{seed}"), "--seed", seed]);
    }
    let identify = |name: &str| {
        bench.done(&["identify", "d1/study.toml", "-o", name]);
        bench.json(name)
    };
    let once = identify("o.joint.json");
    for seed in ["2", "3"] {
        let name = format!("assembly{seed}.uff");
        std::fs::copy(
            bench.path(&format!("d{seed}/assembly.uff")),
            bench.path(&format!("d1/{name}")),
        )
        .unwrap();
    }
    let text = bench.text("d1/study.toml").replace(
        "frf = \"assembly.uff\"",
        "frf = \"assembly.uff\"\nrepeats = [\"assembly2.uff\", \"assembly3.uff\"]",
    );
    bench.write("d1/study.toml", text);
    let thrice = identify("p.joint.json");
    // 1 % of noise, known from about 10⁵ residuals, and deviations smaller by √3.
    let level = thrice["residual"]["noise"]["relative"].as_f64().unwrap();
    assert!((level / 0.01 - 1.0).abs() < 0.01, "{level}");
    let deviation = |file: &serde_json::Value| {
        file["uncertainty"]["standard_deviation"]["stiffness"][0][0]
            .as_f64()
            .unwrap()
    };
    let gain = deviation(&once) / deviation(&thrice);
    assert!((gain / 3.0_f64.sqrt() - 1.0).abs() < 0.05, "{gain}");
}
