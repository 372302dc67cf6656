//! What runs of one joint differ by as a whole: it is told, and intervals of runs that were left out have it in them.
//!
//! Data are backbones by closed formulas, ω² = (k₁₂ + ¾ k₃ A²)/M and ζ = C/(2Mω), each run with a factor of its own.

use std::f64::consts::TAU;
use std::fmt::Write as _;

use bolted_joint::identify::lap::{LapResponse, LapResponseStudy};
use bolted_joint_testing::has;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use rand_distr::{Distribution, StandardNormal};

use crate::loops::{C12, K0, MASS};

/// Relative deviations of runs and of their points.
const OF_RUN: [f64; 2] = [1e-3, 0.05];
const OF_POINT: [f64; 2] = [1e-4, 0.01];
const POINTS: usize = 20;
const FITTED: usize = 5;
const DRAWS: u64 = 200;

/// One run's table, with its factors.
fn backbone(random: &mut ChaCha8Rng, of_run: [f64; 2], fifth: f64) -> String {
    let mut draw = |deviation: f64| -> f64 {
        let own: f64 = StandardNormal.sample(random);
        1.0 + deviation * own
    };
    let own = of_run.map(&mut draw);
    let mut csv = "frequency_hz,displacement_m,damping_ratio\n".to_owned();
    for place in 0..POINTS {
        let amplitude = 3e-4 * 10_f64.powf(place as f64 / POINTS as f64 - 1.0);
        let mass = 0.5 * MASS;
        let stiffness = K0 + 0.75 * 2e11 * amplitude.powi(2) + fifth * amplitude.powi(4);
        let omega = (stiffness / mass).sqrt();
        let ratio = C12 / (2.0 * mass * omega);
        let [of_frequency, of_ratio] = OF_POINT.map(&mut draw);
        let (hz, ratio) = (
            omega / TAU * own[0] * of_frequency,
            ratio * own[1] * of_ratio,
        );
        writeln!(csv, "{hz:e},{amplitude:e},{ratio:e}").unwrap();
    }
    csv
}

/// Identified from so many runs, and one left out.
fn found(seed: u64, fitted: usize, of_run: [f64; 2], fifth: f64) -> LapResponse {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let folder = tempfile::tempdir().unwrap();
    let mut study = format!(
        "method = \"lap-response\"\nname = \"x\"\n[model]\ndrive = \"relative\"\nresponse = \"relative\"\nterms = [\"k3\"]\n\
         compare = false\n[known]\nm = {MASS}\n[noise]\nfrequency = {}\ndamping = {}\n",
        OF_POINT[0], OF_POINT[1]
    );
    for run in 0..=fitted {
        let name = format!("run-{run}.csv");
        std::fs::write(
            folder.path().join(&name),
            backbone(&mut random, of_run, fifth),
        )
        .unwrap();
        let used = if run == fitted {
            "use = \"predict\"\n"
        } else {
            ""
        };
        write!(study, "[[backbone]]\nfile = \"{name}\"\n{used}").unwrap();
    }
    let path = folder.path().join("study.toml");
    std::fs::write(&path, study).unwrap();
    LapResponse::of(&LapResponseStudy::read(&path).unwrap(), &|| {}).unwrap()
}

/// 0.5 in a table of per cent is 50 %, and nothing refuses it.
#[test]
fn ratios_that_may_be_per_cent_are_told() {
    let told = |times: f64| {
        let folder = tempfile::tempdir().unwrap();
        let mut csv = "frequency_hz,displacement_m,damping_ratio\n".to_owned();
        for place in 0..8 {
            let amplitude = 1e-5 * f64::from(1 + place);
            let ratio = times * (0.004 + 1e-4 * f64::from(place));
            writeln!(csv, "{},{amplitude:e},{ratio:e}", 100 - place).unwrap();
        }
        std::fs::write(folder.path().join("run.csv"), csv).unwrap();
        let study = "method = \"lap-response\"\nname = \"x\"\n[model]\ndrive = \"relative\"\nresponse = \"relative\"\n\
                     terms = [\"k3\"]\ncompare = false\n[known]\nm = 2\n[[backbone]]\nfile = \"run.csv\"\n";
        let path = folder.path().join("study.toml");
        std::fs::write(&path, study).unwrap();
        let study = LapResponseStudy::read(&path).unwrap();
        let found = LapResponse::of(&study, &|| {}).unwrap();
        found.warnings(&study).join("\n")
    };
    let says = "run: damping ratios up to 0.47";
    has(
        &told(100.0),
        &[says, "if they are per cent, divide them by 100"],
    );
    assert!(!told(1.0).contains("per cent"));
}

/// Shares of the frequencies and damping ratios of runs left out that lie in their intervals.
fn held(draws: u64, fitted: usize, of_run: [f64; 2]) -> [f64; 2] {
    let (mut all, mut inside) = (0.0, [0.0; 2]);
    for seed in 0..draws {
        let found = found(seed, fitted, of_run, 0.0);
        for point in &found.backbones[fitted].points {
            all += 1.0;
            let both = [Some(point.frequency_hz), point.damping_ratio];
            for (inside, own) in inside.iter_mut().zip(both) {
                *inside += f64::from(u8::from(own.unwrap().holds().unwrap()));
            }
        }
    }
    inside.map(|inside| inside / all)
}

#[test]
fn intervals_of_runs_left_out_hold_where_runs_differ() {
    for fitted in [3, FITTED] {
        let shares = held(DRAWS, fitted, OF_RUN);
        println!("{fitted} runs: intervals hold {shares:?}");
        for share in shares {
            assert!((0.92..=0.98).contains(&share), "{fitted} runs: {share}");
        }
    }
    // runs that do not differ have the noise of their points alone
    let shares = held(40, FITTED, [0.0; 2]);
    println!("alike: intervals hold {shares:?}");
    for share in shares {
        assert!((0.92..=0.985).contains(&share), "{share}");
    }
}

#[test]
fn what_runs_differ_by_is_found_whether_the_law_is_right_or_not() {
    // a spring of fifth order that the model has not changes the frequency by 12 % at the largest amplitude
    let largest = 0.25 * K0 / 3e-4_f64.powi(4);
    for fifth in [0.0, largest] {
        let (mut squares, draws) = ([0.0; 2], 60);
        for seed in 0..draws {
            let between = found(1000 + seed, FITTED, OF_RUN, fifth)
                .between_runs
                .unwrap();
            assert_eq!(between.runs, FITTED);
            let own = [between.frequency, between.damping.unwrap()];
            for (sum, own) in squares.iter_mut().zip(own) {
                *sum += own.standard_deviation.powi(2) / draws as f64;
            }
        }
        // a variance of four degrees of freedom, 60 times: one deviation is 9 %
        for (mean, deviation) in squares.into_iter().zip(OF_RUN) {
            let ratio = mean / deviation.powi(2);
            println!("{fifth:e}: variance {ratio:.3} of what was drawn");
            assert!((0.73..1.27).contains(&ratio), "{fifth:e}: {ratio}");
        }
    }
}

#[test]
fn one_run_tells_nothing_of_others_and_several_say_so() {
    assert_eq!(found(1, 1, OF_RUN, 0.0).between_runs, None);
    let words = found(1, 3, OF_RUN, 0.0).between_runs.unwrap().words();
    has(
        &words,
        &[
            "3 fitted runs differ as a whole",
            "% of the frequency",
            "2 degrees of freedom",
        ],
    );
}
