//! The surface with the smallest sum of squares.

use super::problem::{Problem, Unknowns};

/// Range of the fractal dimension that is searched.
const DIMENSIONS: [f64; 2] = [1.05, 1.95];
/// Range of how far, as a logarithm of lengths, the roughness stays below that with which the least loaded layer has no elastic contact.
const MARGINS: [f64; 2] = [1e-7, 60.0];
/// Points of the search along either.
const GRID: usize = 120;
/// Minima of the grid that are refined.
const STARTS: usize = 4;
const MOST_STEPS: usize = 500;
/// A change of the unknowns that is none.
const SMALL_STEP: f64 = 1e-13;
const DIFFERENCE: f64 = 1e-6;

impl Problem<'_> {
    /// The best minima of a grid.
    pub(super) fn starts(&self) -> Vec<Unknowns> {
        let margins = MARGINS.map(f64::ln);
        let place =
            |[low, high]: [f64; 2], n: usize| low + (high - low) * n as f64 / (GRID - 1) as f64;
        let at = |row: usize, column: usize| [place(DIMENSIONS, row), place(margins, column)];
        let values: Vec<f64> = (0..GRID * GRID)
            .map(|n| self.objective(at(n / GRID, n % GRID)))
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

    /// The minimum near a start, and its sum of squares.
    pub(super) fn refined(&self, start: Unknowns) -> (Unknowns, f64) {
        let mut at = start;
        let mut least = self.objective(at);
        let mut damping = 1e-3;
        for _ in 0..MOST_STEPS {
            let Some((matrix, gradient)) =
                self.normal_equations(|shift| self.residuals([at[0] + shift[0], at[1] + shift[1]]))
            else {
                break;
            };
            let Some(trial) = within(at, step(matrix, gradient, damping), |held| {
                gradient[1 - held] / (matrix[1 - held][1 - held] * (1.0 + damping))
            }) else {
                break;
            };
            let value = self.objective(trial);
            let change = (trial[0] - at[0]).abs().max((trial[1] - at[1]).abs());
            if value < least {
                (at, least) = (trial, value);
                damping = (0.2 * damping).max(1e-12);
            } else {
                damping *= 5.0;
            }
            if change < SMALL_STEP {
                break;
            }
        }
        (at, least)
    }

    /// JᵀJ and Jᵀr by central differences.
    pub(super) fn normal_equations(
        &self,
        residuals: impl Fn([f64; 2]) -> Option<Vec<[f64; 2]>>,
    ) -> Option<([[f64; 2]; 2], [f64; 2])> {
        let here = residuals([0.0; 2])?;
        let mut columns = Vec::new();
        for unknown in 0..2 {
            let shifted = |sign: f64| {
                let mut shift = [0.0; 2];
                shift[unknown] = sign * DIFFERENCE;
                residuals(shift)
            };
            let (above, below) = (shifted(1.0)?, shifted(-1.0)?);
            let slopes = above
                .iter()
                .zip(&below)
                .map(|(above, below)| [0, 1].map(|n| (above[n] - below[n]) / (2.0 * DIFFERENCE)));
            columns.push(slopes.collect::<Vec<[f64; 2]>>());
        }
        let product = |one: &[[f64; 2]], other: &[[f64; 2]]| -> f64 {
            let pairs = one.iter().zip(other);
            pairs.map(|(a, b)| a[0] * b[0] + a[1] * b[1]).sum()
        };
        let matrix =
            [0, 1].map(|row| [0, 1].map(|column| product(&columns[row], &columns[column])));
        let gradient = [0, 1].map(|row| product(&columns[row], &here));
        Some((matrix, gradient))
    }
}

/// Bounds of the unknowns.
pub(super) fn bounds() -> [[f64; 2]; 2] {
    [DIMENSIONS, MARGINS.map(f64::ln)]
}

/// The step of Levenberg and Marquardt, to be subtracted.
fn step(matrix: [[f64; 2]; 2], gradient: [f64; 2], damping: f64) -> Option<[f64; 2]> {
    let [[a, b], [c, d]] = matrix;
    solved(
        [[a * (1.0 + damping), b], [c, d * (1.0 + damping)]],
        gradient,
    )
}

/// Where a step leads within the bounds. An unknown that would leave them is held at its bound; the other one then takes the step `alone`.
fn within(at: Unknowns, step: Option<[f64; 2]>, alone: impl Fn(usize) -> f64) -> Option<Unknowns> {
    let bounds = bounds();
    let clamped = |n: usize, value: f64| value.clamp(bounds[n][0], bounds[n][1]);
    let step = step?;
    let mut trial = [0, 1].map(|n| clamped(n, at[n] - step[n]));
    for held in [0, 1] {
        let other = 1 - held;
        if trial[held] == at[held] && step[held] != 0.0 && bounds[held].contains(&at[held]) {
            trial[other] = clamped(other, at[other] - alone(held));
        }
    }
    Some(trial)
}

/// Solution of two equations, if they are independent.
pub(super) fn solved(matrix: [[f64; 2]; 2], right: [f64; 2]) -> Option<[f64; 2]> {
    let [[a, b], [c, d]] = matrix;
    let determinant = a * d - b * c;
    (determinant.abs() > 1e-13 * (a * d).abs()).then(|| {
        [
            (right[0] * d - right[1] * b) / determinant,
            (right[1] * a - right[0] * c) / determinant,
        ]
    })
}
