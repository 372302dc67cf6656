//! Backbones and stepped sines of laws that slip, by quadrature of their loops, with noise; and studies of them.

use std::f64::consts::{FRAC_1_SQRT_2, PI, TAU};
use std::fmt::Write as _;
use std::path::Path;

use bolted_joint::identify::lap::{LapResponse, LapResponseStudy};
use bolted_joint::joint::JointFile;
use num_complex::Complex64;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use rand_distr::{Distribution, StandardNormal};

pub(crate) const MASS: f64 = 2.0;
pub(crate) const K0: f64 = 5.0e5;
pub(crate) const C12: f64 = 2.0;
pub(crate) const LARGEST_M: f64 = 3.0e-4;
pub(crate) const FREQUENCY: f64 = 1e-4;
pub(crate) const DAMPING: f64 = 0.01;
/// Of a complex response.
pub(crate) const RESPONSE: f64 = 0.01;

/// F(u) of a first motion to u ≥ 0.
pub(crate) type FirstLoading = dyn Fn(f64) -> f64;

/// Segalman's law by its density R φ^χ of sliders up to φ_max and S there.
pub(crate) fn iwan(density: f64, exponent: f64, span: f64, last: f64) -> impl Fn(f64) -> f64 {
    move |u: f64| {
        let v = u.min(span);
        // ∫ρ min(u, φ) dφ
        let slipped = density * v.powf(exponent + 2.0) / (exponent + 2.0);
        let sticks =
            density * (span.powf(exponent + 1.0) - v.powf(exponent + 1.0)) / (exponent + 1.0);
        slipped + u * sticks + last * v
    }
}

/// Stiffness and loss at an amplitude, (a₁/U, −b₁/U), by the midpoint rule over the way back from the turn.
pub(crate) fn equivalent(first_loading: &FirstLoading, amplitude: f64) -> [f64; 2] {
    let count = 50_000;
    let mut sums = [0.0; 2];
    for n in 0..count {
        let theta = PI * (f64::from(n) + 0.5) / f64::from(count);
        let way = 0.5 * amplitude * (1.0 - theta.cos());
        let load = first_loading(amplitude) - 2.0 * first_loading(way);
        sums[0] += load * theta.cos();
        sums[1] += load * theta.sin();
    }
    let part = 2.0 / f64::from(count) / amplitude;
    [sums[0] * part, -sums[1] * part]
}

/// Amplitude, frequency (Hz) and damping ratio of each point; `small` is the law's stiffness of small motion.
pub(crate) fn backbone(first_loading: &FirstLoading, small: f64) -> Vec<[f64; 3]> {
    let amplitudes = (1..=40).map(|n| LARGEST_M * (f64::from(n) / 40.0).powi(2));
    let of = |amplitude| point(first_loading, small, amplitude);
    amplitudes.map(of).collect()
}

pub(crate) fn point(first_loading: &FirstLoading, small: f64, amplitude: f64) -> [f64; 3] {
    let [stiffness, loss] = equivalent(first_loading, amplitude);
    // the spring beside the law leaves K0 for small motion
    let omega = ((K0 - small + stiffness) / (0.5 * MASS)).sqrt();
    [
        amplitude,
        omega / TAU,
        (C12 * omega + loss) / (MASS * omega * omega),
    ]
}

/// What was measured, without its noise.
pub(crate) enum Measured {
    /// Amplitude (m), frequency (Hz) and damping ratio of each point.
    Backbone(Vec<[f64; 3]>),
    /// Frequency (Hz), force (N), and the complex response to it (m), level by level.
    Sines(Vec<Vec<(f64, f64, Complex64)>>),
}

impl Measured {
    /// Its files with noise of their own, as tables of a study, and what the study says of the noise.
    pub(crate) fn written(&self, folder: &Path, seed: u64) -> String {
        let mut generator = ChaCha8Rng::seed_from_u64(seed);
        let mut normal = || -> f64 { StandardNormal.sample(&mut generator) };
        match self {
            Self::Backbone(points) => {
                let mut csv = "frequency_hz,displacement_m,damping_ratio\n".to_owned();
                for &[amplitude, hz, ratio] in points {
                    let hz = hz * (FREQUENCY * normal()).exp();
                    let ratio = ratio * (DAMPING * normal()).exp();
                    writeln!(csv, "{hz:e},{amplitude:e},{ratio:e}").unwrap();
                }
                std::fs::write(folder.join("backbone.csv"), csv).unwrap();
                format!(
                    "[noise]\nfrequency = {FREQUENCY}\ndamping = {DAMPING}\n[[backbone]]\nfile = \"backbone.csv\"\n"
                )
            }
            Self::Sines(levels) => {
                let mut study = format!("[noise]\nresponse = {RESPONSE}\nforce = 1e-9\n");
                for (level, lines) in levels.iter().enumerate() {
                    let mut csv = "frequency_hz,force_n,displacement_m,phase_rad\n".to_owned();
                    for &(hz, force, exact) in lines {
                        let error = Complex64::new(normal(), normal()) * FRAC_1_SQRT_2 * RESPONSE;
                        let (amplitude, phase) = (exact * (1.0 + error)).to_polar();
                        writeln!(csv, "{hz:e},{force:e},{amplitude:e},{phase:e}").unwrap();
                    }
                    std::fs::write(folder.join(format!("{level}.csv")), csv).unwrap();
                    writeln!(study, "[[sine]]\nfile = \"{level}.csv\"").unwrap();
                }
                study
            }
        }
    }
}

/// Responses at frequencies about the resonance of each of some amplitudes, by quadrature of the loop, with the force that
/// each takes.
pub(crate) fn sines(first_loading: &FirstLoading, small: f64) -> Measured {
    let level = |n: u32| {
        let amplitude = LARGEST_M * f64::from(n) / 8.0;
        let [stiffness, loss] = equivalent(first_loading, amplitude);
        let stiffness = K0 - small + stiffness;
        let omega = (stiffness / (0.5 * MASS)).sqrt();
        let half_width = (C12 * omega + loss) / (MASS * omega);
        let line = |place: i32| {
            let omega = omega + 0.5 * f64::from(place) * half_width;
            // (K − ½mω² + j(cω + loss)) X = F
            let dynamic =
                Complex64::new(stiffness - 0.5 * MASS * omega * omega, C12 * omega + loss);
            let force = amplitude * dynamic.norm();
            (omega / TAU, force, force / dynamic)
        };
        (-6..=6).map(line).collect()
    };
    Measured::Sines((1..=8).map(level).collect())
}

/// A study of what was measured, in its folder, with noise of its own; `told` may change what is said of it.
pub(crate) fn study_of(
    measured: &Measured,
    terms: &str,
    seed: u64,
    told: impl Fn(String) -> String,
) -> (tempfile::TempDir, LapResponseStudy) {
    let folder = tempfile::tempdir().unwrap();
    let tables = told(measured.written(folder.path(), seed));
    let study = format!(
        "method = \"lap-response\"\nname = \"slips\"\n[model]\ndrive = \"relative\"\nresponse = \"relative\"\n{terms}\n\
         harmonics = 1\n[known]\nm = {MASS}\n{tables}"
    );
    let path = folder.path().join("study.toml");
    std::fs::write(&path, study).unwrap();
    let study = LapResponseStudy::read(&path).unwrap_or_else(|error| panic!("{error}"));
    (folder, study)
}

pub(crate) fn identified_of(study: &LapResponseStudy) -> (LapResponse, JointFile) {
    let found = LapResponse::of(study, &|| {}).unwrap();
    let file = found.joint_file(study);
    assert!(file.validate().is_empty(), "{:?}", file.validate());
    (found, file)
}

/// The joint identified from what was measured, with noise of its own.
pub(crate) fn identified(measured: &Measured, terms: &str, seed: u64) -> (LapResponse, JointFile) {
    let (_folder, study) = study_of(measured, terms, seed, |tables| tables);
    identified_of(&study)
}
