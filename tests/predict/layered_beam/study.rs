//! Studies as files: what is read, and what comes out.

use bolted_joint_testing::{close, has};
use std::path::Path;

use bolted_joint::joint::JointFile;
use bolted_joint::predict::layered_beam::{Friction, LayeredBeamStudy, Outcome};
use bolted_joint::study::StudyText;

pub(crate) const STUDY: &str = include_str!("../../data/studies/two-layers.toml");

pub(crate) fn run(text: &str) -> Outcome {
    LayeredBeamStudy::of(&StudyText::new(text, Path::new("study.toml")))
        .unwrap()
        .run()
        .unwrap()
}

#[test]
fn a_study_gives_frequencies_damping_and_a_joint_file() {
    let found = run(STUDY);
    assert_eq!(found.modes.len(), 3);
    // E b h³/12 of the bonded section, softened: halves of unlike thickness change nothing if the material is one
    let bending = 0.93 * 67.6e9 * 0.04125 * 0.006_f64.powi(3) / 12.0;
    close(found.bending_stiffness_n_m2, bending, 1e-13);
    let ratio = 3.926_602_312_047_919_f64.powi(2) / 0.43_f64.powi(2);
    let per_length = 2700.0 * 0.04125 * 0.006;
    let expected =
        ratio * (found.bending_stiffness_n_m2 / per_length).sqrt() / std::f64::consts::TAU;
    close(found.modes[0].frequency_hz, expected, 1e-14);
    close(found.tension_n, 4.0 / (0.18 * 0.006), 1e-14);
    let normal = 1.133_830_353_454_545_5 * found.tension_n;
    close(found.normal_forces_n[0], normal, 1e-12);
    assert_eq!(found.modes[1].drive_point_m, 0.12);
    assert_eq!(found.slips.len(), 4);
    for slip in &found.slips {
        close(slip.ideal_slip_m, 0.003 * slip.slope, 1e-14);
    }
    let csv = found.csv();
    assert_eq!(csv.lines().count(), 1 + 3 * 3);
    let columns = csv.lines().next().unwrap().split(',').count();
    assert!(csv.lines().all(|line| line.split(',').count() == columns));
    // only the mode of the joint file has a joint's damping
    assert_eq!(csv.lines().filter(|line| line.ends_with(',')).count(), 6);
    assert!(found.summary().iter().any(|line| line.contains("mode 2")));

    let file = found.joint_file;
    let again = JointFile::from_json(&file.to_json().unwrap(), "again").unwrap();
    assert_eq!(again, file);
    assert!(file.passivity().is_passive());
    let provenance = file.provenance.as_ref().unwrap();
    assert_eq!(provenance.method, "layered-beam");
    assert!(provenance.notes.contains(&"a note".to_owned()));
    let [below, above] = file.validity.as_ref().unwrap().frequency_hz;
    let frequency = found.modes[1].frequency_hz;
    assert!(below < frequency && frequency < above);
}

#[test]
fn a_list_of_torques_gives_a_table_over_the_preload() {
    let text = STUDY.replace("torque = 4", "torque = [2, 4, 8]").replace(
        "[motion]",
        "[joint]\ndamping = \"linear\"\namplitude = 1e-4\nnominal_torque = 4\n[motion]",
    );
    let found = run(&text);
    let file = found.joint_file;
    let table = file.joint.over_preload.as_ref().unwrap();
    assert_eq!(table.preload, [2.0, 4.0, 8.0]);
    assert_eq!(table.nominal, 4.0);
    assert_eq!(table.stiffness[0], table.stiffness[2]);
    // friction is proportional to the preload; the mount's share is the same at all
    let damping: Vec<f64> = table.damping.iter().map(|matrix| matrix[0][0]).collect();
    let [step, next] = [damping[1] - damping[0], damping[2] - damping[1]];
    close(next, 2.0 * step, 1e-9);
    close(damping[1], 2.0 * damping[0], 1e-3);
    file.to_json().unwrap();
    // at the nominal torque it is that of one torque alone
    let alone = STUDY.replace(
        "[motion]",
        "[joint]\ndamping = \"linear\"\namplitude = 1e-4\n[motion]",
    );
    let alone = run(&alone);
    close(alone.joint_file.joint.damping[0][0], damping[1], 1e-13);
}

/// Dry friction is in proportion to the preload, and so is the slider that stands for it: at each torque it is that of a study
/// with this torque alone.
#[test]
fn friction_over_the_preload_is_a_slider_that_follows_it() {
    let list = STUDY.replace("torque = 4", "torque = [2, 4, 8]");
    let list = list.replace("[motion]", "[joint]\nnominal_torque = 4\n[motion]");
    let file = run(&list).joint_file;
    let slip = |file: &bolted_joint::joint::JointFile| file.joint.friction[0].parameters[1];
    for torque in [2.0, 3.0, 8.0] {
        let alone = STUDY.replace("torque = 4", &format!("torque = {torque}"));
        let there = file.at_preload(Some(torque)).unwrap();
        close(slip(&there), slip(&run(&alone).joint_file), 1e-9);
    }
    assert_eq!(file.joint.over_preload.as_ref().unwrap().nominal, 4.0);
    assert!(file.validate().is_empty());
}

#[test]
fn a_calibration_on_another_beam_gives_its_alpha_mu() {
    let measured = r#"
[friction.calibration]
damping_ratio = 0.02
amplitude = 1e-4
mode = 1
[friction.calibration.beam]
length = 0.3
width = 0.03
boundary = "fixed-free"
layer = [{ thickness = 0.002, youngs_modulus = 67.6e9, density = 2700 }, { thickness = 0.002, youngs_modulus = 67.6e9, density = 2700 }]
[friction.calibration.fasteners]
kind = "rivet"
diameter = 0.004
count = 5
"#;
    let text = STUDY.replace("[friction]\nalpha_mu = 0.0021\n", measured);
    let study = LayeredBeamStudy::of(&StudyText::new(text, Path::new("study.toml"))).unwrap();
    assert!(matches!(study.friction, Friction::Calibrated(_)));
    let found = study.run().unwrap();
    // the same beam with this α′μ has the measured damping
    let back = format!(
        r#"
method = "layered-beam"
name = "measured"
[beam]
length = 0.3
width = 0.03
boundary = "fixed-free"
layer = [{{ thickness = 0.002, youngs_modulus = 67.6e9, density = 2700 }}, {{ thickness = 0.002, youngs_modulus = 67.6e9, density = 2700 }}]
[fasteners]
kind = "rivet"
diameter = 0.004
count = 5
[friction]
alpha_mu = {:e}
[motion]
amplitude = {{ from = 1e-4, to = 2e-4, count = 2 }}
route = "finite-elements"
"#,
        found.alpha_mu
    );
    let back = run(&back);
    close(back.amplitudes[0].finite_element_damping_ratio, 0.02, 1e-12);
    close(back.amplitudes[1].finite_element_damping_ratio, 0.01, 1e-12);
}

/// Friction and preload as value ± standard deviation: products of lognormal factors have moments in closed form.
#[test]
fn standard_deviations_become_intervals_of_the_joint() {
    let text = STUDY
        .replace("alpha_mu = 0.0021", "alpha_mu = \"0.0021 ± 0.00042\"")
        .replace("torque = 4\nnut_factor = 0.18", "preload = { value = 4000, standard_deviation = 600 }")
        .replace("[motion]", "[joint]\ndamping = \"linear\"\namplitude = 1e-4\n[uncertainty]\ndraws = 20000\nseed = 7\n[motion]");
    let found = run(&text);
    let row = |name: &str| found.scatter.iter().find(|row| row.name == name).unwrap();
    // c ∝ α′μ P: (s/m)² = (1 + 0.2²)(1 + 0.15²) − 1
    let relative = ((1.0 + 0.04_f64) * (1.0 + 0.0225) - 1.0).sqrt();
    let damping = row("c_yy");
    let c = found.joint_file.joint.damping[0][0];
    close(damping.mean, c, 0.01);
    close(damping.standard_deviation / damping.mean, relative, 0.03);
    // of a lognormal: e^(σ²/2 ± 1.96 σ) about the mean
    let sigma = (1.0 + relative * relative).ln().sqrt();
    for (end, sign) in damping.interval_95.iter().zip([-1.0, 1.0]) {
        let score = -0.5 * sigma * sigma + sign * 1.959_964 * sigma;
        close(*end, c * score.exp(), 0.03);
    }
    // they do not change what bends
    assert!(row("k_yy").standard_deviation < 1e-9 * row("k_yy").mean);
    let uncertainty = found.joint_file.uncertainty.as_ref().unwrap();
    let deviation = uncertainty.standard_deviation.damping[0][0];
    assert_eq!(deviation, damping.standard_deviation);
    let inputs = ["friction.alpha_mu", "fasteners.preload"];
    has(&uncertainty.basis, &inputs);
    JointFile::from_json(&found.joint_file.to_json().unwrap(), "again").unwrap();
    // the same seed, the same draws
    assert_eq!(run(&text).scatter, found.scatter);
}

/// What was calibrated on the beam itself depends on neither its preload nor, in the damping ratio, on its stiffness.
#[test]
fn a_calibrated_beam_does_not_depend_on_its_preload() {
    let text = STUDY
        .replace(
            "alpha_mu = 0.0021",
            "calibration = { damping_ratio = \"0.01 ± 0.001\", amplitude = 1e-4 }",
        )
        .replace("nut_factor = 0.18", "nut_factor = \"0.18 ± 0.05\"")
        .replace(
            "stiffness_ratio = 0.93",
            "stiffness_ratio = \"0.93 ± 0.01\"",
        )
        .replace("[motion]", "[uncertainty]\ndraws = 40000\n[motion]");
    let found = run(&text);
    let row = |name: &str| found.scatter.iter().find(|row| row.name == name).unwrap();
    let relative = |name: &str| row(name).standard_deviation / row(name).mean;
    close(relative("damping_ratio"), 0.1, 0.05);
    close(relative("k_yy"), 0.01 / 0.93, 0.05);
    close(relative("frequency_hz"), 0.5 * 0.01 / 0.93, 0.05);
    // with the preload it follows where the calibration was on other fasteners
    let other = "amplitude = 1e-4, fasteners = { kind = \"rivet\", diameter = 0.006, count = 4 } }";
    let text = text.replace("amplitude = 1e-4 }", other);
    let found = run(&text);
    let row = found
        .scatter
        .iter()
        .find(|row| row.name == "damping_ratio")
        .unwrap();
    // 1/K of a lognormal has the same relative scatter as K
    let expected = ((1.0 + 0.01_f64) * (1.0 + (0.05_f64 / 0.18).powi(2)) - 1.0).sqrt();
    close(row.standard_deviation / row.mean, expected, 0.05);
}

#[test]
fn a_table_over_the_preload_has_its_scatter() {
    let text = STUDY
        .replace("torque = 4", "torque = [2, 8]")
        .replace("alpha_mu = 0.0021", "alpha_mu = \"0.0021 ± 0.0002\"")
        .replace("[motion]", "[joint]\ndamping = \"linear\"\n[motion]");
    let found = run(&text);
    let uncertainty = found.joint_file.uncertainty.as_ref().unwrap();
    let over = uncertainty.over_preload.as_ref().unwrap();
    let [low, high] = [0, 1].map(|place| over.at[place].standard_deviation.damping[0][0]);
    close(high, 4.0 * low, 1e-2);
    // one friction for both
    let matrix = &over.correlation.as_ref().unwrap().matrix;
    assert!(matrix[1][3] > 0.9999);
    JointFile::from_json(&found.joint_file.to_json().unwrap(), "again").unwrap();
}

#[test]
fn the_example_runs() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/kavi-layered-beam/study.toml");
    let found = LayeredBeamStudy::read(&path).unwrap().run().unwrap();
    let mode = &found.modes[0];
    close(mode.frequency_hz, mode.finite_element_frequency_hz, 1e-6);
    close(found.amplitudes[0].damping_ratio, 0.012, 1e-12);
    found.joint_file.to_json().unwrap();
}
