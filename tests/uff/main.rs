//! Universal files: read from other programs, refused where broken, and written so that they come back unchanged.
#![allow(
    clippy::unwrap_used,
    clippy::panic,
    reason = "helpers of tests fail as the tests do"
)]

mod binary;
mod broken;
mod foreign;
mod written;

use std::f64::consts::TAU;
use std::path::Path;

use bolted_joint_testing::has;

use bolted_joint::frf::{
    Dof, Frf, FrfError, FrfReading, FrfSet, ReadOptions, UffProblem, read_uff58, read_uff58_from,
};
use num_complex::Complex64;

fn dof(text: &str) -> Dof {
    text.parse().unwrap()
}

fn read(path: &Path) -> FrfReading {
    read_uff58(path, &ReadOptions::default()).unwrap()
}

fn read_text(text: impl AsRef<[u8]>) -> Result<FrfReading, FrfError> {
    read_uff58_from(text.as_ref(), "memory.uff", &ReadOptions::default())
}

/// The line and the problem of a text that is not usable.
fn problem_of(text: impl AsRef<[u8]>) -> (usize, UffProblem) {
    match read_text(text).unwrap_err() {
        FrfError::Uff {
            line,
            problem,
            path,
        } => {
            assert_eq!(path, Path::new("memory.uff"));
            (line, problem)
        }
        other => panic!("{other}"),
    }
}

/// The problem of a text stands at its line; all `parts` are in its name, its fields, or its message.
#[track_caller]
fn is_refused(text: impl AsRef<[u8]>, line: usize, parts: &[&str]) {
    let (found, problem) = problem_of(text);
    assert_eq!(found, line, "{problem}");
    has(&format!("{problem:?}: {problem}"), parts);
}

/// Receptance of the oscillator behind the files of this test, m/N.
fn oscillator(frequency_hz: f64) -> Complex64 {
    let s = Complex64::new(0.0, TAU * frequency_hz);
    // H = 1/(m s² + c s + k)
    1.0 / (2.0 * s * s + 8.0 * s + 8e4)
}

/// Functions that are multiples of it.
fn oscillators(frequency_hz: &[f64], functions: &[(&str, &str, f64)]) -> FrfSet {
    let function = |&(response, reference, factor): &(&str, &str, f64)| {
        let values = frequency_hz.iter().map(|&hz| factor * oscillator(hz));
        let axis = frequency_hz.to_vec();
        Frf::new(dof(response), dof(reference), axis, values.collect()).unwrap()
    };
    FrfSet::new(functions.iter().map(function).collect()).unwrap()
}
