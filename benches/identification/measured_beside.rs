//! Everything measured, with errors of its own: beside the marginal form in NumPy and SciPy.

use std::path::Path;
use std::time::Instant;

use bolted_joint::identify::{JointModel, Lines, LinesEstimate, Noise, Options};
use num_complex::Complex64;

use crate::measured::{Noisy, Rig, Setup, joint, unknowns};
use crate::{LINES, ONE_PER_CENT, axis, beams, in_numpy};

/// Identifications of each turn: ours, and those of the script.
const REPETITIONS: usize = 10;
const REPETITIONS_IN_NUMPY: &str = "3";
const TURNS: usize = 5;
/// Both end their search a hundredth of a standard deviation before the minimum, at most; in standard deviations, and of these.
const MOST_APART: f64 = 0.05;

/// The thesis's joint between beams that are measured far enough from it on either side for a rotation by differences.
fn rig() -> Rig {
    let setup = Setup {
        spacing_m: 0.08,
        damping_ratio: 0.01,
        frequency_hz: axis(LINES, 0.75),
    };
    Rig::new("measured", joint(1.0, 1.0), setup)
}

fn lines() -> Lines {
    rig().lines(Noisy::Everything, ONE_PER_CENT, 1)
}

/// Identifies the joint; the model is given so that no beam is computed in the time that is measured.
fn identified(lines: &Lines, model: JointModel) -> LinesEstimate {
    let options = Options {
        noise: Noise::stated(ONE_PER_CENT),
        ..Options::default()
    };
    beams::identified(lines, model, &options)
}

/// Identifies so often, for a profiler.
pub(crate) fn repeat(count: usize) {
    let (lines, model) = (lines(), rig().model);
    for _ in 0..count {
        assert!(identified(&lines, model).assessment.fits());
    }
}

/// W of A and of B; then, line by line, ω, the upper triangles of what was measured of A and of B, row by row, and H^C_ss: all
/// little-endian doubles.
pub(crate) fn write(file: &Path) {
    let lines = lines();
    let mut numbers: Vec<f64> = Vec::new();
    let sides = [&lines.a, &lines.b].map(|side| side.measured().unwrap());
    for side in sides {
        let w = side.transformation();
        numbers.extend(
            w.row_iter()
                .flat_map(|row| row.iter().copied().collect::<Vec<_>>()),
        );
    }
    for (line, frequency_hz) in lines.frequency_hz.iter().enumerate() {
        numbers.push(std::f64::consts::TAU * frequency_hz);
        let mut push = |value: Complex64| numbers.extend([value.re, value.im]);
        for side in sides {
            let matrix = side.receptance(line);
            for i in 0..matrix.nrows() {
                (i..matrix.ncols()).for_each(|j| push(matrix[(i, j)]));
            }
        }
        let assembly = &lines.assembly[line];
        for i in 0..assembly.nrows() {
            (0..assembly.ncols()).for_each(|j| push(assembly[(i, j)]));
        }
    }
    let bytes: Vec<u8> = numbers.iter().flat_map(|n| n.to_le_bytes()).collect();
    std::fs::write(file, bytes).unwrap();
}

/// Both in turns.
pub(crate) fn against(python: &str) {
    let file = std::env::temp_dir().join(format!("measured-{}.bin", std::process::id()));
    write(&file);
    let (lines, model) = (lines(), rig().model);
    let mut times: [Vec<f64>; 3] = Default::default();
    let mut found = identified(&lines, model);
    let mut theirs = Vec::new();
    for _ in 0..TURNS {
        for _ in 0..REPETITIONS {
            let begun = Instant::now();
            found = identified(&lines, model);
            times[0].push(begun.elapsed().as_secs_f64());
        }
        for (own, threads) in times[1..].iter_mut().zip([Some("1"), None]) {
            let script = "measured_in_numpy.py";
            theirs = in_numpy(python, script, &file, &[REPETITIONS_IN_NUMPY], threads);
            own.extend(&theirs[0]);
        }
    }
    std::fs::remove_file(&file).unwrap();
    println!("{LINES} lines, three points, everything measured, with intervals; ms");
    let of_each = times.map(|mut times| {
        times.sort_by(f64::total_cmp);
        (times[times.len() / 2], times[0])
    });
    let names = [
        "this program",
        "NumPy, one BLAS thread",
        "NumPy, its own BLAS threads",
    ];
    for (name, (median, fastest)) in names.iter().zip(of_each) {
        let ratios = (median / of_each[0].0, fastest / of_each[0].1);
        println!(
            "{name:28} median {:6.1} = {:5.1} × ours, fastest {:6.1} = {:5.1} × ours",
            1e3 * median,
            ratios.0,
            1e3 * fastest,
            ratios.1
        );
    }
    compare(&found, &theirs);
}

/// Fails where the values, their deviations or the lines used are not the same.
fn compare(found: &LinesEstimate, theirs: &[Vec<f64>]) {
    let ours = unknowns(rig().model, found.free());
    let deviations = found.covariance().standard_deviation();
    let mut most = [0.0_f64; 2];
    for i in 0..ours.len() {
        let value = (ours[i] - theirs[1][i]) / deviations[i];
        let deviation = theirs[2][i] / deviations[i] - 1.0;
        most = [most[0].max(value.abs()), most[1].max(deviation.abs())];
    }
    let used = (found.lines_used.0, theirs[3][0] as usize);
    println!(
        "values differ by {:.4} standard deviations at most, these by {:.2} %; lines used {} and {}",
        most[0],
        100.0 * most[1],
        used.0,
        used.1
    );
    assert!(
        most.iter().all(|most| *most < MOST_APART),
        "{ours:?} {theirs:?}"
    );
}
