//! Studies that are right lead to the joint that the data were made with.

use crate::bench::{Bench, IDENTIFY};
use crate::rig::{DIAGONAL, FULL, Quantity, TRANSLATION, functions_of, measure, study};

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
            bench.done(IDENTIFY);
            joint.is_in(&bench);
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
        bench.done(IDENTIFY);
        FULL.is_in(&bench);
    }
}

#[test]
fn a_study_elsewhere_finds_its_files_beside_itself() {
    let bench = crate::rig::ready();
    std::fs::create_dir(bench.path("work")).unwrap();
    let outcome = bench
        .command("identify ../study.toml -o o.joint.json")
        .current_dir(bench.path("work"))
        .output()
        .unwrap();
    assert!(outcome.status.success());
    std::fs::rename(bench.path("work/o.joint.json"), bench.path("o.joint.json")).unwrap();
    FULL.is_in(&bench);
    let file = bench.json("o.joint.json");
    let inputs = file["provenance"]["inputs"].as_array().unwrap();
    let names: Vec<&str> = inputs.iter().map(|i| i["file"].as_str().unwrap()).collect();
    assert_eq!(names, ["study.toml", "a.uff", "b.uff", "c.uff"]);
}

#[test]
fn a_transposed_half_of_the_matrix_is_enough() {
    let bench = crate::rig::ready();
    // All functions whose response has not a lower node than its reference.
    let half = functions_of(&bench.text("c.uff"), |place| place / 3 >= place % 3);
    bench.write("c.uff", half);
    bench.done(IDENTIFY);
    FULL.is_in(&bench);
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
    bench.write("study.toml", study("full", &[21, 22, 23]));
    let advice = "quantity = \"accelerance\"";
    bench.refused(IDENTIFY, &["c.uff, line 11", advice]);
    let stated = format!("frf = \"c.uff\"\n{advice}");
    bench.edit("study.toml", "frf = \"c.uff\"", &stated);
    bench.done(IDENTIFY);
    FULL.is_in(&bench);
}

#[test]
fn what_was_identified_can_be_checked_and_exported() {
    let bench = crate::rig::ready();
    let bodies = "\n[bodies]\na = { inertia = [1.2, 8e-3], stiffness = [4e4, 300], damping = [3, 0.01] }\n\
                  b = { inertia = [0.5, 3e-3], stiffness = [500, 5], damping = [0.5, 2e-3] }\n";
    bench.write("study.toml", study("full", &[21, 22, 23]) + bodies);
    bench.done(IDENTIFY);
    bench.done("check o.joint.json");
    for interface in ["element", "lap"] {
        bench.done(&format!("export o.joint.json -o o.fmu --as {interface}"));
        bench.done("check o.fmu");
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
    bench.done(IDENTIFY);
    TRANSLATION.is_in(&bench);
}
