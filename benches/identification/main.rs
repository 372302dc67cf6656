//! How long an identification takes, and how near the Cramér–Rao bound it comes.
//!
//! `cargo bench --bench identification` times 2,048 lines at three points, with intervals, and 1,000 bootstrap draws.
//! `-- against PYTHON` runs `same_in_numpy.py`, the same algorithm in NumPy and SciPy, with that interpreter in turns with ours, with
//! one BLAS thread and with as many as it takes by itself, and prints the ratios; then `measured_in_numpy.py` in the same way, where
//! the substructures are measured, too. It fails where both do not find the same joint there.
//! `-- write FILE` and `-- write-measured FILE` write the data that the scripts read, `-- repeat COUNT` and
//! `-- repeat-measured COUNT` identify them so many times, for a profiler.
//! `-- growth [lines|points|bolts]` prints how the time grows with these, `-- growth LINES POINTS BOLTS` one row.
//! `-- table [DRAWS [CASE]]` prints the errors of stiff and soft joints with light and heavy damping over many draws of
//! noise, of the cases whose names hold the words CASE.

#![expect(
    clippy::unwrap_used,
    reason = "a benchmark whose preparation fails has nothing better to do than panic"
)]

#[path = "../../tests/identification/beams.rs"]
mod beams;
#[path = "../../tests/identification/cases.rs"]
#[expect(dead_code, reason = "the tests of identification need more of them")]
mod cases;
mod growth;
#[path = "../../tests/identification/measured.rs"]
mod measured;
mod measured_beside;
#[path = "../../tests/identification/monte_carlo.rs"]
mod monte_carlo;

use std::path::Path;
use std::process::Command;
use std::time::Instant;

use beams::identified;
use bolted_joint::draws::Share;
use bolted_joint::identify::{
    BandChoice, BandChoices, Bootstrap, Lines, Noise, NoiseLevel, Options,
};
use measured::{Noisy, Rig, joint, stiff_and_soft, thesis};

const ONE_PER_CENT: NoiseLevel = beams::relative(0.01);
const LINES: usize = 2048;
const REPETITIONS: usize = 20;
/// Turns of both programs.
const TURNS: usize = 5;

fn axis(count: usize, step_hz: f64) -> Vec<f64> {
    (1..=count).map(|line| line as f64 * step_hz).collect()
}

fn main() {
    let arguments: Vec<String> = std::env::args()
        .skip(1)
        .filter(|a| a != "--bench")
        .collect();
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    match words.as_slice() {
        ["write", file] => write(file),
        ["write-measured", file] => measured_beside::write(Path::new(file)),
        ["against", python] => {
            against(python);
            measured_beside::against(python);
        }
        ["against-measured", python] => measured_beside::against(python),
        ["growth"] => growth::table(None),
        ["growth", lines, points, bolts] => {
            let [lines, points, bolts] = [lines, points, bolts].map(|word| word.parse().unwrap());
            growth::one(lines, points, bolts);
        }
        ["growth", quantity] => growth::table(Some(quantity)),
        ["repeat-measured", count] => measured_beside::repeat(count.parse().unwrap()),
        ["repeat", count] => drop(repeat(count.parse().unwrap(), BandChoice::Automatic)),
        ["table"] => table(100, ""),
        ["table", draws] => table(draws.parse().unwrap(), ""),
        ["table", draws, chosen] => table(draws.parse().unwrap(), chosen),
        _ => time(),
    }
}

fn rig() -> Rig {
    Rig::new("timing", joint(1.0, 1.0), thesis(axis(LINES, 0.25)))
}

/// Seconds that each of `count` identifications of the same lines takes.
fn repeat(count: usize, bands: BandChoice) -> Vec<f64> {
    let options = Options {
        noise: Noise::stated(ONE_PER_CENT),
        bands: BandChoices::all(bands),
        ..Options::default()
    };
    repeat_with(count, &options)
}

fn repeat_with(count: usize, options: &Options) -> Vec<f64> {
    let rig = rig();
    let lines = rig.lines(Noisy::Assembly, ONE_PER_CENT, 1);
    let one = |_| {
        let begun = Instant::now();
        let found = identified(&lines, rig.model, options);
        assert!(found.assessment.fits());
        begun.elapsed().as_secs_f64()
    };
    (0..count).map(one).collect()
}

/// Seconds that each identification of the script takes; with `threads` of BLAS, or as many as it takes by itself.
fn repeat_in_numpy(python: &str, file: &Path, threads: Option<&str>) -> Vec<f64> {
    let mut lines = in_numpy(python, "same_in_numpy.py", file, &["--seconds"], threads);
    lines.remove(0)
}

/// The numbers that a script prints, line by line.
fn in_numpy(
    python: &str,
    script: &str,
    file: &Path,
    more: &[&str],
    threads: Option<&str>,
) -> Vec<Vec<f64>> {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/identification/");
    let mut command = Command::new(python);
    command
        .arg(format!("{folder}{script}"))
        .arg(file)
        .args(more);
    for library in ["OPENBLAS", "MKL", "OMP"] {
        let name = format!("{library}_NUM_THREADS");
        match threads {
            Some(threads) => command.env(name, threads),
            None => command.env_remove(name),
        };
    }
    let output = command.output().unwrap();
    let text = String::from_utf8(output.stdout).unwrap();
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{errors}");
    let numbers = |line: &str| {
        let words = line.split_whitespace();
        words.map(|word| word.parse().unwrap()).collect()
    };
    text.lines().map(numbers).collect()
}

/// Both in turns, so that they share whatever else the machine does.
fn against(python: &str) {
    let file = std::env::temp_dir().join(format!("identification-{}.bin", std::process::id()));
    write(file.to_str().unwrap());
    let mut times: [Vec<f64>; 4] = Default::default();
    for _ in 0..TURNS {
        // The script takes the median over all lines.
        times[0].extend(repeat(REPETITIONS, BandChoice::Median).split_off(1));
        times[1].extend(repeat(REPETITIONS, BandChoice::Automatic).split_off(1));
        times[2].extend(repeat_in_numpy(python, &file, Some("1")));
        times[3].extend(repeat_in_numpy(python, &file, None));
    }
    std::fs::remove_file(&file).unwrap();
    for times in &mut times {
        times.sort_by(f64::total_cmp);
    }
    let names = [
        "this program",
        "and with chosen bands",
        "NumPy, one BLAS thread",
        "NumPy, its own BLAS threads",
    ];
    println!("{LINES} lines, three points, with intervals; ms");
    for (name, of) in names.iter().zip(&times) {
        let (median, fastest) = (of[of.len() / 2], of[0]);
        let (by_median, by_fastest) =
            (median / times[0][times[0].len() / 2], fastest / times[0][0]);
        println!(
            "{name:28} median {:6.1} = {by_median:5.1} × ours, fastest {:6.1} = {by_fastest:5.1} × ours",
            1e3 * median,
            1e3 * fastest
        );
    }
}

fn time() {
    let rig = rig();
    let lines = rig.lines(Noisy::Assembly, ONE_PER_CENT, 1);
    for (what, noise) in [
        ("noise stated", Noise::stated(ONE_PER_CENT)),
        ("noise estimated", Noise::default()),
    ] {
        let options = Options {
            noise,
            ..Options::default()
        };
        let mut times = repeat_with(REPETITIONS, &options);
        times.sort_by(f64::total_cmp);
        println!(
            "{LINES} lines, three points, {what}: {:.1} ms (fastest {:.1} ms)",
            1e3 * times[REPETITIONS / 2],
            1e3 * times[0]
        );
    }
    let options = Options {
        noise: Noise::stated(ONE_PER_CENT),
        bootstrap: Some(Bootstrap {
            draws: 1000,
            seed: 1,
            share: Share::Whole,
        }),
        ..Options::default()
    };
    let begun = Instant::now();
    let found = identified(&lines, rig.model, &options);
    let elapsed = begun.elapsed().as_secs_f64();
    let converged = found.bootstrap().unwrap().converged;
    println!("1000 bootstrap draws of {LINES} lines: {elapsed:.2} s, {converged} converged");
}

/// Whether the words stand in `text` one after the other.
fn holds(text: &str, words: &str) -> bool {
    let of = |text: &str| -> Vec<String> {
        let words = text.split_whitespace();
        words
            .map(|word| word.trim_end_matches(',').to_owned())
            .collect()
    };
    let (text, words) = (of(text), of(words));
    words.is_empty() || text.windows(words.len()).any(|part| part == words)
}

fn table(draws: u64, chosen: &str) {
    for rig in stiff_and_soft() {
        for noisy in [Noisy::Assembly, Noisy::AssemblyAndA, Noisy::Everything] {
            for relative in [0.01, 0.05] {
                let case = format!("{}, {} % on {noisy:?}", rig.name, 100.0 * relative);
                if !holds(&case, chosen) {
                    continue;
                }
                let level = beams::relative(relative);
                let begun = Instant::now();
                let outcomes = monte_carlo::run(&rig, noisy, level, draws, true);
                monte_carlo::print(&rig, noisy, level, &outcomes);
                let each = begun.elapsed().as_secs_f64() / draws as f64;
                println!("  {draws} draws, {each:.2} s each");
            }
        }
    }
}

/// Lines as little-endian doubles: ω, then F, H_ks, H_ss and H^C_ss of each line, real and imaginary part, row by row.
fn write(file: &str) {
    let lines: Lines = rig().lines(Noisy::Assembly, ONE_PER_CENT, 1);
    let mut bytes = Vec::new();
    for (line, frequency_hz) in lines.frequency_hz.iter().enumerate() {
        let b = lines.b_at(line);
        bytes.extend((std::f64::consts::TAU * frequency_hz).to_le_bytes());
        let free = &*lines.a.at(line) + &b.joint;
        for matrix in [&free, &b.joint_points, &b.points, &lines.assembly[line]] {
            for row in matrix.row_iter() {
                for value in row.iter() {
                    bytes.extend(value.re.to_le_bytes());
                    bytes.extend(value.im.to_le_bytes());
                }
            }
        }
    }
    std::fs::write(file, bytes).unwrap();
    println!("wrote {} lines to {file}", lines.frequency_hz.len());
}
