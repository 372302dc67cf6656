//! Assemblies tightened to different torques: a joint for each, over the torque in the joint file, and its export.

use bolted_joint_testing::has;
use std::fs;

use serde_json::{Value, json};

use crate::bench::{Bench, IDENTIFY};
use crate::rig::{ACTIVE, FULL, Joint, Quantity, measure, study};

/// Torques in the order of the assemblies, N·m, and how stiff the joint is beside `FULL`.
const TORQUES: [(f64, f64); 3] = [(20.0, 1.0), (10.0, 0.7), (25.0, 1.05)];

fn at(factor: f64) -> Joint {
    Joint {
        stiffness: FULL.stiffness * factor,
        damping: FULL.damping / factor,
    }
}

/// Exact measurements of an assembly for each torque, and their study.
fn ready(torques: &str) -> Bench {
    let bench = Bench::new();
    let mut assemblies = String::new();
    for (number, (torque, factor)) in TORQUES.into_iter().enumerate() {
        measure(&bench, &at(factor), [Quantity::Receptance; 3]);
        let file = format!("c{number}.uff");
        fs::rename(bench.path("c.uff"), bench.path(&file)).unwrap();
        assemblies += &format!(
            "[[assembly]]\nfrf = \"{file}\"\npoints = [\"21:+Y\", \"22:+Y\", \"23:+Y\"]\ntorque = {torque}\n\
             level = {{ force = {} }}\n",
            0.5 + number as f64
        );
    }
    let text = study("full", &[21, 22, 23]);
    let (before, after) = text.split_once("[assembly]").unwrap();
    let (_, after) = after.split_once("[joint]").unwrap();
    let after = after.replace("\"full\"", &format!("\"full\"\ntorques = \"{torques}\""));
    bench.write(
        "study.toml",
        format!("{before}{assemblies}\n[joint]{after}"),
    );
    bench
}

/// The table has the joint of `factor` at a place.
#[track_caller]
fn holds(table: &Value, place: usize, factor: f64) {
    let found =
        json!({ "stiffness": table["stiffness"][place], "damping": table["damping"][place] });
    let error = at(factor).error_of(&found);
    assert!(error < 1e-6, "{factor}: {error}");
}

#[test]
fn each_torque_has_its_joint_in_the_file_ascending() {
    let bench = ready("separate");
    let outcome = bench.done(IDENTIFY);
    has(
        &outcome.stdout,
        &[
            "at 20 N·m\n",
            "at 10 N·m\n",
            "joints over the torque by BIC: common +",
            "\"separate\" is the simplest adequate one",
        ],
    );
    let file = bench.json("o.joint.json");
    let table = &file["joint"]["over_preload"];
    assert_eq!(table["preload"], json!([10.0, 20.0, 25.0]));
    // The first assembly's torque is the nominal one.
    assert_eq!(table["nominal"], 20.0);
    assert_eq!(file["joint"]["stiffness"], Value::Null);
    assert_eq!(file["validity"]["torque_n_m"], json!([10.0, 25.0]));
    assert_eq!(file["validity"]["level"], "force 0.5 to 2.5 N amplitude");
    let uncertainty = &file["uncertainty"];
    for (place, factor) in [0.7, 1.0, 1.05].into_iter().enumerate() {
        holds(table, place, factor);
        let own = &uncertainty["over_preload"]["at"][place];
        assert_eq!(own["preload"], table["preload"][place]);
        let deviation = &own["standard_deviation"]["stiffness"][0][0];
        assert!(deviation.as_f64().unwrap() > 0.0);
    }
    let nominal = &uncertainty["over_preload"]["at"][1];
    for key in ["standard_deviation", "interval_95"] {
        assert_eq!(uncertainty[key], nominal[key]);
    }
    let correlation = &uncertainty["over_preload"]["correlation"];
    let names = correlation["unknowns"].as_array().unwrap();
    assert_eq!(names.len(), 18);
    assert_eq!([&names[0], &names[6]], ["k_yy@10", "k_yy@20"]);
    // A and B were measured once, so that their errors move the joints of all torques.
    let between = correlation["matrix"][0][6].as_f64().unwrap();
    assert!(between.abs() > 0.05 && between.abs() < 1.0, "{between}");
    let lines = file["residual"]["functions"].as_array().unwrap();
    assert_eq!(lines.len(), 27);
}

#[test]
fn an_export_is_at_one_preload() {
    let bench = ready("separate");
    bench.done(IDENTIFY);
    let table = bench.json("o.joint.json")["joint"]["over_preload"].clone();
    let start = |name: &str, key: &str| -> f64 {
        let text = bench.member(name, "resources/start.txt");
        let line = text
            .lines()
            .find_map(|line| line.strip_prefix(&format!("{key} ")));
        line.unwrap().parse().unwrap()
    };
    let outcome = bench.done("export o.joint.json -o nominal.fmu --preload 20");
    has(&outcome.stdout, &["two bodies, at 20 N·m"]);
    let entry =
        |place: usize, (i, j): (usize, usize)| table["stiffness"][place][i][j].as_f64().unwrap();
    assert_eq!(start("nominal.fmu", "joint.k_yy"), entry(1, (0, 0)));
    bench.done("export o.joint.json -o twelve.fmu --preload 12");
    for (key, place) in [("joint.k_yy", (0, 0)), ("joint.k_ytheta", (0, 1))] {
        // a monotone cubic from 10 to 20 N·m, 25 N·m being the next preload
        let values = [0, 1, 2].map(|preload| entry(preload, place));
        let [near, next] = [
            (values[1] - values[0]) / 10.0,
            (values[2] - values[1]) / 5.0,
        ];
        let first = ((25.0 * near - 10.0 * next) / 15.0)
            .clamp(f64::min(0.0, 3.0 * near), f64::max(0.0, 3.0 * near));
        let middle = if near * next > 0.0 {
            45.0 / (20.0 / near + 25.0 / next)
        } else {
            0.0
        };
        let hermite = [0.896, 0.128, 0.104, -0.032]; // at t = 0.2
        let expected = hermite[0] * values[0]
            + hermite[1] * 10.0 * first
            + hermite[2] * values[1]
            + hermite[3] * 10.0 * middle;
        let found = start("twelve.fmu", key);
        assert!((found / expected - 1.0).abs() < 1e-13, "{key} {found}");
    }
    bench.done("export o.joint.json -o highest.fmu --preload 25");
    assert_eq!(start("highest.fmu", "joint.k_yy"), entry(2, (0, 0)));
    for preload in ["9.99", "25.1", "-1", "nan"] {
        let expected = ["o.joint.json: preload: found", "expected 10.0 to 25.0 N·m"];
        let export = format!("export o.joint.json -o o.fmu --preload {preload}");
        bench.refused(&export, &expected);
    }
    // The FMU is sound in itself, and has the table that it was taken from beside the joint that it is.
    let checked = bench.done("check twelve.fmu");
    has(&checked.stdout, &["no problem found"]);
    let member = |name: &str| bench.member("twelve.fmu", name);
    let whole = member("resources/joint-over-preload.json");
    assert_eq!(whole, bench.text("o.joint.json"));
    let constant: Value = serde_json::from_str(&member("resources/joint.json")).unwrap();
    assert_eq!(constant["joint"]["over_preload"], Value::Null);
    assert_eq!(constant["validity"]["torque_n_m"], json!([10.0, 20.0]));
    let page = member("documentation/index.html");
    has(
        &page,
        &[
            "force 0.5 to 2.5 N amplitude",
            "interpolated between 10 and 20 N·m",
            "resources/joint-over-preload.json",
            "10 to 20 N·m",
        ],
    );
    let checked = bench.done("check o.joint.json");
    has(
        &checked.stdout,
        &["preloads: 10, 20, 25 N·m, nominal 20 N·m"],
    );
}

#[test]
fn a_joint_that_is_active_at_one_torque_is_passive_in_the_file() {
    let bench = ready("separate");
    measure(&bench, &ACTIVE, [Quantity::Receptance; 3]);
    fs::rename(bench.path("c.uff"), bench.path("c0.uff")).unwrap();
    let outcome = bench.done(IDENTIFY);
    has(&outcome.stdout, &["free estimate"]);
    let file = bench.json("o.joint.json");
    let table = &file["joint"]["over_preload"];
    let damping = &table["damping"][1];
    let entry = |i: usize, j: usize| damping[i][j].as_f64().unwrap();
    // On the boundary of the cone: singular, not negative.
    let ratio = entry(0, 1).powi(2) / (entry(0, 0) * entry(1, 1));
    assert!((ratio - 1.0).abs() < 1e-12, "{ratio}");
    let at = &file["uncertainty"]["over_preload"]["at"];
    let free = &at[1]["free_estimate"]["damping"];
    assert!((free[0][1].as_f64().unwrap() - 0.3).abs() < 1e-6);
    // That noise does not explain, so the others stay as they are.
    for (place, factor) in [(0, 0.7), (2, 1.05)] {
        assert_eq!(at[place]["free_estimate"], Value::Null);
        holds(table, place, factor);
    }
    has(&outcome.stdout, &["The free estimate is active at 20 N·m;"]);
    bench.done("export o.joint.json -o o.fmu");
}

#[test]
fn a_preload_is_refused_where_the_joint_has_none() {
    let bench = crate::rig::ready();
    bench.done(IDENTIFY);
    let expected = ["does not depend on the preload, expected none"];
    bench.refused("export o.joint.json -o o.fmu --preload 12", &expected);
}

#[test]
fn a_common_joint_of_different_joints_is_warned_of() {
    let bench = ready("common");
    let outcome = bench.done(IDENTIFY);
    let advice = "torques = \"separate\"";
    has(
        &outcome.stderr,
        &["the joint depends on the torque", advice],
    );
    let joint = &bench.json("o.joint.json")["joint"];
    assert_eq!(joint["over_preload"], Value::Null);
    let found = bench.done(&format!("{IDENTIFY} --json")).json();
    assert_eq!(found["torques"]["used"], "common");
    assert_eq!(found["torques"]["recommended"], "separate");
    let counts = found["torques"]["compared"].as_array().unwrap().iter();
    let counts: Vec<u64> = counts
        .map(|fit| fit["unknowns"].as_u64().unwrap())
        .collect();
    assert_eq!(counts, [6, 18]);
}

#[test]
fn torques_and_levels_that_cannot_be_are_refused() {
    let bench = ready("separate");
    let good = bench.text("study.toml");
    #[rustfmt::skip]
    let cases = [
        ("torque = 10\n", "", ["`joint.torques`", "no torque in 1 of 3 [[assembly]]"]),
        ("\"separate\"", "\"sometimes\"", ["unknown variant", "`common` or `separate`"]),
        ("{ force = 0.5 }", "{ force = 0.5, velocity = 1 }", ["`assembly.level`: found force = 0.5, velocity = 1", "exactly one"]),
        ("{ force = 0.5 }", "{ force = -1 }", ["found force = -1", "above zero"]),
        ("{ force = 0.5 }", "{ }", ["found no level", "`acceleration` (m/s²)"]),
        ("{ force = 0.5 }", "{ force = 0.5, measure = \"mean\" }", ["unknown variant `mean`", "rms"]),
    ];
    bench.refused_edits(IDENTIFY, ("study.toml", &good), &cases);
    let same = good
        .replace("torque = 10\n", "torque = 20\n")
        .replace("torque = 25\n", "torque = 20\n");
    bench.write("study.toml", same);
    bench.refused(IDENTIFY, &["`joint.torques`", "and one torque"]);
}

#[test]
fn levels_of_another_kind_are_told_one_by_one() {
    let bench = ready("separate");
    let other = "level = { acceleration = 2, measure = \"rms\" }";
    bench.edit("study.toml", "level = { force = 1.5 }", other);
    bench.done(IDENTIFY);
    assert_eq!(
        bench.json("o.joint.json")["validity"]["level"],
        "assembly 1: force 0.5 N amplitude; assembly 2: acceleration 2 m/s² r.m.s.; assembly 3: force 2.5 N amplitude"
    );
}

#[test]
fn the_report_shows_the_joint_over_the_torque() {
    let bench = ready("separate");
    let page = bench.report();
    has(
        &page,
        &[
            "<h2>Identified parameters</h2>\n<p>Each torque has a joint of its own",
            "id=\"over-torque\"",
            ">tightening torque, N·m</text>",
            "<h3>Dependence on the torque</h3>",
            "The joint depends on the torque.",
            "tightened to 20 N·m; force 0.5 N amplitude",
            "<th scope=\"row\">10 and 20 N·m</th>",
        ],
    );
    let figure = page.split("id=\"over-torque\"").nth(1).unwrap();
    let figure = figure.split("</figure>").next().unwrap();
    // Six unknowns, each with one line joining its three values.
    assert_eq!(figure.matches("stroke-dasharray").count(), 6);
}
