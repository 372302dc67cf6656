//! `predict`: from a study to joint file, FMU and files for finite-element programs, and what it says of studies that are wrong.

mod bad;
mod good;

use crate::bench::Bench;

/// Four bolts on milled iron, by one torque, without any doubt.
const STUDY: &str = r#"method = "fractal-contact"
name = "Four M8 on milled iron"
notes = ["A made-up joint."]

[materials.a]
youngs_modulus = 1.5e11
poissons_ratio = 0.28
[materials.b]
youngs_modulus = 1.5e11
poissons_ratio = 0.28

[surface]
fractal_dimension = 1.42
roughness = 1.21e-8

[contact]
hardness = 1.96e9
friction = 0.3
shear_strength = 1e8

[interface]
x = [-0.06, 0.06]
y = [-0.04, 0.04]
elements = [60, 40]

[pressure]
model = "kavi"
thickness = [0.01, 0.01]

[[bolts]]
x = -0.04
y = -0.02
diameter = 0.008
torque = 20
[[bolts]]
x = 0.04
y = -0.02
diameter = 0.008
torque = 20
[[bolts]]
x = -0.04
y = 0.02
diameter = 0.008
torque = 20
[[bolts]]
x = 0.04
y = 0.02
diameter = 0.008
torque = 20

[tightening]
nut_factor = 0.2

[joint]
translation = "z"
rotation = "-y"

[damping]
frequency = 300
"#;

/// The study with its bolts tightened as a table says.
fn over_torque() -> String {
    STUDY.replace("torque = 20\n", "").replace(
        "nut_factor = 0.2\n",
        "nut_factor = 0.2\ntorques = [5, 10, 15, 20, 25]\nnominal = 20\n",
    )
}

fn bench(study: &str) -> Bench {
    let bench = Bench::new();
    bench.write("study.toml", study);
    bench
}

const PREDICT: [&str; 4] = ["predict", "study.toml", "-o", "j.joint.json"];
