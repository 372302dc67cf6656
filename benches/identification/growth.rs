//! How the time of an identification grows with lines, points and bolts, and with what is measured.

use std::sync::Arc;
use std::time::Instant;

use bolted_joint::identify::{
    Bolts, JointMatrices, JointModel, Lines, MeasuredSubstructure, Noise, Options, Receptances,
};
use bolted_joint::structure::ComplexMatrix;
use nalgebra::DMatrix;
use num_complex::Complex64;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use rand_distr::{Distribution, StandardNormal};

use crate::beams::{identified, pairs};
use crate::cases::{bolt, bolted};

const RELATIVE: f64 = 0.01;
const TO_HZ: f64 = 500.0;
/// Identifications of one case; of those that take long, one.
const REPETITIONS: usize = 5;
const LONG_S: f64 = 3.0;
/// What Linux counts processor time in.
const TICKS_PER_SECOND: f64 = 100.0;

/// What is identified.
#[derive(Clone, Copy)]
struct Case {
    lines: usize,
    points: usize,
    bolts: usize,
}

const ONE: Case = Case {
    lines: 3000,
    points: 3,
    bolts: 1,
};
const SEVERAL: Case = Case {
    lines: 2000,
    points: 6,
    bolts: 4,
};

/// So many numbers, evenly from `first` to `last`; the middle, if it is one.
fn spread(count: usize, first: f64, last: f64) -> Vec<f64> {
    if count == 1 {
        return vec![0.5 * (first + last)];
    }
    let step = (last - first) / (count - 1) as f64;
    (0..count).map(|i| first + step * i as f64).collect()
}

/// With noise on the assembly, or on everything, translations and rotations at the bolts being measured directly.
fn lines(case: Case, all_is_measured: bool) -> Lines {
    let joints: Vec<JointMatrices> = (0..case.bolts)
        .map(|i| bolt(1.0 + 0.5 * i as f64))
        .collect();
    let step_hz = TO_HZ / case.lines as f64;
    let axis = (1..=case.lines).map(|line| line as f64 * step_hz);
    let mut lines = bolted(
        &spread(case.bolts, 0.02, 0.08),
        &spread(case.points, 0.01, 0.3),
        &JointMatrices::of_bolts(&joints),
        axis.collect(),
    );
    let mut generator = ChaCha8Rng::seed_from_u64(1);
    let mut polluted = |value: Complex64| {
        let mut normal = || -> f64 { StandardNormal.sample(&mut generator) };
        let error = Complex64::new(normal(), normal()) * (RELATIVE / 2.0_f64.sqrt());
        value * (1.0 + error)
    };
    for value in lines.assembly.iter_mut().flat_map(|h| h.iter_mut()) {
        *value = polluted(*value);
    }
    if all_is_measured {
        for side in [&mut lines.a, &mut lines.b] {
            let Receptances::Exact(exact) = &*side else {
                unreachable!("nothing has been measured yet")
            };
            *side = measured(exact, &mut polluted);
        }
    }
    lines
}

/// Every pair of DOFs measured once, with reciprocal pairs as their mean.
fn measured(
    exact: &[ComplexMatrix],
    polluted: &mut impl FnMut(Complex64) -> Complex64,
) -> Receptances {
    let count = exact[0].nrows();
    let triangle = (0..count).flat_map(|q| (0..=q).map(move |p| (p, q)));
    let functions = triangle.map(|(p, q)| {
        let of_line = |matrix: &ComplexMatrix| {
            let first = polluted(matrix[(p, q)]);
            if p == q {
                first
            } else {
                0.5 * (first + polluted(matrix[(q, p)]))
            }
        };
        exact.iter().map(of_line).collect()
    });
    let functions = functions.collect();
    let transformation = DMatrix::identity(count, count);
    let measured = MeasuredSubstructure::new(transformation, functions, pairs(count), None);
    Receptances::Measured(Arc::new(measured))
}

/// Processor time of all threads so far, where the system tells it: that of others on the same machine does not count.
fn processor_s() -> Option<f64> {
    let text = std::fs::read_to_string("/proc/self/stat").ok()?;
    // what follows the name, which may hold anything: utime and stime are the 12th and the 13th
    let (_, numbers) = text.rsplit_once(')')?;
    let ticks = numbers.split_whitespace().skip(11).take(2);
    let ticks: Option<Vec<f64>> = ticks.map(|word| word.parse().ok()).collect();
    Some(ticks?.iter().sum::<f64>() / TICKS_PER_SECOND)
}

/// Seconds of one identification with all its joint models: the median of a few, and the processor's of all threads; what it
/// says of the fit.
fn seconds(case: Case, all_is_measured: bool) -> (f64, Option<f64>, bool) {
    let lines = lines(case, all_is_measured);
    let names = (1..=case.bolts).map(|bolt| format!("bolt {bolt}"));
    let options = Options {
        bolts: if case.bolts == 1 {
            Bolts::One
        } else {
            Bolts::Different(names.collect())
        },
        noise: Noise::stated(crate::beams::relative(RELATIVE)),
        compare_models: true,
        ..Options::default()
    };
    let mut times = Vec::new();
    let mut fits = true;
    let before = processor_s();
    while times.len() < REPETITIONS {
        let begun = Instant::now();
        let found = identified(&lines, JointModel::Full, &options);
        times.push(begun.elapsed().as_secs_f64());
        fits &= found.assessment.fits();
        if times.iter().sum::<f64>() > LONG_S {
            break;
        }
    }
    let processor = before.zip(processor_s());
    let processor = processor.map(|(before, after)| (after - before) / times.len() as f64);
    times.sort_by(f64::total_cmp);
    (times[times.len() / 2], processor, fits)
}

fn row(case: Case) {
    let cell = |all_is_measured| {
        let (seconds, processor, fits) = seconds(case, all_is_measured);
        let fits = if fits { "" } else { " (no fit)" };
        let processor = processor.map_or_else(String::new, |of| format!(", processors {of:.3} s"));
        format!("{seconds:.3} s{processor}{fits}")
    };
    let Case {
        lines,
        points,
        bolts,
    } = case;
    println!(
        "| {lines} | {points} | {bolts} | {} | {} |",
        cell(false),
        cell(true)
    );
}

/// Prints the row of one case.
pub(crate) fn one(lines: usize, points: usize, bolts: usize) {
    row(Case {
        lines,
        points,
        bolts,
    });
}

/// Prints the rows of the table, of one quantity or of all three.
pub(crate) fn table(chosen: Option<&str>) {
    println!("| lines | points | bolts | noise on the assembly | noise on everything |");
    println!("|---:|---:|---:|---:|---:|");
    let is_chosen = |name: &str| chosen.is_none_or(|chosen| chosen == name);
    if is_chosen("lines") {
        for lines in [300, 3000, 30_000, 200_000] {
            row(Case { lines, ..ONE });
        }
    }
    if is_chosen("points") {
        for points in [1, 3, 6, 12] {
            row(Case { points, ..ONE });
        }
    }
    if is_chosen("bolts") {
        for bolts in [1, 2, 4] {
            row(Case { bolts, ..SEVERAL });
        }
        // More bolts need more points.
        for bolts in [4, 6, 8] {
            row(Case {
                lines: 500,
                points: 2 * bolts,
                bolts,
            });
        }
    }
}
