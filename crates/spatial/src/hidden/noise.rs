//! How much each function counts, beside noise of the assembly's and of the substructures' functions.

use nalgebra::{Cholesky, DMatrix};
use num_complex::Complex64;

use crate::dyads::{Grid, Group, descent, information};
use crate::error::SpatialError;
use crate::part_noise::PartNoise;

/// Noise of a substructure that is said to have none, in parts of each value: nobody knows better.
const LEAST: f64 = 1e-4;

/// Values below this part of what their row and column have are noisy like such.
const FAINT: f64 = 1e-4;

/// Of the assembly's functions, and of those of the substructures at each line.
#[derive(Clone)]
pub(super) struct Grids {
    pub(super) assembly: Vec<Grid>,
    pub(super) own: [Vec<Grid>; 2],
}

impl Grids {
    /// As if all noise were so many times as large.
    pub(super) fn of(weights: &[DMatrix<f64>], own: &[Vec<DMatrix<f64>>; 2], factor: f64) -> Self {
        let by = factor.powi(-2);
        let grids = |own: &[DMatrix<f64>]| own.iter().map(|own| Grid::new(own * by)).collect();
        Self {
            assembly: grids(weights),
            own: own.each_ref().map(|own| grids(own)),
        }
    }
}

/// 1/σ² of functions with noise of these deviations.
pub(super) fn weights_by_line(
    functions: &DMatrix<Complex64>,
    deviations: &DMatrix<f64>,
) -> DMatrix<f64> {
    let faint = Faint::of(functions);
    DMatrix::from_fn(functions.nrows(), functions.ncols(), |i, j| {
        inverse_square(deviations[(i, j)].max(LEAST * faint.size(functions, i, j)))
    })
}

/// 1/σ² of functions with this noise.
pub(super) fn weights(functions: &DMatrix<Complex64>, noise: &PartNoise) -> DMatrix<f64> {
    let faint = Faint::of(functions);
    DMatrix::from_fn(functions.nrows(), functions.ncols(), |i, j| {
        let of_value = faint.size(functions, i, j) * noise.relative.max(LEAST);
        inverse_square(of_value.hypot(noise.floor(i, j)))
    })
}

fn inverse_square(size: f64) -> f64 {
    if size > 0.0 { size.powi(-2) } else { 0.0 }
}

/// How large a value counts where it is small beside the others of its row and column.
struct Faint {
    of_rows: Vec<f64>,
    of_columns: Vec<f64>,
    all: f64,
}

impl Faint {
    fn of(functions: &DMatrix<Complex64>) -> Self {
        let rms = |all: Vec<f64>| (all.iter().sum::<f64>() / all.len().max(1) as f64).sqrt();
        let rows = functions.row_iter();
        let columns = functions.column_iter();
        Self {
            of_rows: rows
                .map(|row| rms(row.iter().map(Complex64::norm_sqr).collect()))
                .collect(),
            of_columns: columns
                .map(|column| rms(column.iter().map(Complex64::norm_sqr).collect()))
                .collect(),
            all: rms(functions.iter().map(Complex64::norm_sqr).collect()),
        }
    }

    fn size(&self, functions: &DMatrix<Complex64>, i: usize, j: usize) -> f64 {
        let least = FAINT * self.of_rows[i] * self.of_columns[j] / self.all;
        functions[(i, j)].norm().max(least)
    }
}

/// h by weighted least squares.
pub(super) fn reduced_by(
    own: &Group,
    weights: &DMatrix<f64>,
    functions: &DMatrix<Complex64>,
) -> Result<DMatrix<Complex64>, SpatialError> {
    let grid = Grid::new(weights.clone());
    let own = std::slice::from_ref(own);
    let root = Cholesky::new(information(&grid, own)).ok_or(SpatialError::NotDetermined)?;
    let values = root.solve(&descent(&grid, own, functions));
    let (rows, columns) = (own[0].left.ncols(), own[0].right.nrows());
    Ok(DMatrix::from_row_slice(rows, columns, values.as_slice()))
}
