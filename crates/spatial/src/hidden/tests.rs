use nalgebra::DMatrix;

use super::follow::advanced;
use super::*;
use crate::samples::{number, problem, problem_anew, unknowns};

fn noise() -> [PartNoise; 2] {
    [0.02, 0.03].map(PartNoise::of_values)
}

#[test]
fn functions_count_by_the_noise_that_coherence_tells_of_each_value() {
    let functions = DMatrix::from_element(2, 2, Complex64::new(3.0, 4.0));
    let told = DMatrix::from_row_slice(2, 2, &[0.1, 0.5, 2.0, 0.0]);
    let found = noise::weights_by_line(&functions, &told);
    let expected = [(0, 0, 100.0), (0, 1, 4.0), (1, 0, 0.25)];
    for (i, j, weight) in expected {
        assert!((found[(i, j)] / weight - 1.0).abs() < 1e-12, "{found}");
    }
    // what is said to be exact is known to a ten-thousandth
    assert!((found[(1, 1)] * (5e-4_f64).powi(2) - 1.0).abs() < 1e-12);
}

/// A problem whose functions follow from rigid interfaces, but for some noise; its levels and where it is looked at.
fn sample(problem: Problem) -> (Problem, Deviations, Unknowns) {
    let mut problem = problem.smoothed().unwrap();
    let mut seed = 9;
    for side in &mut problem.sides {
        for line in &mut side.lines {
            line.apply(|value| *value *= 1.0 + 0.02 * number(&mut seed));
        }
    }
    let at = unknowns(&problem);
    let joint = Unknowns(at.0.rows(0, problem.joint_count()).into_owned());
    let exact = problem.displaced(&at).unwrap();
    for line in 0..problem.frequency_hz.len() {
        let functions = crate::assembled::Assembled::new(&exact, &joint)
            .and_then(|assembled| assembled.line(line))
            .unwrap()
            .functions;
        for (one, function) in problem.observed.iter_mut().zip(functions) {
            one.values[line] = function * (1.0 + 0.02 * number(&mut seed));
        }
    }
    let level = problem
        .observed
        .iter()
        .map(|one| 0.02 * one.values[0].norm())
        .collect();
    (problem, level, at)
}

/// How far each unknown is moved.
fn step(problem: &Problem, at: &Unknowns, unknown: usize) -> f64 {
    match unknown < problem.joint_count() {
        true => 1e-4 * at.0[unknown].abs().max(1.0),
        false => 1e-5,
    }
}

fn moved(at: &Unknowns, unknown: usize, by: f64) -> Unknowns {
    let mut own = at.clone();
    own.0[unknown] += by;
    own
}

/// Reference: differences of the squares, with h at its best for either side.
#[test]
fn the_descent_is_that_of_the_squares_without_h() {
    compare_descent(problem());
}

#[test]
fn the_descent_by_what_is_anew_is_that_of_the_squares_without_h() {
    compare_descent(problem_anew());
}

fn compare_descent(problem: Problem) {
    let (problem, level, at) = sample(problem);
    let mut squares = Beside::of(&problem, &level, &noise(), &at).unwrap();
    let normal = squares.normal(&at).unwrap();
    assert!((normal.cost - squares.cost(&at).unwrap()).abs() < 1e-6 * normal.cost);
    for unknown in 0..problem.count() {
        let by = step(&problem, &at, unknown);
        let [above, below] = [by, -by].map(|by| squares.cost(&moved(&at, unknown, by)).unwrap());
        let expected = (below - above) / (4.0 * by);
        let size = normal.information[(unknown, unknown)].sqrt() * normal.cost.sqrt();
        let error = (normal.descent[unknown] - expected).abs();
        assert!(
            error < 1e-4 * size,
            "{unknown}: {} {expected}",
            normal.descent[unknown]
        );
    }
}

/// Reference: the information on all unknowns and all of h by a table of differences, from which h is eliminated.
#[test]
fn the_information_is_that_of_a_table_of_differences() {
    compare_information(problem());
}

#[test]
fn the_information_on_what_is_anew_is_that_of_a_table_of_differences() {
    compare_information(problem_anew());
}

fn compare_information(problem: Problem) {
    let (problem, level, at) = sample(problem);
    let squares = Beside::of(&problem, &level, &noise(), &at).unwrap();
    let normal = squares.normal_as_measured(&at).unwrap();
    let count = problem.count();
    let mut expected = DMatrix::<f64>::zeros(count, count);
    for line in 0..problem.frequency_hz.len() {
        // residuals in their deviations, real and imaginary parts, for unknowns and h
        let whitened = |unknowns: &Unknowns, hidden: &Hidden| {
            let model = squares.model(unknowns).unwrap();
            let computed = model.line(line, hidden).unwrap();
            let mut all = Vec::new();
            for (one, level) in problem.observed.iter().zip(&level) {
                all.push(computed.assembly[(one.at[0], one.at[1])] / *level);
            }
            for n in [0, 1] {
                let weights = &squares.own_weights[n][line];
                let own = computed.substructures[n].zip_map(weights, |y, w| y * w.sqrt());
                all.extend(own.iter());
            }
            let parts = all.iter().flat_map(|y| [y.re, y.im]);
            nalgebra::DVector::from_vec(parts.collect()) * 2.0_f64.sqrt()
        };
        let hidden = &squares.measured[line];
        let mut columns = Vec::new();
        for unknown in 0..count {
            let by = step(&problem, &at, unknown);
            let [above, below] = [by, -by].map(|by| whitened(&moved(&at, unknown, by), hidden));
            columns.push((above - below) / (2.0 * by));
        }
        let of_h: usize = hidden.iter().map(DMatrix::len).sum();
        for n in 0..of_h {
            for unit in [Complex64::ONE, Complex64::I] {
                let step = DVector::from_fn(of_h, |m, _| {
                    if m == n {
                        unit * 1e-12
                    } else {
                        Complex64::ZERO
                    }
                });
                let [above, below] =
                    [1.0, -1.0].map(|part| whitened(&at, &advanced(hidden, &step, part)));
                columns.push((above - below) / 2e-12);
            }
        }
        let table = DMatrix::from_columns(&columns);
        let all = table.ad_mul(&table);
        let own = all.view((0, 0), (count, count));
        let cross = all.view((count, 0), (2 * of_h, count));
        let of_h = all.view((count, count), (2 * of_h, 2 * of_h));
        let root = of_h.into_owned().cholesky().unwrap();
        expected += own - cross.ad_mul(&root.solve(&cross.into_owned()));
    }
    for (n, deviation) in problem.own_deviations().into_iter().enumerate() {
        let place = problem.joint_count() + n;
        expected[(place, place)] += deviation.powi(-2);
    }
    for i in 0..count {
        for j in 0..count {
            let size = (expected[(i, i)] * expected[(j, j)]).sqrt();
            let error = (normal.information[(i, j)] - expected[(i, j)]).abs();
            assert!(error < 1e-4 * size, "{i} {j}: {error:e} {size:e}");
        }
    }
}

#[test]
fn the_square_of_a_matrix_is_that_of_its_adjoint_with_it() {
    let of = |i: usize, j: usize| Complex64::new((3 * i + j) as f64, (i * j) as f64 - 2.0);
    let matrix = DMatrix::from_fn(4, 3, of);
    let expected = matrix.adjoint() * &matrix;
    let mut left = expected.clone();
    subtract_square(&mut left, &matrix);
    assert!(left.norm() < 1e-12 * expected.norm());
}
