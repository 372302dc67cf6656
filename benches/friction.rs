//! How long an amplitude-dependent curve with friction takes, beside tmdsimpy.
//!
//! `cargo bench --bench friction` balances seven harmonics and the constant term of an oscillator with Iwan's law at 200
//! frequencies, each from the response before, and runs `friction_balance.py` with the Python of the environment variable
//! `PYTHON` (python3) on the same. tmdsimpy must be on its path (`PYTHONPATH`); it is a checkout of
//! <https://github.com/tmd-lab/tmdsimpy>. It has sliders and samples in place of the law, which are stated.

#![allow(clippy::unwrap_used, reason = "a benchmark that fails stops")]

use std::process::Command;
use std::time::Instant;

use bolted_joint::harmonic::{HarmonicBalance, HarmonicLoads, Harmonics, Observed, Solution};
use bolted_joint_dynamics::law::{DofLaws, Iwan};
use bolted_joint_dynamics::{Body, JointLaw, Lap, Linear};
use criterion::Criterion;
use serde_json::{Value, json};

const IWAN: Iwan = Iwan {
    slip_force: 0.2,
    stiffness: 0.25,
    exponent: -0.3,
    ratio: 0.5,
};
const STIFFNESS: f64 = 0.75;
const DAMPING: f64 = 0.01;
const FORCE: f64 = 0.02;
const OMEGA: [f64; 2] = [0.8, 1.2];
const POINTS: usize = 200;
const HIGHEST: usize = 7;
/// Sliders and samples that tmdsimpy is run with: its default, and finer ones.
const DISCRETISATIONS: [[usize; 2]; 2] = [[100, 128], [400, 512]];

/// Relative motion of a mass of 1 on a spring and a damper, beside Iwan's law.
fn oscillator() -> Lap<1> {
    let body = Body {
        inertia: [2.0],
        stiffness: [0.0],
        damping: [0.0],
    };
    let linear = Linear {
        stiffness: [[STIFFNESS]],
        damping: [[DAMPING]],
    };
    Lap {
        joint: JointLaw {
            linear,
            on: [DofLaws::from(IWAN)],
        },
        a: body,
        b: body,
    }
}

/// Amplitudes of the fundamental.
fn curve(harmonics: &Harmonics) -> Vec<f64> {
    let balance = HarmonicBalance::new(&oscillator(), harmonics.clone()).unwrap();
    let loads = HarmonicLoads::opposed(FORCE);
    let mut last: Option<Solution<1>> = None;
    let amplitudes = (0..POINTS).map(|n| {
        let omega = OMEGA[0] + (OMEGA[1] - OMEGA[0]) * n as f64 / (POINTS - 1) as f64;
        let solution = balance.forced(omega, &loads, last.as_ref()).unwrap();
        let found = balance.amplitude_of(&solution, Observed::Relative(0), 1);
        last = Some(solution);
        found.norm()
    });
    amplitudes.collect()
}

/// Fastest of some runs, s.
fn timed(harmonics: &Harmonics) -> f64 {
    let times = (0..9).map(|_| {
        let begun = Instant::now();
        std::hint::black_box(curve(harmonics));
        begun.elapsed().as_secs_f64()
    });
    times.fold(f64::INFINITY, f64::min)
}

/// What tmdsimpy says, or why there is nothing to compare with.
fn in_tmdsimpy() -> Result<Vec<Value>, String> {
    let python = std::env::var("PYTHON").unwrap_or_else(|_| "python3".to_owned());
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/friction_balance.py");
    let case = json!({
        "mass": 1.0, "stiffness": STIFFNESS, "damping": DAMPING, "force": FORCE,
        "iwan": [IWAN.slip_force, IWAN.stiffness, IWAN.exponent, IWAN.ratio],
        "omega": OMEGA, "points": POINTS, "highest": HIGHEST, "discretisations": DISCRETISATIONS,
    });
    let done = Command::new(&python)
        .args([script, &case.to_string()])
        .output()
        .map_err(|error| format!("{python}: {error}"))?;
    if !done.status.success() {
        let text = String::from_utf8_lossy(&done.stderr);
        return Err(format!(
            "{python}: {}",
            text.lines().last().unwrap_or_default()
        ));
    }
    serde_json::from_slice(&done.stdout).map_err(|error| error.to_string())
}

fn main() {
    let all = Harmonics::all(HIGHEST).unwrap();
    let odd = Harmonics::odd(HIGHEST).unwrap();
    let (all_s, odd_s) = (timed(&all), timed(&odd));
    println!(
        "{POINTS} points with Iwan's law: {:.2} ms with all harmonics up to {HIGHEST}, {:.2} ms with the odd ones",
        1e3 * all_s,
        1e3 * odd_s
    );
    let own = curve(&all);
    match in_tmdsimpy() {
        Err(reason) => println!("not compared with tmdsimpy: {reason}"),
        Ok(runs) => {
            for run in runs {
                let seconds = run["seconds"].as_f64().unwrap();
                let theirs: Vec<f64> = serde_json::from_value(run["amplitudes"].clone()).unwrap();
                let apart = own
                    .iter()
                    .zip(&theirs)
                    .map(|(own, theirs)| (theirs / own - 1.0).abs());
                println!(
                    "tmdsimpy, {} sliders, {} samples: {:.1} ms, {:.0} times as long; amplitudes apart by {:.1e} at most",
                    run["sliders"],
                    run["samples"],
                    1e3 * seconds,
                    seconds / all_s,
                    apart.fold(0.0, f64::max)
                );
            }
        }
    }
    let mut criterion = Criterion::default().configure_from_args();
    criterion.bench_function("curve with Iwan's law", |bencher| {
        bencher.iter(|| curve(&all));
    });
    criterion.final_summary();
}
