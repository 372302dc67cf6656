//! Terms from a free decay and from a backbone, which an independent integration and a quadrature of the period supply.

use bolted_joint_testing::close;
use std::f64::consts::{FRAC_PI_2, TAU};
use std::fmt::Write as _;
use std::path::Path;

use bolted_joint::identify::lap::{LapResponse, LapResponseStudy, ResponseUnknown, Term};

/// The relative mode (m/2) r̈ + (c12 + c2 r²) ṙ + k12 r + kN r³ = 0.
const MASS: f64 = 2.0;
const K12: f64 = 5.0e5;
const C12: f64 = 3.0;
const KN: f64 = -4.0e11;
const C2: f64 = 2.0e8;
const LARGEST_M: f64 = 3.0e-4;

fn acceleration(r: f64, v: f64) -> f64 {
    -((C12 + C2 * r * r) * v + K12 * r + KN * r * r * r) / (0.5 * MASS)
}

/// r at t = 0, `interval_s`, …, by the fourth-order Runge–Kutta–Nyström scheme in 400 steps a period.
fn decay(count: usize, interval_s: f64) -> Vec<f64> {
    let (mut r, mut v) = (LARGEST_M, 0.0);
    let steps = 4;
    let h = interval_s / f64::from(steps);
    let mut found = Vec::with_capacity(count);
    for _ in 0..count {
        found.push(r);
        for _ in 0..steps {
            let k1 = h * acceleration(r, v);
            let k2 = h * acceleration(r + 0.5 * h * (v + 0.25 * k1), v + 0.5 * k1);
            let k3 = h * acceleration(r + 0.5 * h * (v + 0.25 * k1), v + 0.5 * k2);
            let k4 = h * acceleration(r + h * (v + 0.5 * k3), v + k3);
            r += h * (v + (k1 + k2 + k3) / 6.0);
            v += (k1 + 2.0 * (k2 + k3) + k4) / 6.0;
        }
    }
    found
}

/// Frequency of the undamped motion: ω = 2π/T, T = 4 ∫ dr/ṙ with r = a sin φ, by the trapezoidal rule, which is exact for a periodic integrand.
fn frequency_hz(amplitude_m: f64) -> f64 {
    let count = 64;
    let rate = |n: usize| {
        let sine = (FRAC_PI_2 * (n as f64 + 0.5) / count as f64).sin();
        let stiffness = K12 + 0.5 * KN * amplitude_m * amplitude_m * (1.0 + sine * sine);
        (stiffness / (0.5 * MASS)).sqrt()
    };
    let mean = (0..count).map(|n| rate(n).recip()).sum::<f64>() / count as f64;
    (TAU * mean).recip()
}

/// What one harmonic leaves of the period goes into the term of next order, k5, which there is none of.
fn identified(folder: &Path, table: &str, terms: &str) -> LapResponse {
    let study = format!(
        "method = \"lap-response\"\nname = \"free\"\n[model]\ndrive = \"relative\"\nresponse = \"relative\"\nterms = {terms}\n\
         [known]\nm = 2.0\n[[{table}]]\nfile = \"{table}.csv\"\n"
    );
    let path = folder.join("study.toml");
    std::fs::write(&path, study).unwrap();
    let study = LapResponseStudy::read(&path).unwrap_or_else(|error| panic!("{error}"));
    LapResponse::of(&study, &|| {}).unwrap()
}

/// k12, c12, k3 and c2 are found within these tolerances.
#[track_caller]
fn assert_close(found: &LapResponse, tolerances: [f64; 4]) {
    let growing = Term::named("c2").unwrap();
    let expected = [
        (ResponseUnknown::JointStiffness, K12),
        (ResponseUnknown::JointDamping, C12),
        (ResponseUnknown::Term(Term::CUBIC), KN),
        (ResponseUnknown::Term(growing), C2),
    ];
    for ((unknown, expected), tolerance) in expected.into_iter().zip(tolerances) {
        close(found.fit.values.of(unknown), expected, tolerance);
    }
}

#[test]
fn a_free_decay_tells_softening_and_growing_damping() {
    let folder = tempfile::tempdir().unwrap();
    let interval_s = 1.0e-4;
    let mut csv = "time_s,displacement_m\n".to_owned();
    for (n, r) in decay(12_000, interval_s).iter().enumerate() {
        writeln!(csv, "{:e},{r:e}", n as f64 * interval_s).unwrap();
    }
    std::fs::write(folder.path().join("decay.csv"), csv).unwrap();
    let found = identified(folder.path(), "decay", "[\"k3\", \"k5\", \"c2\"]");
    assert_close(&found, [1e-4, 2e-2, 1e-2, 3e-2]);
}

#[test]
fn a_backbone_with_its_damping_tells_the_same() {
    let folder = tempfile::tempdir().unwrap();
    let mut csv = "frequency_hz,displacement_m,damping_ratio\n".to_owned();
    for n in 1..=15 {
        let amplitude_m = LARGEST_M * f64::from(n) / 15.0;
        let hz = frequency_hz(amplitude_m);
        // A cycle of r = a cos ωt takes π ω (c12 a² + c2 a⁴/4); ζ = c_eq/(2 (m/2) ω).
        let damping = C12 + 0.25 * C2 * amplitude_m * amplitude_m;
        let ratio = damping / (MASS * TAU * hz);
        writeln!(csv, "{hz:e},{amplitude_m:e},{ratio:e}").unwrap();
    }
    std::fs::write(folder.path().join("backbone.csv"), csv).unwrap();
    let found = identified(folder.path(), "backbone", "[\"k3\", \"k5\", \"c2\"]");
    assert_close(&found, [1e-5, 1e-3, 5e-3, 1e-3]);
}
