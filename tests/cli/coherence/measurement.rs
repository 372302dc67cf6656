//! Functions of the rig with the noise that their coherence means, and files of every format that hold both.

use std::f64::consts::{FRAC_1_SQRT_2, TAU};
use std::fmt::Write as _;
use std::io::{Cursor, Write as _};
use std::sync::LazyLock;

use num_complex::Complex64;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use rand_distr::{Distribution, StandardNormal};
use zip::ZipWriter;
use zip::write::SimpleFileOptions;

use crate::rig::{
    AXIS, FIRST_HZ, FULL, LINES, Point, Quantity, STEP_HZ, assembled, first_bolt, function,
    points_of_b, receptance,
};

/// Averages behind every function: so many that each line tells its noise by itself.
pub(super) const AVERAGES: f64 = 42.0;

/// ω of each line.
pub(super) static OMEGAS: LazyLock<Vec<f64>> =
    LazyLock::new(|| frequencies().iter().map(|hz| TAU * hz).collect());

fn frequencies() -> Vec<f64> {
    (0..LINES)
        .map(|line| FIRST_HZ + STEP_HZ * line as f64)
        .collect()
}

/// A measured function with its coherence.
pub(super) struct Measured {
    pub(super) response: Point,
    pub(super) reference: Point,
    pub(super) values: Vec<Complex64>,
    gamma_squared: Vec<f64>,
    /// σ² of each line, (m/N)².
    pub(super) variance: Vec<f64>,
}

impl Measured {
    /// `exact` values with noise of the variance that `gamma_squared` means, and the coherence that an analyser tells beside
    /// them: that of the values with their errors.
    pub(super) fn new(
        (response, reference): (Point, Point),
        exact: impl Fn(f64) -> Complex64,
        gamma_squared: impl Fn(usize) -> f64,
        generator: &mut ChaCha8Rng,
    ) -> Self {
        // As the files state it.
        let rounded = |value: f64| format!("{value:.12e}").parse::<f64>().unwrap();
        let (mut values, mut told, mut variance) = (Vec::new(), Vec::new(), Vec::new());
        for line in 0..LINES {
            let (exact, gamma) = (exact(OMEGAS[line]), gamma_squared(line));
            // σ²/|H|² = (1 − γ²)/((n − 2) γ²), whose inverse has the mean of that of the variance
            let own = exact.norm_sqr() * (1.0 - gamma) / ((AVERAGES - 2.0) * gamma);
            let part = own.sqrt() * FRAC_1_SQRT_2;
            let mut normal = || -> f64 { StandardNormal.sample(generator) };
            let value = exact + Complex64::new(part * normal(), part * normal());
            let value = Complex64::new(rounded(value.re), rounded(value.im));
            // γ²/(1 − γ²) = |Ĥ|²/((n − 2) σ²)
            told.push(rounded(
                value.norm_sqr() / (value.norm_sqr() + (AVERAGES - 2.0) * own),
            ));
            values.push(value);
            variance.push(own);
        }
        Self {
            response,
            reference,
            values,
            gamma_squared: told,
            variance,
        }
    }
}

/// The nine functions of the assembly; `gamma_squared` of response, reference and line.
pub(super) fn assembly(
    seed: u64,
    gamma_squared: impl Fn(usize, usize, usize) -> f64,
) -> Vec<Measured> {
    let mut generator = ChaCha8Rng::seed_from_u64(seed);
    let points = points_of_b();
    let mut functions = Vec::new();
    for (p, &response) in points.iter().enumerate() {
        for (q, &reference) in points.iter().enumerate() {
            functions.push(Measured::new(
                (response, reference),
                |omega| receptance(&assembled(&[first_bolt(FULL)], omega), response, reference),
                |line| gamma_squared(p, q, line),
                &mut generator,
            ));
        }
    }
    functions
}

/// The same functions with a coherence but without the noise that it means: they are found at once.
pub(super) fn silent_assembly() -> Vec<Measured> {
    let mut functions = assembly(1, |_, _, _| 1.0);
    for function in &mut functions {
        function.gamma_squared.fill(0.9);
    }
    functions
}

/// A universal file: each function, then its coherence as a data set 58 of type 6, real and double.
pub(super) fn universal_file(functions: &[Measured]) -> String {
    let mut text = String::new();
    for one in functions {
        text += &function(
            one.response,
            one.reference,
            Quantity::Receptance,
            &one.values,
        );
    }
    for one in functions {
        text += "    -1\n    58\nNONE\nNONE\nNONE\nNONE\nNONE\n";
        let (response, reference) = (one.response.node, one.reference.node);
        let _ = writeln!(
            text,
            "    6         0    0         0 NONE      {response:>10}   2 NONE      {reference:>10}   2"
        );
        let _ = writeln!(text, "{:>10}{LINES:>10}{:>10}{AXIS}{:>13.5e}", 4, 1, 0.0);
        for data_type in [18, 0, 0, 0] {
            let _ = writeln!(
                text,
                "{data_type:>10}    0    0    0 NONE                 NONE"
            );
        }
        for four in one.gamma_squared.chunks(4) {
            for value in four {
                let _ = write!(text, "{value:>20.12e}");
            }
            text.push('\n');
        }
        text += "    -1\n";
    }
    text
}

/// A table that states the averages.
pub(super) fn table(functions: &[Measured]) -> String {
    let mut text =
        format!("# averages = {AVERAGES}\n# quantity = receptance\n# unit = m/N\nfrequency [Hz]");
    for one in functions {
        let pair = format!("{}:+Y/{}:+Y", one.response.node, one.reference.node);
        let _ = write!(text, ",{pair} real,{pair} imaginary,{pair} coherence");
    }
    for (line, hz) in frequencies().iter().enumerate() {
        let _ = write!(text, "\n{hz}");
        for one in functions {
            let (value, gamma) = (one.values[line], one.gamma_squared[line]);
            let _ = write!(text, ",{:e},{:e},{gamma:e}", value.re, value.im);
        }
    }
    text + "\n"
}

/// A NumPy archive that states the averages, functions over lines, responses and references.
pub(super) fn archive(functions: &[Measured]) -> Vec<u8> {
    let points = points_of_b();
    let count = points.len();
    let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
    let mut array = |name: &str, descr: &str, shape: &str, bytes: &[u8]| {
        let options = SimpleFileOptions::default();
        zip.start_file(format!("{name}.npy"), options).unwrap();
        let header =
            format!("{{'descr': '{descr}', 'fortran_order': False, 'shape': {shape}, }}\n");
        zip.write_all(b"\x93NUMPY\x01\x00").unwrap();
        zip.write_all(&(header.len() as u16).to_le_bytes()).unwrap();
        zip.write_all(header.as_bytes()).unwrap();
        zip.write_all(bytes).unwrap();
    };
    let numbers = |numbers: Vec<f64>| -> Vec<u8> {
        numbers
            .iter()
            .flat_map(|number| number.to_le_bytes())
            .collect()
    };
    let lines = || (0..LINES).flat_map(|line| functions.iter().map(move |one| (line, one)));
    let names: String = points
        .iter()
        .map(|point| format!("{}:+Y", point.node))
        .collect();
    let matrix = format!("({LINES}, {count}, {count})");
    array(
        "frequency",
        "<f8",
        &format!("({LINES},)"),
        &numbers(frequencies()),
    );
    let values = lines().flat_map(|(line, one)| [one.values[line].re, one.values[line].im]);
    array("receptance", "<c16", &matrix, &numbers(values.collect()));
    let gamma = lines().map(|(line, one)| one.gamma_squared[line]);
    array("coherence", "<f8", &matrix, &numbers(gamma.collect()));
    array("response", "|S5", &format!("({count},)"), names.as_bytes());
    array("reference", "|S5", &format!("({count},)"), names.as_bytes());
    array("axes", "|S28", "()", b"frequency,response,reference");
    array("unit", "|S3", "()", b"m/N");
    array("averages", "<f8", "()", &AVERAGES.to_le_bytes());
    zip.finish().unwrap().into_inner()
}
