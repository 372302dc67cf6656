//! How long a step of a whole assembly takes, and how long it takes to prepare its length.
//!
//! `cargo bench --bench assembly`: two beams, with 40 modes and a cubic joint in steps of 1e-4 s, and with 200 modes and five
//! joints in steps of 1e-5 s, as the library of an FMU takes them. Where a step takes less than its length the assembly runs
//! faster than real time.

#![allow(clippy::unwrap_used, reason = "a benchmark that fails stops")]

use std::fmt::Write as _;
use std::hint::black_box;

use bolted_joint::assembly::AssemblyModel;
use bolted_joint::study::StudyText;
use bolted_joint_dynamics::assembly::{AssemblySteps, TOLERANCE};
use criterion::{Criterion, criterion_group, criterion_main};

const JOINT: &str = r#"{"format": "bolted-joint/1", "name": "lap", "joint": {"dofs": ["y"], "stiffness": [[5.73e5]],
    "damping": [[10.83]], "cubic": [4e15]}}"#;

/// Two beams with so many modes each, joined at so many places.
fn beams(modes: usize, joints: usize) -> AssemblyModel {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("lap.joint.json"), JOINT).unwrap();
    // one joint along y is a hinge
    let mut text = String::from("name = \"beams\"\nmechanisms = true\n");
    for (name, boundary) in [("a", "fixed-free"), ("b", "free-free")] {
        let points: Vec<String> = (0..joints)
            .map(|joint| format!("\"{}:+Y\" = {}", joint + 1, 0.3 - 0.05 * joint as f64))
            .collect();
        write!(
            text,
            "[structures.{name}]\nmodes = {modes}\npoints = {{ {}, \"99:+Y\" = 0.29 }}\nbeam = {{ length = 0.3, width = 0.03, \
             height = 0.006, youngs_modulus = 70e9, density = 2700, boundary = \"{boundary}\", damping_ratio = 0.005 }}\n",
            points.join(", ")
        )
        .unwrap();
    }
    for joint in 1..=joints {
        let side =
            |name: &str| format!("{name} = {{ structure = \"{name}\", y = \"{joint}:+Y\" }}\n");
        write!(
            text,
            "[[joints]]\nfile = \"lap.joint.json\"\n{}{}",
            side("a"),
            side("b")
        )
        .unwrap();
    }
    text += "[inputs]\npush = \"b/99:+Y\"\n[outputs]\ntip = \"b/99:+Y\"\n";
    AssemblyModel::of(&StudyText::new(text, &folder.path().join("beams.toml"))).unwrap()
}

fn assemblies(criterion: &mut Criterion) {
    // as the library does
    library::use_all_of_it();
    for (modes, joints, step_s) in [(20, 1, 1e-4), (100, 5, 1e-5)] {
        let model = beams(modes, joints);
        let equations = model.equations().unwrap();
        let name = format!("{} modes, {joints} cubic joints, {step_s:e} s", 2 * modes);
        let mut group = criterion.benchmark_group(name);
        group.sample_size(10);
        group.bench_function("preparing the length", |bencher| {
            bencher.iter(|| AssemblySteps::new(black_box(&equations), step_s, TOLERANCE));
        });
        let mut steps = AssemblySteps::new(&equations, step_s, TOLERANCE).unwrap();
        let mut underway = steps.at_rest();
        let mut count = 0_u32;
        group.bench_function("a step", |bencher| {
            bencher.iter(|| {
                count += 1;
                let load =
                    30.0 * (2.0 * std::f64::consts::PI * 700.0 * step_s * f64::from(count)).sin();
                steps.step(&mut underway, &[black_box(load)], &[0.0])
            });
        });
        group.finish();
    }
}

criterion_group!(benches, assemblies);
criterion_main!(benches);
