//! Where searches begin: the joint line by line where the functions reach all six motions of the interface, and stiffnesses by the
//! receptance that the joint sees.

use nalgebra::{DMatrix, DVector, Matrix6};
use num_complex::Complex64;

use crate::assembled::{Assembled, Reach};
use crate::error::SpatialError;
use crate::problem::{Problem, Unknowns};

/// Lines that are looked at.
const LINES: usize = 60;

/// Stiffnesses of the starts, in parts of what balances the structures.
const PARTS: [f64; 5] = [1.0, 0.1, 10.0, 0.01, 100.0];

/// The joint line by line, and in these parts of it.
const BESIDE: [f64; 5] = [1.0, 1.5, 0.7, 0.5, 0.3];

/// Loss factor of a start.
const LOSS: f64 = 0.02;

/// Singular values below this part of the largest are none.
const RANK: f64 = 1e-8;

/// Starts, the likely ones first.
pub(crate) fn starts(problem: &Problem) -> Result<Vec<Unknowns>, SpatialError> {
    let none = Unknowns(DVector::zeros(problem.count()));
    let assembled = Assembled::new(problem, &none)?;
    let lines = problem.frequency_hz.len();
    let step = lines.div_ceil(LINES).max(1);
    let looked_at: Vec<usize> = (0..lines).step_by(step).collect();
    let mut starts = Vec::new();
    if let Some(matrices) = line_by_line(problem, &assembled, &looked_at) {
        for part in BESIDE {
            starts.extend(of_matrices(problem, matrices.map(|matrix| part * matrix))?);
        }
    }
    // k = 1/|H_ii|, where joint and structures are alike
    let seen: Vec<Matrix6<Complex64>> = looked_at
        .iter()
        .map(|&line| assembled.reach(line).seen)
        .collect();
    let middle = problem.omega(lines / 2);
    for part in PARTS {
        let stiffness = Matrix6::from_diagonal(&nalgebra::Vector6::from_fn(|i, _| {
            let mut sizes: Vec<f64> = seen.iter().map(|h| h[(i, i)].norm()).collect();
            part / median(&mut sizes)
        }));
        if stiffness.iter().all(|entry| entry.is_finite()) {
            let damping = stiffness * (LOSS / middle);
            starts.extend(of_matrices(problem, [stiffness, damping])?);
        }
    }
    Ok(starts)
}

/// Unknowns nearest to K and C, without errors of the set-up.
fn of_matrices(
    problem: &Problem,
    matrices: [Matrix6<f64>; 2],
) -> Result<Option<Unknowns>, SpatialError> {
    let mut all = DVector::zeros(problem.count());
    let count = problem.model.count();
    for (n, matrix) in matrices.iter().enumerate() {
        let nearest = problem.model.nearest(matrix, problem.length_m)?;
        for (m, value) in nearest.unknowns.iter().enumerate() {
            all[n * count + m] = *value;
        }
    }
    let is_finite = all.iter().all(|x: &f64| x.is_finite());
    Ok(is_finite.then_some(Unknowns(all)))
}

/// K and C by the medians of D(ω) = X (I − H X)⁻¹, where Y − Y_C = Y Sᵀ X S Y in the observed functions; `None` where these do not
/// determine X.
fn line_by_line(
    problem: &Problem,
    assembled: &Assembled<'_>,
    lines: &[usize],
) -> Option<[Matrix6<f64>; 2]> {
    let mut found: Vec<[Matrix6<f64>; 2]> = Vec::new();
    let length = |i: usize| if i < 3 { 1.0 } else { problem.length_m };
    let [rows, columns] = problem.skips();
    for &line in lines {
        let Reach {
            by_loads,
            motions,
            seen: h,
        } = assembled.reach(line);
        let alone = |[o, i]: [usize; 2]| match (o < rows, i < columns) {
            (true, true) => problem.sides[0].lines[line][(o, i)],
            (false, false) => problem.sides[1].lines[line][(o - rows, i - columns)],
            _ => Complex64::default(),
        };
        // vec Z = (b ⊗ a) vec X over the observed pairs; rotations as lengths, K = ℓ K′ ℓ
        let design = DMatrix::from_fn(problem.observed.len(), 36, |row, column| {
            let [o, i] = problem.observed[row].at;
            let (m, n) = (column % 6, column / 6);
            by_loads[(o, m)] * motions[(n, i)] * Complex64::from(length(m) * length(n))
        });
        let right = DVector::from_fn(problem.observed.len(), |row, _| {
            let one = &problem.observed[row];
            alone(one.at) - one.values[line]
        });
        let svd = design.svd(true, true);
        let largest = svd.singular_values.max();
        if svd.singular_values.len() < 36 || svd.singular_values.min() <= RANK * largest {
            return None;
        }
        let x = svd.solve(&right, 0.0).ok()?;
        let x = Matrix6::from_fn(|m, n| x[6 * n + m] * Complex64::from(length(m) * length(n)));
        let inverse = (Matrix6::<Complex64>::identity() - h * x).try_inverse()?;
        let d = x * inverse;
        let omega = problem.omega(line);
        found.push([
            Matrix6::from_fn(|i, j| 0.5 * (d[(i, j)] + d[(j, i)]).re),
            Matrix6::from_fn(|i, j| 0.5 * (d[(i, j)] + d[(j, i)]).im / omega),
        ]);
    }
    let of = |part: usize| {
        let entry = |i: usize, j: usize| {
            let mut values: Vec<f64> = found.iter().map(|own| own[part][(i, j)]).collect();
            median(&mut values)
        };
        Matrix6::from_fn(|i, j| if i <= j { entry(i, j) } else { entry(j, i) })
    };
    let matrices = [of(0), of(1)];
    let is_finite = matrices
        .iter()
        .all(|matrix| matrix.iter().all(|x| x.is_finite()));
    is_finite.then_some(matrices)
}

fn median(values: &mut [f64]) -> f64 {
    values.sort_unstable_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
}
