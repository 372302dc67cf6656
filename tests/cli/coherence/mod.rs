//! Coherence and averages, from a file to the joint: estimate, deviations and χ² are those of a likelihood with
//! σ² = |Ĥ|²(1 − γ²)/((n − 2) γ²), computed without the program.

mod likelihood;
mod measurement;
mod told;

use bolted_joint_testing::has;
use nalgebra::Vector6;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use serde_json::Value;

use crate::bench::{Bench, replaced};
use crate::rig::{FULL, Quantity, measure, motion_of_a, points_of_a, receptance, study};

use likelihood::{Fit, fit, unknowns};
use measurement::{AVERAGES, Measured, archive, assembly, table, universal_file};

const EXACT: &str = "\n[noise]\na = { relative = 0, floor = 0 }\nb = { relative = 0, floor = 0 }\n";

/// From 0.99 at the best lines to 0.6 at the worst, other lines for every function.
fn varied(response: usize, reference: usize, line: usize) -> f64 {
    let phase = 0.3 * line as f64 + 2.0 * response as f64 + 0.7 * reference as f64;
    0.795 + 0.195 * phase.sin()
}

/// The rig with exact files of A and B, and a study of `assembly_file` with `more` after the assembly's file.
fn bench(assembly_file: &str, more: &str) -> Bench {
    let bench = Bench::new();
    measure(&bench, &FULL, [Quantity::Receptance; 3]);
    let text = study("full", &[21, 22, 23]) + EXACT;
    let named = format!("frf = \"{assembly_file}\"\n{more}");
    bench.write("study.toml", replaced(&text, "frf = \"c.uff\"\n", &named));
    bench
}

fn identified(bench: &Bench) -> Value {
    bench.done("identify study.toml -o o.joint.json");
    bench.json("o.joint.json")
}

/// k_yy, k_yθ, k_θθ and the same of the damping, from an object with both matrices.
fn six(matrices: &Value) -> Vector6<f64> {
    let [k, c] = ["stiffness", "damping"].map(|key| {
        let rows = &matrices[key];
        let at = |i: usize, j: usize| rows[i][j].as_f64().unwrap();
        [at(0, 0), at(0, 1), at(1, 1)]
    });
    Vector6::new(k[0], k[1], k[2], c[0], c[1], c[2])
}

fn estimate(file: &Value) -> Vector6<f64> {
    // The free estimate stands beside the passive one where they differ.
    let free = &file["uncertainty"]["free_estimate"];
    match free.is_null() {
        true => six(&file["joint"]),
        false => six(free),
    }
}

fn deviation(file: &Value) -> Vector6<f64> {
    six(&file["uncertainty"]["standard_deviation"])
}

fn chi_squared(file: &Value) -> f64 {
    file["residual"]["reduced_chi_squared"].as_f64().unwrap()
}

/// The program's result against that of the likelihood.
fn agree(file: &Value, expected: &Fit) {
    let away = (estimate(file) - expected.unknowns).component_div(&expected.deviation);
    assert!(away.amax() < 1e-4, "{away}");
    let chi = expected.reduced_chi_squared;
    assert!((chi_squared(file) / chi - 1.0).abs() < 1e-6, "{chi}");
    // Coherence is the least that the noise can be: where the residual is larger, the deviations are.
    let deviations = deviation(file).component_div(&expected.deviation) / chi.max(1.0).sqrt();
    assert!(
        deviations.iter().all(|ratio| (ratio - 1.0).abs() < 1e-5),
        "{deviations}"
    );
}

#[test]
fn noise_drawn_from_the_coherence_is_found_to_be_that_noise() {
    for seed in 1..=5 {
        let functions = assembly(seed, varied);
        let bench = bench("measured.uff", &format!("averages = {AVERAGES}\n"));
        bench.write("measured.uff", universal_file(&functions));
        let file = identified(&bench);
        agree(&file, &fit(&functions));
        // Four standard deviations of χ² per degree of freedom, √(2/ν) with ν = 2·9·67 − 6.
        let chi = chi_squared(&file);
        assert!((chi - 1.0).abs() < 4.0 * (2.0_f64 / 1200.0).sqrt(), "{chi}");
        let away = (estimate(&file) - unknowns(&FULL)).component_div(&deviation(&file));
        assert!(away.amax() < 4.0, "{away}");
        let basis = file["uncertainty"]["basis"].as_str().unwrap();
        has(basis, &["the noise that coherence and averages tell"]);
        assert!(file["residual"]["noise"].is_null());
    }
}

#[test]
fn every_format_carries_coherence_and_averages() {
    let functions = assembly(7, varied);
    let expected = fit(&functions);
    let formats = [
        (
            "measured.uff",
            universal_file(&functions).into_bytes(),
            "averages = 42\n",
        ),
        ("measured.csv", table(&functions).into_bytes(), ""),
        ("measured.npz", archive(&functions), ""),
    ];
    for (name, bytes, more) in formats {
        let bench = bench(name, more);
        bench.write(name, bytes);
        agree(&identified(&bench), &expected);
    }
}

#[test]
fn the_number_of_averages_sets_the_deviations() {
    let functions = assembly(3, varied);
    let with = |averages: f64| {
        let bench = bench("measured.csv", &format!("averages = {averages}\n"));
        // The study has the last word over the 42 of the table.
        bench.write("measured.csv", table(&functions));
        identified(&bench)
    };
    let [few, right, many] = [22.0, AVERAGES, 82.0].map(with);
    let chi = chi_squared(&right);
    for (file, factor) in [(&few, 0.5), (&many, 2.0)] {
        assert!((chi_squared(file) / (factor * chi) - 1.0).abs() < 1e-9);
        let moved = (estimate(file) - estimate(&right)).component_div(&deviation(&right));
        assert!(moved.amax() < 1e-6, "{moved}");
    }
    // Half of n − 2: √2 times the deviation of noise that is believed.
    let ratio = deviation(&few).component_div(&deviation(&right)) * chi.max(1.0).sqrt();
    assert!(
        ratio
            .iter()
            .all(|ratio| (ratio - 2.0_f64.sqrt()).abs() < 1e-6),
        "{ratio}"
    );
    assert!(few["uncertainty"]["inflation"].is_null());
    // More averages than there were: the residual says otherwise, and the file by how much.
    let ratio = deviation(&many).component_div(&deviation(&right));
    let expected = (chi / chi.max(1.0)).sqrt();
    assert!(
        ratio
            .iter()
            .all(|ratio| (ratio / expected - 1.0).abs() < 1e-6),
        "{ratio}"
    );
    let inflation = many["uncertainty"]["inflation"].as_f64().unwrap();
    assert!((inflation / (2.0 * chi).sqrt() - 1.0).abs() < 1e-9);
}

#[test]
fn functions_of_low_coherence_count_for_little() {
    // The second response barely stands out from noise.
    let poor = |response, _, _| if response == 1 { 0.02 } else { 0.9995 };
    let functions = assembly(11, poor);
    let with = |more: &str| {
        let bench = bench("measured.uff", more);
        bench.write("measured.uff", universal_file(&functions));
        identified(&bench)
    };
    let weighted = with("averages = 42\n");
    agree(&weighted, &fit(&functions));
    // Without averages the coherence says nothing, and every line counts alike.
    let alike = with("");
    assert!(alike["residual"]["noise"]["relative"].as_f64().unwrap() > 0.5);
    let gain = deviation(&alike).component_div(&deviation(&weighted));
    assert!(gain.iter().all(|gain| *gain > 10.0), "{gain}");
    let truth = unknowns(&FULL);
    let away = (estimate(&weighted) - truth).component_div(&deviation(&weighted));
    assert!(away.amax() < 4.0, "{away}");
    let moved = (estimate(&weighted) - estimate(&alike)).component_div(&deviation(&weighted));
    assert!(moved.amax() > 3.0, "{moved}");
}

/// Errors of a substructure count as its own coherence says.
#[test]
fn a_substructure_has_its_own_coherence() {
    let mut generator = ChaCha8Rng::seed_from_u64(21);
    let points = points_of_a();
    let mut of_a = Vec::new();
    for &response in &points {
        for &reference in &points {
            of_a.push(Measured::new(
                (response, reference),
                |omega| receptance(&motion_of_a(omega), response, reference),
                |line| 0.9998 - 1e-4 * (line % 2) as f64,
                &mut generator,
            ));
        }
    }
    let functions = assembly(22, |_, _, _| 0.999);
    let with = |of_a_believed: &str| {
        let bench = bench("measured.uff", "averages = 42\n");
        bench.write("measured.uff", universal_file(&functions));
        bench.write("a.uff", universal_file(&of_a));
        let text = bench
            .text("study.toml")
            .replace("a = { relative = 0, floor = 0 }\n", of_a_believed);
        let text = replaced(
            &text,
            "frf = \"a.uff\"\n",
            "frf = \"a.uff\"\naverages = 42\n",
        );
        bench.write("study.toml", text);
        identified(&bench)
    };
    let file = with("");
    let chi = chi_squared(&file);
    assert!((chi - 1.0).abs() < 4.0 * (2.0_f64 / 1200.0).sqrt(), "{chi}");
    let away = (estimate(&file) - unknowns(&FULL)).component_div(&deviation(&file));
    assert!(away.amax() < 4.0, "{away}");
    // As if A were exact, its errors are left over.
    let chi = chi_squared(&with("a = { relative = 0, floor = 0 }\n"));
    assert!(chi > 1.2, "{chi}");
}
