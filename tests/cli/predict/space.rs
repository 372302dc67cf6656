//! Interfaces whose joint file has motions in space.

use bolted_joint_testing::{close, has};
use serde_json::Value;

use super::{PREDICT, bench, over_torque};
use crate::bench::replaced;

/// That of the study's damping.
const FREQUENCY_HZ: f64 = 300.0;

const PLANE: &str = "translation = \"z\"\nrotation = \"-y\"";

fn matrix(value: &Value) -> Vec<Vec<f64>> {
    serde_json::from_value(value.clone()).unwrap()
}

/// The study over the torque with other motions.
fn with(joint: &str) -> String {
    replaced(&over_torque(), PLANE, joint)
}

#[test]
fn the_whole_interface_becomes_a_joint_with_six_degrees_of_freedom() {
    let space = bench(&with(
        "dofs = [\"x\", \"y\", \"z\", \"rx\", \"ry\", \"rz\"]",
    ));
    let outcome = space.done(&format!("{PREDICT} --json"));
    let told: Value = serde_json::from_str(&outcome.stdout).unwrap();
    let file = space.json("j.joint.json");
    assert_eq!(
        file["joint"]["dofs"],
        serde_json::json!(["x", "y", "z", "rx", "ry", "rz"])
    );
    let table = &file["joint"]["over_preload"];
    for (place, state) in told["states"].as_array().unwrap().iter().enumerate() {
        // C = H/ω + C_viscous
        let omega = std::f64::consts::TAU * FREQUENCY_HZ;
        let [stiffness, hysteretic, viscous] =
            ["stiffness", "hysteretic_damping", "viscous_damping"].map(|key| matrix(&state[key]));
        let mut damping = viscous;
        for (i, j) in (0..6).flat_map(|i| (0..6).map(move |j| (i, j))) {
            damping[i][j] += hysteretic[i][j] / omega;
        }
        for (key, expected) in [("stiffness", stiffness), ("damping", damping)] {
            let found = matrix(&table[key][place]);
            for (i, j) in (0..6).flat_map(|i| (0..6).map(move |j| (i, j))) {
                let scale = (expected[i][i] * expected[j][j]).sqrt();
                let difference = (found[i][j] - expected[i][j]).abs();
                assert!(difference <= 1e-12 * scale, "{key} {i} {j}");
            }
        }
    }
    // the joint in a plane is a part of it: y is z, and theta −ry
    let plane = bench(&over_torque());
    plane.done(PREDICT);
    let planar = plane.json("j.joint.json");
    let (part, whole) = (
        matrix(&planar["joint"]["over_preload"]["stiffness"][0]),
        matrix(&table["stiffness"][0]),
    );
    close(part[0][0], whole[2][2], 1e-14);
    close(part[1][1], whole[4][4], 1e-14);
    assert!((part[0][1] + whole[2][4]).abs() <= 1e-12 * (whole[2][2] * whole[4][4]).sqrt());
    // and the FMU has them all
    space.done("export j.joint.json -o j.fmu");
    let checked = space.done("check j.fmu");
    has(&checked.stdout, &["\"rz\"", "no problem found"]);
}

#[test]
fn motions_are_those_of_a_plane_or_of_space() {
    for (joint, found) in [
        ("", "neither joint.translation nor joint.dofs"),
        (
            "translation = \"z\"\ndofs = [\"x\", \"z\"]",
            "joint.dofs beside joint.translation",
        ),
        ("dofs = [\"z\", \"x\"]", "[\"z\", \"x\"]"),
        ("dofs = [\"y\"]", "[\"y\"]"),
        ("dofs = [\"theta\"]", "[\"theta\"]"),
    ] {
        bench(&with(joint)).refused(PREDICT, &[found, "\"rx\"", "in this order"]);
    }
}
