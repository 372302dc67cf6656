//! Tables, NumPy archives and MATLAB files: those of NumPy and SciPy, every fault by its place, and none that panics.
#![allow(
    clippy::unwrap_used,
    clippy::panic,
    reason = "helpers of tests fail as the tests do"
)]

mod archive;
mod junk;
mod matlab;
mod table;

use bolted_joint_testing::near;
use std::f64::consts::TAU;
use std::path::{Path, PathBuf};

use bolted_joint::frf::{Dof, FrfSet, ReadOptions, read_frfs};
use num_complex::Complex64;

fn dof(text: &str) -> Dof {
    text.parse().unwrap()
}

fn own_file(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("tests/data/arrays")
        .join(name)
}

fn set(name: &str) -> FrfSet {
    read_frfs(own_file(name), &ReadOptions::default())
        .unwrap()
        .into_set()
        .unwrap()
}

fn message(name: &str) -> String {
    read_frfs(own_file(name), &ReadOptions::default())
        .unwrap_err()
        .to_string()
}

/// Receptance of the oscillator behind the files of this test, m/N.
fn oscillator(frequency_hz: f64) -> Complex64 {
    let s = Complex64::new(0.0, TAU * frequency_hz);
    // H = 1/(m s² + c s + k)
    1.0 / (2.0 * s * s + 8.0 * s + 8e4)
}

const FACTORS: [(&str, &str, f64); 6] = [
    ("11:+Y", "2:+Y", 1.0),
    ("11:+Y", "3:+Y", 0.5),
    ("12:-Y", "2:+Y", -2.0),
    ("12:-Y", "3:+Y", 3.0),
    ("13:+RZ", "2:+Y", 0.25),
    ("13:+RZ", "3:+Y", 7.0),
];

fn is_oscillator(set: &FrfSet, pairs: &[(&str, &str, f64)], tolerance: f64) {
    assert_eq!(set.functions().len(), pairs.len());
    assert_eq!(set.frequency_hz(), [5.0, 7.5, 10.0, 12.5, 15.0, 17.5, 20.0]);
    for &(response, reference, factor) in pairs {
        let found = set.receptance(dof(response), dof(reference)).unwrap();
        for (&value, &hz) in found.iter().zip(set.frequency_hz()) {
            let expected = factor * oscillator(hz);
            let place = format!("{response} / {reference}, {hz} Hz");
            let error = (value - expected).norm();
            assert!(error <= tolerance * expected.norm(), "{place}: {value}");
        }
    }
}

/// γ² = 1/(1 + 0.01 i) and ten averages: |H|² (1 − γ²)/(n γ²) is 0.001 i |H|², of which three lines together are multiplied by
/// n/(3 (n − 1) − 1).
fn has_variance(set: &FrfSet, tolerance: f64) {
    let variance = set.relative_variance(dof("11:Y"), dof("2:Y")).unwrap();
    assert_eq!(variance.len(), 7);
    let power = |line: usize| oscillator(set.frequency_hz()[line]).norm_sqr();
    for (line, found) in variance.iter().enumerate() {
        let first = line.saturating_sub(1).min(4);
        let three = (first..first + 3).map(|line| 1e-3 * (line + 1) as f64 * power(line));
        let expected = 10.0 / 26.0 * three.sum::<f64>() / power(line);
        near(found / expected, 1.0, 100.0 * tolerance);
    }
}
