//! Contacts of rough surfaces over a field of 100,000 points.

use std::hint::black_box;
use std::process::Command;
use std::time::Instant;

use bolted_joint::predict::fractal::{FractalContact, Friction, PerArea};
use bolted_joint::predict::pressure::{Element, PressureField};
use bolted_joint::predict::surface::Roughness;
use bolted_joint::predict::{Material, Pair};
use criterion::Criterion;
use serde_json::Value;

const POINTS: u32 = 100_000;
const LIMIT_S: f64 = 0.1;
const REPETITIONS: usize = 21;

/// Zhao's specimen, with a shear stress in the contacts.
fn contact() -> FractalContact {
    let part = Material::new(1.5e11, 0.28).unwrap();
    let friction = Friction {
        coefficient: 0.15,
        shear_strength_pa: 2e7,
    };
    FractalContact::new(
        &Pair { a: part, b: part },
        Roughness::new(1.42, 1.21e-8).unwrap(),
        1.96e9,
        friction,
        0.06,
    )
    .unwrap()
}

/// Pressures from 1 kPa to 20 MPa, equally spaced in their logarithm by the golden ratio and so in no order.
fn pressures() -> impl Iterator<Item = f64> {
    (0..POINTS).map(|n| 1e3 * 2e4_f64.powf((f64::from(n) * 0.618_033_988_749_894_9).fract()))
}

fn field() -> PressureField {
    let elements = pressures().map(|pressure_pa| Element {
        x_m: 0.0,
        y_m: 0.0,
        area_m2: 0.06 / f64::from(POINTS),
        pressure_pa,
    });
    PressureField::new(elements.collect()).unwrap()
}

/// Sums over the points, which NumPy must find again.
fn sums(found: &[PerArea]) -> [f64; 4] {
    let sum = |of: fn(&PerArea) -> f64| found.iter().map(of).sum();
    [
        sum(|one| one.normal_stiffness_n_per_m3),
        sum(|one| one.tangential_stiffness_n_per_m3),
        sum(|one| one.normal_loss_factor * one.normal_stiffness_n_per_m3),
        sum(|one| one.tangential_loss_factor * one.tangential_stiffness_n_per_m3),
    ]
}

/// What NumPy needs, s, and its sums.
fn in_numpy() -> Option<(f64, Vec<f64>)> {
    let python = std::env::var("PYTHON").unwrap_or_else(|_| "python3".to_owned());
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/predict/fractal_field.py");
    let done = Command::new(&python)
        .args([script, &POINTS.to_string()])
        .output()
        .ok()?;
    if !done.status.success() {
        let said = String::from_utf8_lossy(&done.stderr);
        println!(
            "not compared with NumPy: {python}: {}",
            said.lines().last().unwrap_or_default()
        );
        return None;
    }
    let value: Value = serde_json::from_slice(&done.stdout).unwrap();
    let sums = serde_json::from_value(value["sums"].clone()).unwrap();
    Some((value["seconds"].as_f64()?, sums))
}

/// Prints the time of the field, checks it against its limit and against NumPy.
pub(crate) fn compare() {
    let (contact, field) = (contact(), field());
    let timed = || {
        let begun = Instant::now();
        black_box(contact.over(&field).unwrap());
        begun.elapsed().as_secs_f64()
    };
    let ours_s = (0..REPETITIONS).map(|_| timed()).fold(f64::MAX, f64::min);
    println!(
        "field of {POINTS} points: {:.1} ms, {:.0} ns a point",
        1e3 * ours_s,
        1e9 * ours_s / f64::from(POINTS)
    );
    assert!(ours_s < LIMIT_S, "more than {LIMIT_S} s");
    if let Some((numpy_s, theirs)) = in_numpy() {
        let ours = sums(&contact.over(&field).unwrap());
        let apart = ours
            .iter()
            .zip(&theirs)
            .map(|(ours, theirs)| (ours / theirs - 1.0).abs())
            .fold(0.0, f64::max);
        println!(
            "NumPy: {:.1} ms, {:.1} times as long, apart by {apart:.1e} at most",
            1e3 * numpy_s,
            numpy_s / ours_s
        );
        assert!(apart < 1e-9, "NumPy has other sums");
    }
}

pub(crate) fn bench(criterion: &mut Criterion) {
    let (contact, field) = (contact(), field());
    criterion.bench_function("field of 100,000 points", |bencher| {
        bencher.iter(|| contact.over(&field).unwrap());
    });
}
