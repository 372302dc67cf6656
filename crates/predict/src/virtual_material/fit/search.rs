//! Where the surface with the smallest sum of squares is looked for.

use super::problem::{Problem, Unknowns};
use crate::least_squares::TwoUnknowns;

/// Range of the fractal dimension that is searched.
const DIMENSIONS: [f64; 2] = [1.05, 1.95];
/// Range of how far, as a logarithm of lengths, the roughness stays below that with which the least loaded layer has no elastic contact.
const MARGINS: [f64; 2] = [1e-7, 60.0];
/// Points of the search along either.
const GRID: usize = 120;
/// Minima of the grid that are refined.
const STARTS: usize = 4;

impl Problem<'_> {
    /// The sum of squares over the surfaces.
    pub(super) fn squares(&self) -> TwoUnknowns<impl Fn(Unknowns) -> Option<Vec<[f64; 2]>>> {
        TwoUnknowns {
            residuals: |at| self.residuals(at),
            bounds: bounds(),
        }
    }

    /// The best minima of a grid.
    pub(super) fn starts(&self) -> Vec<Unknowns> {
        let margins = MARGINS.map(f64::ln);
        let place =
            |[low, high]: [f64; 2], n: usize| low + (high - low) * n as f64 / (GRID - 1) as f64;
        let at = |row: usize, column: usize| [place(DIMENSIONS, row), place(margins, column)];
        let squares = self.squares();
        let values: Vec<f64> = (0..GRID * GRID)
            .map(|n| squares.objective(at(n / GRID, n % GRID)))
            .collect();
        let is_least = |n: usize| {
            let (row, column) = (n / GRID, n % GRID);
            let rows = row.saturating_sub(1)..=(row + 1).min(GRID - 1);
            let columns = column.saturating_sub(1)..=(column + 1).min(GRID - 1);
            values[n].is_finite()
                && rows.into_iter().all(|row| {
                    columns
                        .clone()
                        .all(|column| values[n] <= values[row * GRID + column])
                })
        };
        let mut minima: Vec<usize> = (0..GRID * GRID).filter(|&n| is_least(n)).collect();
        minima.sort_by(|&one, &other| values[one].total_cmp(&values[other]));
        minima.truncate(STARTS);
        minima.into_iter().map(|n| at(n / GRID, n % GRID)).collect()
    }
}

/// Bounds of the unknowns.
pub(super) fn bounds() -> [[f64; 2]; 2] {
    [DIMENSIONS, MARGINS.map(f64::ln)]
}
