//! Predictions whose result is known from elsewhere, and what follows them: export, check, files for other programs.

use bolted_joint_testing::{close, has, near};
use std::fs;

use serde_json::Value;

use super::{PREDICT, STUDY, bench, over_torque, predicted};
use crate::bench::{Outcome, replaced};
use crate::examples::files_of;

fn entry(file: &Value, matrix: &str, i: usize, j: usize) -> f64 {
    number(&file["joint"][matrix][i][j])
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap()
}

/// The study with a pressure from a file.
fn with_field() -> String {
    let interface = STUDY.find("[interface]").unwrap();
    let joint = STUDY.find("[joint]").unwrap();
    let field = "[interface]\nfield = \"field.csv\"\n\n";
    format!("{}{field}{}", &STUDY[..interface], &STUDY[joint..])
}

#[test]
fn an_even_field_has_the_stiffness_of_the_published_parameters() {
    // Zhao's surfaces and material, A₀ = 0.06 m²: K_N/A₀ = 6.200e11 N/m³ at 2 MPa, K_T/K_N = 0.461 without tangential force
    let (with, without) = ("shear_strength = 1e8", "shear_strength = 0");
    let bench = bench(&replaced(&with_field(), with, without));
    let n = 20;
    let mut field = "x_m,y_m,area_m2,pressure_Pa\n".to_owned();
    for k in 0..n * n {
        let [x, y] = [(0.3, k % n), (0.2, k / n)]
            .map(|(length, place)| length * (place as f64 + 0.5) / n as f64);
        field += &format!("{x},{y},{},2e6\n", 0.06 / (n * n) as f64);
    }
    bench.write("field.csv", &field);
    bench.done(PREDICT);
    let file = bench.json("j.joint.json");
    let area = 0.06;
    let normal = entry(&file, "stiffness", 0, 0);
    close(normal, 6.200e11 * area, 2e-4);
    // about the centroid: no coupling, and k_n times the second moment of the area
    assert_eq!(entry(&file, "stiffness", 0, 1), 0.0);
    let inertia = 0.2 * 0.3_f64.powi(3) / 12.0 * (1.0 - 1.0 / (n * n) as f64);
    let rotation = entry(&file, "stiffness", 1, 1);
    close(rotation, normal / area * inertia, 1e-9);

    let along_z = "translation = \"z\"\nrotation = \"-y\"";
    bench.edit("study.toml", along_z, "translation = \"x\"");
    bench.done(PREDICT);
    let tangential = entry(&bench.json("j.joint.json"), "stiffness", 0, 0);
    near(tangential / normal, 0.461, 5e-4);
}

#[test]
fn the_field_that_is_written_gives_the_same_joint_again() {
    let first = bench(STUDY);
    first.done(&format!("{PREDICT} --field-csv field.csv"));
    let second = bench(&with_field());
    second.write("field.csv", first.text("field.csv"));
    second.done(PREDICT);
    let [first, second] = [first, second].map(|bench| bench.json("j.joint.json"));
    for matrix in ["stiffness", "damping"] {
        for i in 0..2 {
            let [a, b] = [&first, &second].map(|file| entry(file, matrix, i, i));
            close(a, b, 1e-12);
        }
    }
}

#[test]
fn a_table_over_the_torque_becomes_an_fmu_that_loosens() {
    let bench = bench(&over_torque());
    let outcome = bench.done(PREDICT);
    has(&outcome.stdout, &["at 25 N·m", "imbalance +0.00 %"]);
    let file = bench.json("j.joint.json");
    let table = &file["joint"]["over_preload"];
    assert_eq!(table["nominal"], 20.0);
    let stiffness = |place: usize| table["stiffness"][place][0][0].as_f64().unwrap();
    for place in 1..5 {
        assert!(stiffness(place) > stiffness(place - 1));
    }
    // its joint at 20 N·m is that of the study with this torque alone
    let alone = &predicted(STUDY)["joint"];
    assert_eq!(table["stiffness"][3], alone["stiffness"]);
    bench.done("check j.joint.json");
    for version in ["3", "2"] {
        bench.done(&format!("export j.joint.json -o j.fmu --fmi {version}"));
        bench.done("check j.fmu");
    }
    bench.done("export j.joint.json -o frozen.fmu --preload 12");
    bench.done("check frozen.fmu");
}

#[test]
fn intervals_are_those_of_the_only_uncertain_input() {
    // Stiffness grows with the preload, so that its quantiles are the stiffnesses at the preload's: with one nut factor for
    // all bolts, drawn lognormal, at K = m e^(±1.96 s − s²/2), s² = ln(1 + 0.1²).
    let uncertain = replaced(
        STUDY,
        "nut_factor = 0.2\n",
        "nut_factor = { value = 0.2, standard_deviation = 0.02 }\nscatter = \"common\"\n",
    ) + "\n[uncertainty]\ndraws = 20000\nseed = 7\n";
    let bench = bench(&uncertain);
    let outcome = bench.done(PREDICT);
    has(&outcome.stdout, &["k_yy scatters with nut factor"]);
    let file = bench.json("j.joint.json");
    let variance = 1.01_f64.ln();
    for (place, score) in [(0, 1.959_964), (1, -1.959_964)] {
        let factor = 0.2 * (score * variance.sqrt() - 0.5 * variance).exp();
        let factor = format!("nut_factor = {factor}");
        let at_end = predicted(&replaced(STUDY, "nut_factor = 0.2", &factor));
        let intervals = &file["uncertainty"]["interval_95"]["stiffness"];
        let found = number(&intervals[0][0][place]);
        // the percentile of 20 000 draws is known to about 0.02 standard deviations
        close(found, entry(&at_end, "stiffness", 0, 0), 0.006);
    }
    // the joint itself is the one at the values given
    assert_eq!(file["joint"], predicted(STUDY)["joint"]);
    let basis = file["uncertainty"]["basis"].as_str().unwrap();
    has(basis, &["nut factor", "20000 draws", "seed 7"]);
}

#[test]
fn bolts_that_scatter_each_on_their_own_scatter_less_together() {
    let deviation = |scatter: &str| {
        let uncertain = format!("nut_factor = \"0.2 ± 0.03\"\nscatter = \"{scatter}\"\n");
        let file = predicted(&replaced(STUDY, "nut_factor = 0.2\n", &uncertain));
        let of = &file["uncertainty"]["standard_deviation"]["stiffness"];
        (number(&of[0][0]), number(&of[0][1]))
    };
    let (each, common) = (deviation("each-bolt"), deviation("common"));
    // four independent bolts: half the deviation, and the coupling that they have in common is none
    near(common.0 / each.0, 2.0, 0.15);
    assert!(
        each.1 > 0.0 && common.1 < 1e-6 * each.1,
        "{each:?} {common:?}"
    );
}

#[test]
fn the_same_seed_gives_the_same_file_and_refused_draws_are_told() {
    let uncertain = replaced(STUDY, "= 1.42", "= \"1.42 ± 0.02\"");
    let uncertain = replaced(&uncertain, "friction = 0.3", "friction = \"0.3 ± 0.1\"");
    let with_seed =
        |seed: u64| uncertain.clone() + &format!("\n[uncertainty]\ndraws = 3000\nseed = {seed}\n");
    let run = |seed: u64, threads: &str| {
        let bench = bench(&with_seed(seed));
        let mut command = bench.command(PREDICT);
        command.env("RAYON_NUM_THREADS", threads);
        let outcome = Outcome::of(command.output().unwrap());
        assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
        (bench.text("j.joint.json"), outcome.stderr)
    };
    let (file, warnings) = run(1, "1");
    assert_eq!(run(1, "3").0, file);
    assert_ne!(run(2, "3").0, file);
    has(&warnings, &["draws refused: q = T/(μP) beyond the model"]);
    assert!(file.contains("of them refused"));
}

#[test]
fn everything_for_finite_elements_is_written_beside() {
    let bench = bench(STUDY);
    let outputs = "--matrix-csv k.csv --matrix27 k.mac --field-csv f.csv --report r.html";
    let outcome = bench.done(&format!("{PREDICT} --json {outputs}"));
    let json = outcome.json();
    let stiffness = &json["states"][0]["stiffness"];
    let file = bench.json("j.joint.json");
    assert_eq!(stiffness[2][2], file["joint"]["stiffness"][0][0]);
    assert_eq!(stiffness[4][4], file["joint"]["stiffness"][1][1]);
    let row = format!("{:e}", stiffness[2][2].as_f64().unwrap());
    assert!(bench.text("k.csv").contains(&row));
    assert!(bench.text("k.mac").contains("MATRIX27"));
    has(
        &bench.done("show k.csv").stdout,
        &["table of an interface's matrices (CSV)"],
    );
    // four elements of 2 mm are under each hole
    let lines = bench.text("f.csv").lines().count();
    assert!((2300..=2402).contains(&lines), "{lines}");
    let page = bench.text("r.html");
    #[rustfmt::skip]
    let parts = ["The joint", "Pressure", "The whole interface", "Surfaces", "What was put in", "Provenance"];
    has(&page, &parts.map(|part| format!("<h2>{part}</h2>")));
    // but for clips, which are in the page itself
    let page = page.replace("url(#", "");
    let references = ["<script src", "<link", "<img", "url(", "@import"];
    assert!(references.iter().all(|reference| !page.contains(reference)));
    let hash = file["provenance"]["inputs"][0]["sha256"].as_str().unwrap();
    assert!(page.contains(hash));
    let names = fs::read_dir(bench.path("")).unwrap().count();
    assert_eq!(names, 6);
}

/// Tol's M10x16 with surfaces like Zhao's: its identified joint (Table 5.3) has 5.73e5 N/m and 1.29e3 N·m/rad.
#[test]
fn contact_alone_is_not_the_joint_and_says_so() {
    let bolts = STUDY.find("[[bolts]]").unwrap();
    let joint = STUDY.find("[joint]").unwrap();
    let bolt = "[[bolts]]\nx = 0\ny = 0\ndiameter = 0.01\npreload = 10000\n";
    let mut study = format!("{}{bolt}{}", &STUDY[..bolts], &STUDY[joint..]);
    for (old, new) in [
        ("shear_strength = 1e8", "shear_strength = 0"),
        ("hardness = 1.96e9", "hardness = 1e9"),
        ("x = [-0.06, 0.06]", "x = [-0.015, 0.015]"),
        ("y = [-0.04, 0.04]", "y = [-0.0125, 0.0125]"),
        (
            "model = \"kavi\"",
            "model = \"cone\"\nhalf_angle = 30\nhead_diameter = 0.016\ndepth = 0.006",
        ),
        ("thickness = [0.01, 0.01]\n", ""),
    ] {
        study = replaced(&study, old, new);
    }
    let aluminium = "youngs_modulus = 7e10\npoissons_ratio = 0.33";
    study = study.replace("youngs_modulus = 1.5e11\npoissons_ratio = 0.28", aluminium);
    let bench = bench(&study);
    let outcome = bench.done(&format!("{PREDICT} --report r.html"));
    let file = bench.json("j.joint.json");
    close(entry(&file, "stiffness", 0, 0) / 5.73e5, 6300.0, 0.02);
    close(entry(&file, "stiffness", 1, 1) / 1.29e3, 86.0, 0.02);
    let notes = file["provenance"]["notes"].to_string();
    for text in [&outcome.stdout, &bench.text("r.html"), &notes] {
        has(
            text,
            &["the contact alone, not the joint: the bolt and the bending"],
        );
    }
}

/// Zhao's (29) with the factor that is printed, and with the energies of a cycle: q = T/(μP) is that of the real area.
#[test]
fn loss_factors_are_those_of_a_cycle_unless_the_paper_is_asked_for() {
    let even = replaced(
        STUDY,
        "model = \"kavi\"\nthickness = [0.01, 0.01]",
        "model = \"uniform\"",
    );
    let bench = bench(&even);
    let of = || {
        let json = bench.done(&format!("{PREDICT} --json")).json();
        let state = &json["states"][0];
        [
            "largest_real_area_fraction",
            "largest_pressure_pa",
            "normal_loss_factor",
            "tangential_loss_factor",
        ]
        .map(|key| number(&state[key]))
    };
    let [real_area, pressure_pa, normal, tangential] = of();
    let q = 1e8 * real_area / (0.3 * pressure_pa);
    let rest = 1.0 - q;
    let h1 = 1.0 - rest.powf(5.0 / 3.0) - 5.0 * q / 6.0 * (1.0 + rest.powf(2.0 / 3.0));
    let h2 = 0.6 + 0.4 * rest.powf(5.0 / 3.0) - rest.powf(2.0 / 3.0);
    let energy_ratio = |factor: f64| 1.0 / (factor * h2 / h1 - 1.0);
    let (pi, tau) = (std::f64::consts::PI, std::f64::consts::TAU);
    close(tangential, energy_ratio(5.0 / 24.0) / tau, 1e-9);
    let frequency = "frequency = 300\n";
    let ratio = format!("{frequency}loss_factor = \"energy-ratio\"\n");
    bench.edit("study.toml", frequency, &ratio);
    let [.., of_ratio, along] = of();
    close(of_ratio, tau * normal, 1e-12);
    close(along, tau * tangential, 1e-12);
    let published = format!("{ratio}stored_energy = \"pi-loadings\"\n");
    bench.edit("study.toml", &ratio, &published);
    let [.., of_ratio_again, along] = of();
    assert_eq!(of_ratio_again, of_ratio);
    close(along, energy_ratio(5.0 * pi / 24.0), 1e-9);
}

#[test]
fn viscous_normal_damping_is_that_of_zhao() {
    let bench = bench(STUDY);
    let viscous = "frequency = 300\nnormal = \"viscous\"\nmass = 12.5";
    bench.edit("study.toml", "frequency = 300", viscous);
    let json = bench.done(&format!("{PREDICT} --json")).json();
    let state = &json["states"][0];
    let stiffness = number(&state["stiffness"][2][2]);
    let expected = number(&state["normal_loss_factor"]) * (12.5 * stiffness).sqrt();
    close(number(&state["viscous_damping"][2][2]), expected, 1e-12);
    let file = bench.json("j.joint.json");
    close(entry(&file, "damping", 0, 0), expected, 1e-12);
}

/// The study with Tian's layer in place of the contact.
fn with_layer() -> String {
    let layer = replaced(STUDY, "\"fractal-contact\"", "\"virtual-material\"");
    let ratio = "poissons_ratio = 0.28\n";
    let layer = layer.replace(ratio, &format!("{ratio}density = 7200\n"));
    let contact = "friction = 0.3\nshear_strength = 1e8\n";
    let of_layer =
        "friction_ratio = 0.2\n[layer]\nthickness = [0.001, 0.0005]\nloss_factor = 0.01\n";
    replaced(&layer, contact, of_layer)
}

/// No layer of contacts is stiffer than the solid in its place, of slices in series: both are of the same iron here.
#[test]
fn a_layer_that_is_stiffer_than_the_parts_is_warned_of() {
    let found = |roughness: &str| {
        let bench = bench(&replaced(&with_layer(), "= 1.21e-8", roughness));
        let outcome = bench.done(&format!("{PREDICT} --json"));
        let young = number(&outcome.json()["states"][0]["layer"]["youngs_modulus_pa"]);
        (young, outcome.stderr)
    };
    let (stiff, said) = found("= 1.21e-9");
    assert!(stiff > 1.5e11, "{stiff}");
    has(
        &said,
        &[
            "the layer is stiffer than the parts",
            &format!("{stiff:.3e}"),
            "1.500e11 Pa",
            "fractal-contact",
        ],
    );
}

#[test]
fn a_virtual_layer_is_the_joint_of_its_material() {
    // As hard as iron is, the moduli are those of no isotropic material: there is a joint, but no card.
    let soft = bench(&with_layer());
    soft.refused(
        &format!("{PREDICT} --material-card layer.inp"),
        &["`layer`", "Poisson's ratio", "isotropic"],
    );
    let outcome = soft.done(PREDICT);
    has(&outcome.stderr, &["no isotropic material"]);
    assert!(
        !outcome.stderr.contains("or a greater hardness"),
        "{}",
        outcome.stderr
    );
    soft.done("check j.joint.json");

    let bench = bench(&replaced(&with_layer(), "1.96e9", "6e9"));
    let card = |name: &str| {
        let command = format!("{PREDICT} --material-card {name} --json");
        let json = bench.done(&command).json();
        (bench.text(name), json["states"][0].clone())
    };
    let (abaqus, state) = card("layer.inp");
    assert!(abaqus.contains("*MATERIAL, NAME=bolted_joint"), "{abaqus}");
    let layer = &state["layer"];
    assert_eq!(number(&layer["thickness_m"]), 0.0015);
    near(number(&layer["density_kg_per_m3"]), 7200.0, 1e-9);
    let young = number(&layer["youngs_modulus_pa"]);
    let shear = young / (2.0 * (1.0 + number(&layer["poissons_ratio"])));
    // E A/h and G A/h over the area under pressure
    let [tangential, normal] = [0, 2].map(|i| number(&state["stiffness"][i][i]));
    close(normal / tangential, young / shear, 1e-12);
    let area = normal * 0.0015 / young;
    // four zones of 3.5 diameters without their holes; cells at the rim count whole
    let zones = 4.0 * std::f64::consts::PI * 0.004_f64.powi(2) * (3.5_f64.powi(2) - 1.0);
    assert!(area > zones && area < 1.25 * zones, "{area} {zones}");
    // the loss factor that is stated
    let damping = entry(&bench.json("j.joint.json"), "damping", 0, 0);
    close(
        damping,
        0.01 * normal / (std::f64::consts::TAU * 300.0),
        1e-12,
    );
    assert!(card("layer.mac").0.contains("MP,"));
    assert!(card("layer.csv").0.starts_with("quantity,value,unit\n"));
    bench.done("export j.joint.json -o j.fmu");
    bench.done("check j.fmu");
}

#[test]
fn the_example_goes_from_profiles_to_an_fmu() {
    let bench = files_of("predict-four-bolts");
    let outcome = bench.done(&format!("{PREDICT} --report r.html --matrix27 k.mac"));
    has(&outcome.stdout, &["5000 draws, seed 1, 0 refused"]);
    assert_eq!(outcome.stderr, "");
    let file = bench.json("j.joint.json");
    // the study, three profiles of each surface
    assert_eq!(file["provenance"]["inputs"].as_array().unwrap().len(), 7);
    let table = &file["uncertainty"]["over_preload"];
    assert_eq!(table["at"].as_array().unwrap().len(), 4);
    assert_eq!(table["correlation"]["unknowns"][0], "k_yy@4");
    assert_eq!(table["correlation"]["matrix"].as_array().unwrap().len(), 24);
    let page = bench.text("r.html");
    assert_eq!(page.matches("Spectrum of the profiles").count(), 2);
    bench.done("export j.joint.json -o j.fmu");
    bench.done("check j.fmu");
}

/// Millimetres, and a friction coefficient without its decimal point.
#[test]
fn values_in_another_unit_are_warned_of() {
    let outcome = bench(PLAIN).done(PREDICT);
    assert!(!outcome.stderr.contains("probably"), "{}", outcome.stderr);
    assert!(
        !outcome.stderr.contains("contact.friction"),
        "{}",
        outcome.stderr
    );
    let long = replaced(PLAIN, "x = [-0.03, 0.03]", "x = [-30, 30]");
    let outcome = bench(&replaced(&long, "friction = 0.15", "friction = 5")).run(PREDICT);
    has(
        &outcome.stderr,
        &[
            "m long",
            "probably in mm",
            "contact.friction is 5",
            "0.1 to 0.8",
        ],
    );
}

const PLAIN: &str = "method = \"fractal-contact\"\nname = \"mine\"\n[materials]\na = { youngs_modulus = 210e9, poissons_ratio = 0.3 }\n\
b = { youngs_modulus = 70e9, poissons_ratio = 0.33 }\n[surface]\nfractal_dimension = 1.4\nroughness = 1e-11\n[contact]\nhardness = 1e9\n\
friction = 0.15\nshear_strength = 0\n[interface]\nx = [-0.03, 0.03]\ny = [-0.02, 0.02]\nelements = [40, 30]\n[pressure]\n\
model = \"uniform\"\n[[bolts]]\nx = -0.015\ny = 0\ndiameter = 0.008\npreload = 8000\n[[bolts]]\nx = 0.015\ny = 0\n\
diameter = 0.008\npreload = 8000\n[joint]\ntranslation = \"x\"\nrotation = \"-y\"\n[damping]\nfrequency = 100\n";
