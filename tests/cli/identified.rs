//! Studies that are right lead to the joint that the data were made with.

use crate::bench::Bench;
use crate::rig::{DIAGONAL, FULL, Joint, Quantity, TRANSLATION, matrix_of, measure, study};

/// Largest deviation of the identified joint, each entry relative to √(m_ii m_jj) of its matrix.
fn deviation(bench: &Bench, joint: &Joint) -> f64 {
    let file = bench.json("o.joint.json");
    let mut largest: f64 = 0.0;
    for (key, exact) in [("stiffness", joint.stiffness), ("damping", joint.damping)] {
        let found = matrix_of(&file, key);
        for i in 0..found.nrows() {
            for j in 0..found.ncols() {
                let scale = (exact[(i, i)] * exact[(j, j)]).sqrt();
                largest = largest.max((found[(i, j)] - exact[(i, j)]).abs() / scale);
            }
        }
    }
    largest
}

fn identify(bench: &Bench) {
    bench.done(&["identify", "study.toml", "-o", "o.joint.json"]);
}

#[test]
fn every_model_at_one_two_and_three_points() {
    for (model, joint, dofs) in [
        ("translation", TRANSLATION, 1),
        ("diagonal", DIAGONAL, 2),
        ("full", FULL, 2),
    ] {
        let bench = Bench::new();
        measure(&bench, &joint, [Quantity::Receptance; 3]);
        for points in [[21, 22, 23].as_slice(), &[21, 23], &[23]] {
            bench.write("study.toml", study(model, points));
            identify(&bench);
            let error = deviation(&bench, &joint);
            assert!(error < 1e-6, "{model} at {points:?}: {error}");
            let file = bench.json("o.joint.json");
            assert_eq!(file["joint"]["dofs"].as_array().unwrap().len(), dofs);
            assert_eq!(file["provenance"]["model"], model);
            let functions = file["residual"]["functions"].as_array().unwrap();
            assert_eq!(functions.len(), points.len() * points.len());
        }
    }
}

#[test]
fn every_quantity_gives_the_same_joint() {
    for quantities in [
        [Quantity::Accelerance; 3],
        [Quantity::Mobility; 3],
        [
            Quantity::Mobility,
            Quantity::Accelerance,
            Quantity::Receptance,
        ],
    ] {
        let bench = Bench::new();
        measure(&bench, &FULL, quantities);
        bench.write("study.toml", study("full", &[21, 22, 23]));
        identify(&bench);
        let error = deviation(&bench, &FULL);
        assert!(error < 1e-6, "{error}");
    }
}

#[test]
fn a_study_elsewhere_finds_its_files_beside_itself() {
    let bench = crate::rig::ready();
    std::fs::create_dir(bench.path("work")).unwrap();
    let outcome = bench
        .command(&["identify", "../study.toml", "-o", "o.joint.json"])
        .current_dir(bench.path("work"))
        .output()
        .unwrap();
    assert!(outcome.status.success());
    std::fs::rename(bench.path("work/o.joint.json"), bench.path("o.joint.json")).unwrap();
    assert!(deviation(&bench, &FULL) < 1e-6);
    let file = bench.json("o.joint.json");
    let inputs = file["provenance"]["inputs"].as_array().unwrap();
    let names: Vec<&str> = inputs
        .iter()
        .map(|input| input["file"].as_str().unwrap())
        .collect();
    assert_eq!(names, ["study.toml", "a.uff", "b.uff", "c.uff"]);
}

#[test]
fn a_transposed_half_of_the_matrix_is_enough() {
    let bench = crate::rig::ready();
    // All functions whose response has not a lower node than its reference.
    let text = bench.text("c.uff");
    let begin = "    -1\n    58\n";
    let half: String = text
        .split(begin)
        .skip(1)
        .enumerate()
        .filter(|(index, _)| index / 3 >= index % 3)
        .map(|(_, function)| format!("{begin}{function}"))
        .collect();
    bench.write("c.uff", half);
    identify(&bench);
    assert!(deviation(&bench, &FULL) < 1e-6);
    let file = bench.json("o.joint.json");
    assert_eq!(file["residual"]["functions"].as_array().unwrap().len(), 6);
}

#[test]
fn a_stated_quantity_takes_the_place_of_a_missing_one() {
    let bench = Bench::new();
    measure(&bench, &FULL, [Quantity::Accelerance; 3]);
    let silent = bench
        .text("c.uff")
        .replace("        12    0", "         0    0");
    bench.write("c.uff", silent);
    let text = study("full", &[21, 22, 23]);
    bench.write("study.toml", &text);
    bench.refused(
        &["identify", "study.toml", "-o", "o.joint.json"],
        &["c.uff, line 11", "quantity = \"accelerance\""],
    );
    let stated = text.replace(
        "frf = \"c.uff\"",
        "frf = \"c.uff\"\nquantity = \"accelerance\"",
    );
    bench.write("study.toml", stated);
    identify(&bench);
    assert!(deviation(&bench, &FULL) < 1e-6);
}

#[test]
fn what_was_identified_can_be_checked_and_exported() {
    let bench = crate::rig::ready();
    let bodies = "\n[bodies]\na = { inertia = [1.2, 8e-3], stiffness = [4e4, 300], damping = [3, 0.01] }\n\
                  b = { inertia = [0.5, 3e-3], stiffness = [500, 5], damping = [0.5, 2e-3] }\n";
    bench.write("study.toml", study("full", &[21, 22, 23]) + bodies);
    identify(&bench);
    bench.done(&["check", "o.joint.json"]);
    for interface in ["element", "lap"] {
        bench.done(&["export", "o.joint.json", "-o", "o.fmu", "--as", interface]);
        bench.done(&["check", "o.fmu"]);
    }
}

/// The rig's universal files as binary ones and as a table lead where they lead.
#[test]
fn binary_files_and_tables_give_the_joint_too() {
    use bolted_joint::frf::{ByteOrder, FrfSet, ReadOptions, read_frfs, write_uff58b};
    use std::fmt::Write as _;

    let bench = Bench::new();
    measure(&bench, &TRANSLATION, [Quantity::Accelerance; 3]);
    let set = |name: &str| -> FrfSet {
        let reading = read_frfs(bench.path(name), &ReadOptions::default()).unwrap();
        reading.into_set().unwrap()
    };
    write_uff58b(&set("a.uff"), bench.path("a.bin"), "", ByteOrder::Little).unwrap();
    write_uff58b(&set("c.uff"), bench.path("c.bin"), "", ByteOrder::Big).unwrap();
    let b = set("b.uff");
    let mut table = "# quantity = receptance\nfrequency [Hz]".to_owned();
    for (response, reference, _) in b.functions() {
        let pair = format!("{response}/{reference}");
        write!(table, ";{pair} real;{pair} imaginary").unwrap();
    }
    for (line, hz) in b.frequency_hz().iter().enumerate() {
        write!(table, "\n{hz}").unwrap();
        for (_, _, values) in b.functions() {
            write!(table, ";{:e};{:e}", values[line].re, values[line].im).unwrap();
        }
    }
    bench.write("b.csv", table.replace('.', ","));
    let study = study("translation", &[21, 23])
        .replace("a.uff", "a.bin")
        .replace("b.uff", "b.csv")
        .replace("c.uff", "c.bin");
    bench.write("study.toml", study);
    identify(&bench);
    let error = deviation(&bench, &TRANSLATION);
    assert!(error < 1e-6, "{error}");
}
