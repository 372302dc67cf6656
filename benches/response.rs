//! How long a whole amplitude-dependent FRF takes, against stepping through it in time and against the same method in NumPy.
//!
//! `cargo bench --bench response` follows seven harmonics and the constant term of a lap's two DOFs through both folds, with
//! some 400 points; takes a stepped sine up and down the same range by RK4, and runs `harmonic_balance.py` with the Python of
//! the environment variable `PYTHON` (`python3`). The three must agree, or it fails.

#![expect(
    clippy::unwrap_used,
    reason = "a benchmark whose preparation fails has nothing better to do than panic"
)]

use std::f64::consts::TAU;
use std::hint::black_box;
use std::process::Command;
use std::time::Instant;

use bolted_joint::harmonic::{
    CurveOptions, CurvePoint, HarmonicBalance, HarmonicLoads, Harmonics, Observed, Steps,
};
use bolted_joint_dynamics::{Body, Lap, LapIntegrator, LapState, Linear, Polynomial};
use criterion::Criterion;
use num_complex::Complex64;
use serde_json::{Value, json};

/// Pirdayr's Ex.03 (2 × 2.35 kg, 331 Hz in the relative mode) with a cubic spring that can be seen.
const M: f64 = 2.35;
const C: f64 = 1.39;
const K: f64 = 10.56e5;
const K12: f64 = 4.56e6;
const C12: f64 = 0.54;
const K3: f64 = 1e12;
const FORCE_N: f64 = 0.6;
const OMEGA: [f64; 2] = [2040.0, 2130.0];
const HIGHEST: usize = 7;
const LONGEST: f64 = 0.045;
/// Frequencies of the stepped sine, each way.
const LINES: usize = 400;
/// What is left of a transient when a frequency is measured.
const SETTLED: f64 = 1e-3;
const REPETITIONS: usize = 21;

fn lap() -> Lap<1> {
    let body = Body {
        inertia: [M],
        stiffness: [K],
        damping: [C],
    };
    let linear = Linear {
        stiffness: [[K12]],
        damping: [[C12]],
    };
    Lap {
        joint: linear.beside([Polynomial::cubic(K3)]),
        a: body,
        b: body,
    }
}

fn curve(with_stability: bool) -> Vec<CurvePoint<1>> {
    let balance = HarmonicBalance::new(&lap(), Harmonics::all(HIGHEST).unwrap()).unwrap();
    let options = CurveOptions {
        steps: Steps {
            longest: LONGEST,
            ..Steps::default()
        },
        with_stability,
    };
    let loads = HarmonicLoads::opposed(FORCE_N);
    balance.forced_curve(OMEGA, &loads, &options).unwrap()
}

/// Shortest time of a curve, s: what the machine does when nothing else disturbs it.
fn timed(with_stability: bool) -> f64 {
    (0..REPETITIONS)
        .map(|_| {
            let begun = Instant::now();
            black_box(curve(with_stability));
            begun.elapsed().as_secs_f64()
        })
        .fold(f64::MAX, f64::min)
}

/// Amplitude of the relative motion's fundamental at each frequency, each after its transient has died out.
fn stepped(omegas: impl Iterator<Item = f64>) -> Vec<(f64, f64)> {
    let lap = lap();
    let integrator = LapIntegrator::new(&lap);
    let loads = HarmonicLoads::<1>::opposed(FORCE_N);
    let step = lap.spectrum().unwrap().accurate_step_s().unwrap();
    // e^{−σt}, σ = (c + 2c12)/(2m) of the relative mode, the only one that opposed loads move
    let settle_s = SETTLED.ln().abs() / ((C + 2.0 * C12) / (2.0 * M));
    let mut state = LapState::REST;
    omegas
        .map(|omega| {
            let period = TAU / omega;
            let steps = (period / step).ceil() as usize;
            let all: Vec<_> = (0..=2 * steps)
                .map(|half| loads.at_phase(TAU * half as f64 / (2 * steps) as f64))
                .collect();
            let rounds = (settle_s / period).ceil() as usize;
            let mut sum = Complex64::ZERO;
            for round in 0..=rounds {
                for n in 0..steps {
                    if round == rounds {
                        let r = state.a.displacement[0] - state.b.displacement[0];
                        sum += r * Complex64::cis(-TAU * n as f64 / steps as f64);
                    }
                    let loads = [all[2 * n], all[2 * n + 1], all[2 * n + 2]];
                    state = integrator.step_with_loads(&state, &loads, period / steps as f64);
                }
            }
            (omega, (sum * (2.0 / steps as f64)).norm())
        })
        .collect()
}

fn amplitude(balance: &HarmonicBalance<1>, point: &CurvePoint<1>) -> f64 {
    balance
        .amplitude_of(&point.solution, Observed::Relative(0), 1)
        .norm()
}

/// Part of the stepped amplitudes that lie within 1 % of a stable motion of the curve at their frequency.
fn agreement(stepped: &[(f64, f64)], curve: &[CurvePoint<1>]) -> f64 {
    let balance = HarmonicBalance::new(&lap(), Harmonics::all(HIGHEST).unwrap()).unwrap();
    let is_near = |&&(omega, found): &&(f64, f64)| {
        curve.windows(2).any(|pair| {
            let [one, other] = [&pair[0], &pair[1]].map(|p| p.solution.omega_rad_s());
            let share = (omega - one) / (other - one);
            let is_stable =
                |point: &CurvePoint<1>| point.stability.as_ref().is_some_and(|s| s.is_stable());
            if !(0.0..=1.0).contains(&share) || !pair.iter().all(is_stable) {
                return false;
            }
            let (one, other) = (amplitude(&balance, &pair[0]), amplitude(&balance, &pair[1]));
            (found / (one + share * (other - one)) - 1.0).abs() < 0.01
        })
    };
    stepped.iter().filter(is_near).count() as f64 / stepped.len() as f64
}

/// What NumPy needs, s, and its curve.
fn in_numpy() -> Option<(f64, Vec<[f64; 3]>)> {
    let python = std::env::var("PYTHON").unwrap_or_else(|_| "python3".to_owned());
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/harmonic_balance.py");
    let case = json!({
        "lap": { "m": [M, M], "c": [C, C], "k": [K, K], "k12": K12, "c12": C12, "k3": K3 },
        "highest": HIGHEST, "omega": OMEGA, "force": FORCE_N, "longest": LONGEST,
    });
    let done = Command::new(&python)
        .args([script, &case.to_string(), "5"])
        .output()
        .ok()?;
    if !done.status.success() {
        println!(
            "not compared with NumPy: {python}: {}",
            String::from_utf8_lossy(&done.stderr)
                .lines()
                .last()
                .unwrap_or_default()
        );
        return None;
    }
    let value: Value = serde_json::from_slice(&done.stdout).unwrap();
    let curve = serde_json::from_value(value["curve"].clone()).unwrap();
    Some((value["seconds"].as_f64()?, curve))
}

/// Largest relative distance of NumPy's points from the curve, each brought to its frequency.
fn distance(points: &[[f64; 3]], curve: &[CurvePoint<1>]) -> f64 {
    let balance = HarmonicBalance::new(&lap(), Harmonics::all(HIGHEST).unwrap()).unwrap();
    let loads = HarmonicLoads::opposed(FORCE_N);
    let mut largest: f64 = 0.0;
    for &[omega, a, b] in points {
        let theirs = Complex64::new(a, -b);
        let far = |point: &&CurvePoint<1>| {
            let ours = balance.amplitude_of(&point.solution, Observed::Relative(0), 1);
            (ours / theirs - 1.0).norm()
        };
        let nearest = curve
            .iter()
            .min_by(|one, other| far(one).total_cmp(&far(other)))
            .unwrap();
        let ours = balance
            .forced(omega, &loads, Some(&nearest.solution))
            .unwrap();
        let ours = balance.amplitude_of(&ours, Observed::Relative(0), 1);
        largest = largest.max((ours / theirs - 1.0).norm());
    }
    largest
}

fn main() {
    let with_stability = curve(true);
    let folds = with_stability.iter().filter(|point| point.is_fold).count();
    assert_eq!(folds, 2, "the curve has two folds");
    let count = with_stability.len();
    let (plain_s, stable_s) = (timed(false), timed(true));
    println!(
        "harmonic balance, {count} points, {} unknowns: {:.2} ms, with stability {:.2} ms",
        2 * HIGHEST + 1,
        1e3 * plain_s,
        1e3 * stable_s
    );

    let omega = |line: usize| OMEGA[0] + (OMEGA[1] - OMEGA[0]) * line as f64 / (LINES - 1) as f64;
    let begun = Instant::now();
    let mut both = stepped((0..LINES).map(omega));
    both.extend(stepped((0..LINES).rev().map(omega)));
    let stepped_s = begun.elapsed().as_secs_f64();
    let near = agreement(&both, &with_stability);
    println!(
        "stepped sine by RK4, {LINES} frequencies up and down: {stepped_s:.1} s, {:.1} % of them within 1 % of the curve",
        100.0 * near
    );
    assert!(near > 0.98, "the stepped sine has another curve");
    println!(
        "  {:.0} times as long; {:.0} times as long as with stability",
        stepped_s / plain_s,
        stepped_s / stable_s
    );

    if let Some((numpy_s, points)) = in_numpy() {
        let distance = distance(&points, &with_stability);
        println!(
            "NumPy, {} points: {:.1} ms, apart by {distance:.1e} at most",
            points.len(),
            1e3 * numpy_s
        );
        assert!(distance < 1e-8, "NumPy has another curve");
        println!(
            "  {:.1} times as long, a point",
            numpy_s / points.len() as f64 / (plain_s / count as f64)
        );
    }

    let mut criterion = Criterion::default().configure_from_args();
    criterion.bench_function("amplitude-dependent FRF", |bencher| {
        bencher.iter(|| curve(false));
    });
    criterion.bench_function("amplitude-dependent FRF with stability", |bencher| {
        bencher.iter(|| curve(true));
    });
    criterion.final_summary();
}
