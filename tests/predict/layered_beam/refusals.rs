//! Studies that make no sense: each message names the file, the key, what was found and what was expected.

use bolted_joint_testing::has;
use std::path::Path;

use bolted_joint::predict::layered_beam::LayeredBeamStudy;
use bolted_joint::study::StudyText;

use super::study::STUDY;

#[track_caller]
fn refused(from: &str, to: &str, parts: &[&str]) {
    assert!(STUDY.contains(from), "{from}");
    let text = STUDY.replacen(from, to, 1);
    let result = LayeredBeamStudy::of(&StudyText::new(text, Path::new("my-study.toml")));
    let error = result
        .and_then(|study| study.run())
        .unwrap_err()
        .to_string();
    assert!(error.starts_with("my-study.toml: "), "{error}");
    for part in parts {
        assert!(error.contains(part), "{part:?} is not in: {error}");
    }
}

#[test]
#[rustfmt::skip]
fn what_is_no_study() {
    refused("method = \"layered-beam\"", "method = \"layered\"", &["line 2", "layered-beam"]);
    refused("width = 0.04125", "widht = 0.04125", &["widht", "line"]);
    refused("name = \"two layers\"", "name = \"\"", &["`name`", "one line of text"]);
    refused("boundary = \"fixed-pinned\"", "boundary = \"clamped\"", &["clamped", "fixed-fixed"]);
}

#[test]
#[rustfmt::skip]
fn what_is_no_beam() {
    refused("length = 0.43", "length = -0.43", &["`beam.length`", "-0.43 m", "positive"]);
    refused("thickness = 0.0024", "thickness = 0", &["`beam.layer.thickness`"]);
    refused("youngs_modulus = 67.6e9", "youngs_modulus = nan", &["`beam.layer.youngs_modulus`", "NaN"]);
    refused("thickness = 0.0024", "thickness = 0.001", &["layers 1 and 2", "3.6000", "1 to 2"]);
    refused("thickness = 0.0024", "thickness = 0.6", &["slender"]);
    refused("stiffness_ratio = 0.93", "stiffness_ratio = 1.2", &["`beam.stiffness_ratio`", "1.2"]);
    let one_layer = "[[beam.layer]]\nthickness = 0.0024\nyoungs_modulus = 67.6e9\ndensity = 2700\n";
    refused(one_layer, "", &["`beam.layer`", "found 1", "at least two"]);
}

#[test]
#[rustfmt::skip]
fn what_are_no_fasteners() {
    refused("0.35]", "0.45]", &["`fasteners.positions`", "0.45 m", "0.43 m"]);
    refused("[0.05, 0.15, 0.25, 0.35]", "[]", &["`fasteners.positions`", "none"]);
    refused("diameter = 0.006", "diameter = 0.05", &["`fasteners.diameter`", "0.04125 m"]);
    refused("torque = 4", "torque = -4", &["`fasteners.torque`", "-4"]);
    refused("torque = 4", "torque = [4, 2]", &["`fasteners.torque`", "ascending"]);
    refused("torque = 4", "preload = 100\ntorque = 4", &["`fasteners`", "both"]);
    refused("torque = 4\nnut_factor = 0.18", "", &["`fasteners`", "preload"]);
    refused("nut_factor = 0.18", "nut_factor = 0", &["`fasteners.nut_factor`"]);
    refused("kind = \"bolt\"", "kind = \"rivet\"", &["`fasteners.torque`", "rivets have a stress"]);
    refused("torque = 4", "torque = 4\nstress = 1e8", &["`fasteners.stress`"]);
    refused("torque = 4", "torque = 4\ncount = 3", &["`fasteners.positions`", "one of them"]);
}

#[test]
#[rustfmt::skip]
fn what_is_no_motion() {
    refused("mode = 2", "mode = 0", &["`motion.mode`", "1 to 100"]);
    refused("modes = 3", "modes = 1", &["`motion.modes`", "at least mode 2"]);
    refused("drive_point = 0.12", "drive_point = 0.5", &["`motion.drive_point`", "0.43 m"]);
    // the node of the second mode of fixed–pinned ends, where tan and tanh cross
    refused("drive_point = 0.12", "drive_point = 0.0", &["`motion.drive_point`", "mode 2 moves", "such as"]);
    refused("from = 5e-5", "from = 0", &["`motion.amplitude`", "positive amplitudes"]);
    refused("from = 5e-5", "from = 2e-4", &["`motion.amplitude`"]);
    refused("count = 3", "count = 1", &["`motion.amplitude.count`"]);
    let free = "boundary = \"free-free\"";
    let text = STUDY.replace("route = \"finite-elements\"", "stored_energy = \"static\"");
    let text = text.replace("boundary = \"fixed-pinned\"", free);
    let study = LayeredBeamStudy::of(&StudyText::new(text, Path::new("my-study.toml"))).unwrap();
    let error = study.run().unwrap_err().to_string();
    assert!(error.contains("held nowhere"), "{error}");
}

#[test]
#[rustfmt::skip]
fn what_is_no_friction() {
    refused("alpha_mu = 0.0021", "alpha_mu = 0", &["`friction.alpha_mu`"]);
    refused("alpha_mu = 0.0021", "", &["`friction`", "neither", "alpha_mu"]);
    let both = "alpha_mu = 0.0021\ncalibration = { damping_ratio = 0.01, amplitude = 1e-4 }";
    refused("alpha_mu = 0.0021", both, &["`friction`", "both"]);
    let measured = "calibration = { damping_ratio = -0.01, amplitude = 1e-4 }";
    refused("alpha_mu = 0.0021", measured, &["`friction.calibration.damping_ratio`"]);
    // the only fastener where the mode has no slope
    let text = STUDY
        .replace("fixed-pinned", "pinned-pinned")
        .replace("[0.05, 0.15, 0.25, 0.35]", "[0.1075]");
    let study = LayeredBeamStudy::of(&StudyText::new(text, Path::new("my-study.toml"))).unwrap();
    let error = study.run().unwrap_err().to_string();
    has(&error, &["no fastener where mode 2 has a slope"]);
}

#[test]
#[rustfmt::skip]
fn what_is_no_scatter() {
    refused("[motion]", "[uncertainty]\ndraws = 100\n[motion]", &["`uncertainty`", "standard deviation"]);
    refused("alpha_mu = 0.0021", "alpha_mu = \"0.0021 ± -1\"", &["line", "-1"]);
    let draws = "alpha_mu = \"0.0021 ± 0.0001\"\n[uncertainty]\ndraws = 1";
    refused("alpha_mu = 0.0021", draws, &["`uncertainty.draws`", "2 to"]);
    let own = "calibration = { damping_ratio = 0.01, amplitude = 1e-4, fasteners = { kind = \"rivet\", diameter = 0.006, count = 4, stress = \"1e8 ± 1e7\" } }";
    refused("alpha_mu = 0.0021", own, &["`friction.calibration`", "damping_ratio"]);
}

#[test]
fn what_is_no_joint() {
    let linear = "[joint]\namplitude = 1e-4\n[motion]";
    refused("[motion]", linear, &["`joint.amplitude`", "linear"]);
    let nominal = "[joint]\nnominal_torque = 4\n[motion]";
    refused("[motion]", nominal, &["`joint.nominal_torque`"]);
    let text = STUDY.replace("torque = 4", "torque = [2, 4]");
    let text = text.replace(
        "[motion]",
        "[joint]\ndamping = \"linear\"\nnominal_torque = 9\n[motion]",
    );
    let error = LayeredBeamStudy::of(&StudyText::new(text, Path::new("my-study.toml")))
        .unwrap_err()
        .to_string();
    has(
        &error,
        &["`joint.nominal_torque`: found 9, expected 2 to 4 N·m"],
    );
}
