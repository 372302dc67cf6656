//! Laws that slip from free decays of an oscillator with sliders, which velocity Verlet supplies step by step, with noise.

use std::fmt::Write as _;

use bolted_joint::identify::lap::{
    LapResponse, LapResponseStudy, ResponseUnknown, SliderParameter,
};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use rand_distr::{Distribution, StandardNormal};

/// M = m/2 of the relative motion, kg.
const MASS: f64 = 1.0;
const K0: f64 = 5.0e5;
const C12: f64 = 2.0;
const LARGEST_M: f64 = 3.0e-4;
const INTERVAL_S: f64 = 1e-4;
const SAMPLES: usize = 12_000;
/// Of the first amplitude.
const NOISE: f64 = 0.01;
/// Relative error without noise.
const EXACT: f64 = 2e-3;
/// Root of the mean square error in standard deviations. Of four numbers two go together: 60 draws are 180 that do not, which
/// leave 5 % of it open and 1.6 % of the intervals that hold.
const DEVIATIONS: std::ops::Range<f64> = 0.8..1.2;
const HELD: std::ops::RangeInclusive<f64> = 0.92..=0.98;

/// Sliders: stiffness (N/m) and the displacement at which each slips (m).
type Sliders = Vec<[f64; 2]>;

/// Segalman's density R φ^χ up to φ_max in cells that grow: each has the stiffness of its cell, and its slip force.
fn iwan(density: f64, exponent: f64, span: f64) -> Sliders {
    let count = 150;
    let edge = |n: i32| match n {
        0 => 0.0,
        _ => span * 1e-5_f64.powf(1.0 - f64::from(n - 1) / f64::from(count - 1)),
    };
    let moment =
        |from: f64, to: f64, power: f64| density * (to.powf(power) - from.powf(power)) / power;
    let cell = |n: i32| {
        let (from, to) = (edge(n), edge(n + 1));
        let stiffness = moment(from, to, exponent + 1.0);
        [stiffness, moment(from, to, exponent + 2.0) / stiffness]
    };
    (0..count).map(cell).collect()
}

/// Displacements of a release at `LARGEST_M`, where the sliders have come straight from rest.
fn decay(sliders: &Sliders) -> Vec<f64> {
    let steps = 20;
    let h = INTERVAL_S / f64::from(steps);
    let spring = K0 - sliders.iter().map(|[stiffness, _]| stiffness).sum::<f64>();
    let (mut u, mut v) = (LARGEST_M, 0.0);
    let mut stuck: Vec<f64> = sliders.iter().map(|[_, slips]| u.min(*slips)).collect();
    let load = |u: f64, stuck: &[f64]| {
        let of_sliders = sliders.iter().zip(stuck);
        spring * u
            + of_sliders
                .map(|([stiffness, _], z)| stiffness * z)
                .sum::<f64>()
    };
    let mut a = -load(u, &stuck) / MASS;
    let mut found = Vec::with_capacity(SAMPLES);
    for _ in 0..SAMPLES {
        found.push(u);
        for _ in 0..steps {
            let change = h * v + 0.5 * h * h * a;
            u += change;
            for (z, [_, slips]) in stuck.iter_mut().zip(sliders) {
                *z = (*z + change).clamp(-slips, *slips);
            }
            let load = load(u, &stuck);
            // v′ = v + ½h (a + a′), a′ = −(f + c v′)/M
            v = (v + 0.5 * h * (a - load / MASS)) / (1.0 + 0.5 * h * C12 / MASS);
            a = -(load + C12 * v) / MASS;
        }
    }
    found
}

fn identified(samples: &[f64], name: &str, (seed, noise): (u64, f64)) -> LapResponse {
    let mut generator = ChaCha8Rng::seed_from_u64(seed);
    let mut csv = "time_s,displacement_m\n".to_owned();
    for (n, u) in samples.iter().enumerate() {
        let normal: f64 = StandardNormal.sample(&mut generator);
        let measured = u + noise * LARGEST_M * normal;
        writeln!(csv, "{:e},{measured:e}", INTERVAL_S * n as f64).unwrap();
    }
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("decay.csv"), csv).unwrap();
    let study = format!(
        "method = \"lap-response\"\nname = \"x\"\n[model]\ndrive = \"relative\"\nresponse = \"relative\"\n\
         terms = [\"{name}\"]\ncompare = false\n[known]\nm = {}\n[[decay]]\nfile = \"decay.csv\"\n",
        2.0 * MASS
    );
    let path = folder.path().join("study.toml");
    std::fs::write(&path, study).unwrap();
    let study = LapResponseStudy::read(&path).unwrap_or_else(|error| panic!("{error}"));
    LapResponse::of(&study, &|| {}).unwrap()
}

/// Without noise the numbers are there; with it their errors are what is said of them.
#[track_caller]
fn assert_known(sliders: &Sliders, name: &str, truth: &[(ResponseUnknown, f64)], draws: u64) {
    let samples = decay(sliders);
    let exact = identified(&samples, name, (0, 0.0));
    for (unknown, expected) in truth {
        let found = exact.fit.values.of(*unknown);
        let symbol = unknown.symbol();
        assert!(
            (found / expected - 1.0).abs() < EXACT,
            "{symbol}: {found} {expected}"
        );
    }
    let (mut squares, mut held) = (0.0, 0.0);
    let share = ((draws as usize * truth.len()) as f64).recip();
    for seed in 0..draws {
        let found = identified(&samples, name, (seed, NOISE));
        let reduced = found.fit.reduced_chi_squared();
        assert!((0.2..3.0).contains(&reduced), "{name}: {reduced}");
        for (unknown, expected) in truth {
            let mut estimates = found.estimates.iter();
            let own = estimates.find(|own| own.unknown == *unknown).unwrap();
            let error = (own.free_value - expected) / own.standard_deviation;
            squares += share * error.powi(2);
            let [low, high] = own.interval_95;
            held += share * f64::from(u8::from((low..=high).contains(expected)));
        }
    }
    let deviations = f64::sqrt(squares);
    println!("{name}: {deviations:.3} deviations, intervals hold {held:.3}");
    assert!(DEVIATIONS.contains(&deviations), "{name}: {deviations}");
    assert!(HELD.contains(&held), "{name}: {held}");
}

fn slider(parameter: SliderParameter) -> ResponseUnknown {
    ResponseUnknown::Slider(parameter)
}

#[test]
fn one_slider_is_known_from_a_decay_as_well_as_it_is_said() {
    let (k, h) = (6e4, 6.0);
    let truth = [
        (ResponseUnknown::JointStiffness, K0),
        (ResponseUnknown::JointDamping, C12),
        (slider(SliderParameter::Stiffness), k),
        (slider(SliderParameter::SlipForce), h),
    ];
    assert_known(&vec![[k, h / k]], "jenkins", &truth, 60);
}

#[test]
fn many_sliders_are_known_from_a_decay_as_well_as_it_is_said() {
    let (density, exponent) = (1e7, -0.4);
    let truth = [
        (ResponseUnknown::JointStiffness, K0),
        (ResponseUnknown::JointDamping, C12),
        (slider(SliderParameter::Density), density),
        (slider(SliderParameter::Exponent), exponent),
    ];
    assert_known(&iwan(density, exponent, 2e-3), "micro-slip", &truth, 120);
}
