//! How large the noise of each function is, and the residuals.

use num_complex::Complex64;

use crate::assembled::Assembled;
use crate::error::SpatialError;
use crate::normal::Deviations;
use crate::parallel::over_lines;
use crate::problem::{Level, Observed, Problem, Unknowns};

/// Level of a function whose residual is nothing, in parts of its r.m.s.: rounding.
const LEAST_LEVEL: f64 = 1e-12;

/// Likewise where errors of the set-up are estimated: nobody measures better, and beside less the budget would be lost.
const LEAST_MEASURED: f64 = 1e-4;

/// Σ |computed|² in parts of Σ |residual|² at least: a structure that does not move makes functions zero that were measured.
const LEAST_COMPUTED: f64 = 1e-12;

/// Noise with which the errors of the set-up are searched where none is stated, in parts of the functions' r.m.s.
const NOISE: f64 = 0.01;

/// The level of each function's noise, as far as it is known before anything was found; `rms` are the functions' own.
pub(crate) fn first(problem: &Problem, level: Level, rms: &Deviations) -> Deviations {
    let parts = |part: f64| rms.iter().map(|rms| part * rms).collect();
    match (level, problem.error_count()) {
        (Level::Relative(part), _) => parts(part),
        (Level::OfCoherence, _) => {
            let all = problem.observed.iter().zip(rms);
            all.map(|(one, rms)| one.told.unwrap_or(*rms)).collect()
        }
        (Level::OfResiduals, 0) => rms.clone(),
        (Level::OfResiduals, _) => parts(NOISE),
    }
}

/// R.m.s. of each observed function.
pub(crate) fn sizes(problem: &Problem) -> Deviations {
    let sizes = problem.observed.iter().map(|one| size(&one.values));
    sizes.collect()
}

/// R.m.s. of a function.
pub(crate) fn size(values: &[Complex64]) -> f64 {
    root_mean_square(values.iter().map(Complex64::norm_sqr))
}

/// The level of each function's noise, by its residuals.
pub(crate) fn of_residuals(
    problem: &Problem,
    unknowns: &Unknowns,
    rms: &Deviations,
) -> Result<Deviations, SpatialError> {
    let squares = squares_by(problem, unknowns, Observed::uneven)?;
    // each function's share of the unknowns is spent
    let lines = problem.frequency_hz.len() as f64;
    let spent = problem.joint_count() as f64 / (2 * problem.observed.len()) as f64;
    let freedom = (lines - spent).max(1.0);
    let least = match problem.error_count() {
        0 => LEAST_LEVEL,
        _ => LEAST_MEASURED,
    };
    let levels = squares.iter().zip(rms);
    Ok(levels
        .map(|([residual, _], rms)| (residual / freedom).sqrt().max(least * rms))
        .collect())
}

/// Σ |measured − computed|² and Σ |computed|² of each function.
pub(crate) fn squares(
    problem: &Problem,
    unknowns: &Unknowns,
) -> Result<Vec<[f64; 2]>, SpatialError> {
    squares_by(problem, unknowns, |_, _| 1.0)
}

/// The same with residuals that are divided by so much.
fn squares_by(
    problem: &Problem,
    unknowns: &Unknowns,
    by: impl Fn(&Observed, usize) -> f64 + Sync,
) -> Result<Vec<[f64; 2]>, SpatialError> {
    let assembled = Assembled::new(problem, unknowns)?;
    let count = problem.observed.len();
    let parts = over_lines(problem.frequency_hz.len(), |lines| {
        let mut sums = vec![[0.0; 2]; count];
        for line in lines {
            let functions = assembled.line(line)?.functions;
            for ((sum, one), function) in sums.iter_mut().zip(&problem.observed).zip(functions) {
                sum[0] += ((one.values[line] - function) / by(one, line)).norm_sqr();
                sum[1] += function.norm_sqr();
            }
        }
        Ok::<_, SpatialError>(sums)
    })?;
    let mut sums = vec![[0.0; 2]; count];
    for part in parts {
        for (sum, own) in sums.iter_mut().zip(part) {
            *sum = [sum[0] + own[0], sum[1] + own[1]];
        }
    }
    Ok(sums)
}

pub(crate) fn relative_rms(problem: &Problem, unknowns: &Unknowns) -> Result<f64, SpatialError> {
    let squares = squares(problem, unknowns)?;
    let parts = squares.iter().map(|[residual, computed]| {
        let least = (LEAST_COMPUTED * residual).max(f64::MIN_POSITIVE);
        residual / computed.max(least)
    });
    Ok(root_mean_square(parts))
}

pub(crate) fn root_mean_square(squares: impl ExactSizeIterator<Item = f64>) -> f64 {
    let count = squares.len().max(1) as f64;
    (squares.sum::<f64>() / count).sqrt()
}
