//! What the estimate does beyond the simplest study: few functions, several assemblies, active joints, models beside each
//! other.

use bolted_joint_testing::has;

use crate::bench::{Bench, IDENTIFY};
use crate::rig::{self, ACTIVE, DIAGONAL, FULL, functions_of, matrix_of, ready};

#[test]
fn a_single_column_is_enough_and_decoupling_is_left_out_with_a_remark() {
    let bench = ready();
    // Responses at three points to the load at the last.
    let column = functions_of(&bench.text("c.uff"), |index| index % 3 == 2);
    bench.write("c.uff", column);
    let outcome = bench.done(IDENTIFY);
    has(&outcome.stderr, &["no decoupling"]);
    FULL.is_in(&bench);
    let file = bench.json("o.joint.json");
    assert_eq!(file["residual"]["functions"].as_array().unwrap().len(), 3);
}

#[test]
fn several_assemblies_of_one_joint_are_estimated_together() {
    let bench = ready();
    std::fs::copy(bench.path("c.uff"), bench.path("d.uff")).unwrap();
    let first = "[assembly]\nfrf = \"c.uff\"\npoints = [\"21:+Y\", \"22:+Y\", \"23:+Y\"]";
    let several = "[[assembly]]\nfrf = \"c.uff\"\npoints = [\"21:+Y\", \"22:+Y\"]\ntorque = 10\n\
                   [[assembly]]\nfrf = \"d.uff\"\npoints = [\"22:+Y\", \"23:+Y\"]\ntorque = 20";
    bench.edit("study.toml", first, several);
    bench.done(IDENTIFY);
    FULL.is_in(&bench);
    let file = bench.json("o.joint.json");
    let torques = &file["validity"]["torque_n_m"];
    assert_eq!(*torques, serde_json::json!([10.0, 20.0]));
    assert_eq!(file["residual"]["functions"].as_array().unwrap().len(), 8);
    let inputs = file["provenance"]["inputs"].as_array().unwrap();
    let names: Vec<&str> = inputs.iter().map(|i| i["file"].as_str().unwrap()).collect();
    assert_eq!(names, ["study.toml", "a.uff", "b.uff", "c.uff", "d.uff"]);
}

#[test]
fn an_active_estimate_is_reported_and_its_passive_neighbour_is_written() {
    let bench = rig::of(&ACTIVE, "full");
    let outcome = bench.done(IDENTIFY);
    has(&outcome.stdout, &["free estimate"]);
    let file = bench.json("o.joint.json");
    let damping = matrix_of(&file, "damping");
    // On the boundary of the cone: singular, not negative.
    let ratio = damping[(0, 1)].powi(2) / (damping[(0, 0)] * damping[(1, 1)]);
    assert!((ratio - 1.0).abs() < 1e-12, "{ratio}");
    let free = &file["uncertainty"]["free_estimate"]["damping"];
    assert!((free[0][1].as_f64().unwrap() - 0.3).abs() < 1e-6);
    // intervals are those of what is written
    for matrix in ["stiffness", "damping"] {
        let values = matrix_of(&file, matrix);
        let ends = |row: usize, column: usize| {
            let interval = &file["uncertainty"]["interval_95"][matrix][row][column];
            [0, 1].map(|end| interval[end].as_f64().unwrap())
        };
        for (row, column) in [(0, 0), (0, 1), (1, 1)] {
            let ([low, high], value) = (ends(row, column), values[(row, column)]);
            assert!(
                low <= value && value <= high,
                "{matrix} {value} in {low}…{high}"
            );
        }
    }
    bench.done("export o.joint.json -o o.fmu");
}

#[test]
fn the_simplest_model_that_leaves_nothing_is_recommended() {
    let bench = rig::of(&DIAGONAL, "full");
    let found = bench.done(&format!("{IDENTIFY} --json")).json();
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
    bench.done("demo -o d --seed 3");
    bench.edit("d/study.toml", "to = 512", "to = 150");
    let run = |name: &str| {
        let options = "--bootstrap 200 --seed 5";
        bench.done(&format!("identify d/study.toml -o {name} {options}"));
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
        bench.done(&format!("demo -o d{seed} --seed {seed}"));
    }
    let identify = |name: &str| {
        bench.done(&format!("identify d1/study.toml -o {name}"));
        bench.json(name)
    };
    let once = identify("o.joint.json");
    for seed in ["2", "3"] {
        let measured = bench.text(&format!("d{seed}/assembly.uff"));
        bench.write(&format!("d1/assembly{seed}.uff"), measured);
    }
    let once_measured = "frf = \"assembly.uff\"";
    let repeated = format!("{once_measured}\nrepeats = [\"assembly2.uff\", \"assembly3.uff\"]");
    bench.edit("d1/study.toml", once_measured, &repeated);
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
