//! Where searches for several joints begin: the joints line by line where the functions reach all motions of the interfaces, and
//! stiffnesses by the receptance that the joints see.

use nalgebra::{DMatrix, DVector, Matrix6};
use num_complex::Complex64;

use crate::chain::assembled::{Assembled, Open};
use crate::chain::problem::{Problem, Unknowns};
use crate::chain::side::MOTIONS;
use crate::error::SpatialError;

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
    let assembled = Assembled::open(problem)?;
    let lines = problem.frequency_hz.len();
    let step = lines.div_ceil(LINES).max(1);
    let looked_at: Vec<usize> = (0..lines).step_by(step).collect();
    let open: Vec<(usize, Open)> = looked_at
        .iter()
        .map(|&line| Ok((line, assembled.at_joints(line)?)))
        .collect::<Result<_, SpatialError>>()?;
    let mut starts = Vec::new();
    if let Some(matrices) = line_by_line(problem, &open) {
        for part in BESIDE {
            let own: Vec<_> = matrices
                .iter()
                .map(|own| own.map(|matrix| part * matrix))
                .collect();
            starts.extend(of_matrices(problem, &own)?);
        }
    }
    // k = 1/|H_ii|, where joint and structures are alike
    let middle = problem.omega(lines / 2);
    for part in PARTS {
        let own: Vec<[Matrix6<f64>; 2]> = (0..problem.links.sought().len())
            .map(|joint| {
                let stiffness = Matrix6::from_diagonal(&nalgebra::Vector6::from_fn(|dof, _| {
                    let i = MOTIONS * joint + dof;
                    let mut sizes: Vec<f64> = open
                        .iter()
                        .map(|(_, open)| open.seen[(i, i)].norm())
                        .collect();
                    part / median(&mut sizes)
                }));
                [stiffness, stiffness * (LOSS / middle)]
            })
            .collect();
        if own
            .iter()
            .flatten()
            .all(|matrix| matrix.iter().all(|entry| entry.is_finite()))
        {
            starts.extend(of_matrices(problem, &own)?);
        }
    }
    Ok(starts)
}

/// Unknowns nearest to K and C of each joint that is sought, without errors of the set-up.
fn of_matrices(
    problem: &Problem,
    matrices: &[[Matrix6<f64>; 2]],
) -> Result<Option<Unknowns>, SpatialError> {
    let mut all = DVector::zeros(problem.count());
    let joints = problem.links.nearest(matrices)?;
    all.rows_mut(0, joints.len()).copy_from(&joints);
    let is_finite = all.iter().all(|x: &f64| x.is_finite());
    Ok(is_finite.then_some(Unknowns(all)))
}

/// K and C of each joint by the medians of D(ω) = X (I − H X)⁻¹, where Y − Y_C = Y Sᵀ X S Y in the observed functions; `None` where
/// these do not determine X, or are not all between the same rows and columns.
fn line_by_line(problem: &Problem, open: &[(usize, Open)]) -> Option<Vec<[Matrix6<f64>; 2]>> {
    let size = MOTIONS * problem.links.sought().len();
    let grid = Grid::of(problem)?;
    let mut found: Vec<[DMatrix<f64>; 2]> = Vec::new();
    let length = |i: usize| {
        if i % MOTIONS < 3 {
            1.0
        } else {
            problem.length_m()
        }
    };
    for (line, open) in open {
        // Z = A X B has the least squares X = A⁺ Z B⁺; rotations as lengths, K = ℓ K′ ℓ
        let a = DMatrix::from_fn(grid.rows.len(), size, |n, m| {
            open.by_loads[(grid.rows[n], m)] * Complex64::from(length(m))
        });
        let b = DMatrix::from_fn(size, grid.columns.len(), |m, n| {
            open.motions[(m, grid.columns[n])] * Complex64::from(length(m))
        });
        let z = DMatrix::from_fn(grid.rows.len(), grid.columns.len(), |n, m| {
            let measured = problem.observed[grid.at[(n, m)]].values[*line];
            open.alone[(grid.rows[n], grid.columns[m])] - measured
        });
        let x = inverse(&a, size)? * z * inverse(&b, size)?;
        let x = DMatrix::from_fn(size, size, |m, n| {
            x[(m, n)] * Complex64::from(length(m) * length(n))
        });
        let identity = DMatrix::<Complex64>::identity(size, size);
        let d = &x * (identity - &open.seen * &x).try_inverse()?;
        let omega = problem.omega(*line);
        let symmetric = |i: usize, j: usize| 0.5 * (d[(i, j)] + d[(j, i)]);
        found.push([
            DMatrix::from_fn(size, size, |i, j| symmetric(i, j).re),
            DMatrix::from_fn(size, size, |i, j| symmetric(i, j).im / omega),
        ]);
    }
    let of = |joint: usize, part: usize| {
        let entry = |i: usize, j: usize| {
            let at = (MOTIONS * joint + i, MOTIONS * joint + j);
            let mut values: Vec<f64> = found.iter().map(|own| own[part][at]).collect();
            median(&mut values)
        };
        Matrix6::from_fn(|i, j| if i <= j { entry(i, j) } else { entry(j, i) })
    };
    let matrices: Vec<_> = (0..size / MOTIONS)
        .map(|joint| [of(joint, 0), of(joint, 1)])
        .collect();
    let is_finite = matrices
        .iter()
        .flatten()
        .all(|matrix| matrix.iter().all(|x| x.is_finite()));
    is_finite.then_some(matrices)
}

/// Rows and columns between all of which functions were measured.
struct Grid {
    rows: Vec<usize>,
    columns: Vec<usize>,
    /// The number of the function of each row and column.
    at: DMatrix<usize>,
}

impl Grid {
    fn of(problem: &Problem) -> Option<Self> {
        let places = |which: usize| {
            let mut all: Vec<usize> = problem.observed.iter().map(|one| one.at[which]).collect();
            all.sort_unstable();
            all.dedup();
            all
        };
        let (rows, columns) = (places(0), places(1));
        if problem.observed.len() != rows.len() * columns.len() {
            return None;
        }
        let mut at = DMatrix::zeros(rows.len(), columns.len());
        for (n, one) in problem.observed.iter().enumerate() {
            let [row, column] = one.at;
            at[(
                rows.binary_search(&row).ok()?,
                columns.binary_search(&column).ok()?,
            )] = n;
        }
        Some(Self { rows, columns, at })
    }
}

/// The pseudo-inverse of a matrix of this rank.
fn inverse(matrix: &DMatrix<Complex64>, rank: usize) -> Option<DMatrix<Complex64>> {
    let svd = matrix.clone().svd(true, true);
    let found = svd.rank(RANK * svd.singular_values.max());
    (found == rank)
        .then(|| svd.pseudo_inverse(0.0).ok())
        .flatten()
}

fn median(values: &mut [f64]) -> f64 {
    values.sort_unstable_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
}
