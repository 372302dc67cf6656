//! What is to be explained at each line, in parts of its size.

use std::collections::BTreeMap;

use nalgebra::DMatrix;
use num_complex::Complex64;

use super::Loosened;
use crate::assembled::Open;
use crate::normal::Deviations;
use crate::patterns::Patterns;
use crate::problem::Problem;

/// One line.
pub(super) struct Line {
    pub(super) omega: f64,
    /// H, motions × motions.
    pub(super) seen: DMatrix<Complex64>,
    pub(super) parts: Vec<Part>,
}

/// Columns of the same rows.
pub(super) struct Part {
    /// U/|Y|, rows × own motions.
    pub(super) by_loads: DMatrix<Complex64>,
    /// (Y₀ − Y)/|Y|, rows × columns.
    pub(super) change: DMatrix<Complex64>,
    /// b₀, motions × columns.
    pub(super) motions: DMatrix<Complex64>,
    /// |b₀|
    pub(super) size: f64,
}

/// Factors of rows and of columns.
struct Factors([Vec<f64>; 2]);

impl Loosened {
    /// Lines count alike down to this part of the functions' r.m.s.
    pub(super) fn of(problem: &Problem, open: &[Open], level: &Deviations, floor: f64) -> Self {
        let weights = problem.weights(level);
        let factors = Factors::of(&weights);
        let alike = columns_of_rows(&weights);
        let scales = problem.links.scales();
        let scales: Vec<f64> = (problem.links.sought().iter())
            .flat_map(|joint| scales[joint.motions()].to_vec())
            .collect();
        let own = problem.links.own_motions();
        let square = |line: usize| {
            let all = problem.observed.iter();
            let own = all.map(|one| (one.values[line] * factors.at(one.at)).norm_sqr());
            own.sum::<f64>() / problem.observed.len() as f64
        };
        let squares: Vec<f64> = (0..open.len()).map(square).collect();
        let least = floor * floor * squares.iter().sum::<f64>() / squares.len() as f64;
        let lines = open.iter().zip(&squares).enumerate();
        let lines = lines.map(|(line, (open, square))| {
            let size = (square + least).sqrt();
            let mut change = DMatrix::zeros(weights.nrows(), weights.ncols());
            for (one, function) in problem.observed.iter().zip(&open.functions) {
                let factor = factors.at(one.at) / size;
                change[(one.at[0], one.at[1])] = (function - one.values[line]) * factor;
            }
            let part = |(rows, columns): (&Vec<usize>, &Vec<usize>)| {
                let [by_row, by_column] = &factors.0;
                let mut motions = open.motions.select_columns(columns);
                for (mut own, &column) in motions.column_iter_mut().zip(columns) {
                    own.scale_mut(by_column[column]);
                }
                let squares = own.iter().map(|&motion| {
                    motions.row(motion).norm_squared() * scales[motion] * scales[motion]
                });
                let mean = squares.sum::<f64>() / (own.len() * columns.len()) as f64;
                Part {
                    by_loads: DMatrix::from_fn(rows.len(), own.len(), |n, m| {
                        open.by_loads[(rows[n], own[m])] * (by_row[rows[n]] / size)
                    }),
                    change: change.select_rows(rows).select_columns(columns),
                    motions,
                    // a line that counts less counts less in its motions, too
                    size: mean.sqrt() * size / square.sqrt(),
                }
            };
            Line {
                omega: problem.omega(line),
                seen: open.seen.clone(),
                parts: alike.iter().map(part).collect(),
            }
        });
        Self {
            lines: lines.collect(),
            scales: own.iter().map(|&motion| scales[motion]).collect(),
            patterns: Patterns::of_joints(problem),
            own,
        }
    }
}

/// The columns that have the same rows.
fn columns_of_rows(weights: &DMatrix<f64>) -> BTreeMap<Vec<usize>, Vec<usize>> {
    let mut alike: BTreeMap<Vec<usize>, Vec<usize>> = BTreeMap::new();
    for (column, own) in weights.column_iter().enumerate() {
        let rows: Vec<usize> = (0..own.len()).filter(|&row| own[row] > 0.0).collect();
        if !rows.is_empty() {
            alike.entry(rows).or_default().push(column);
        }
    }
    alike
}

impl Factors {
    /// Those whose products are nearest to the roots of these weights, in their logarithms: loads are the same for all columns then.
    fn of(weights: &DMatrix<f64>) -> Self {
        let mean = |own: Vec<f64>| own.iter().sum::<f64>() / own.len().max(1) as f64;
        let roots = weights.map(|weight| 0.5 * weight.ln());
        let by_row: Vec<f64> = (roots.row_iter())
            .map(|row| mean(row.iter().copied().filter(|own| own.is_finite()).collect()))
            .collect();
        let rest = |column: usize| {
            let own = roots.column(column);
            let rest = own.iter().zip(&by_row).map(|(own, row)| own - row);
            mean(rest.filter(|own| own.is_finite()).collect())
        };
        let by_column: Vec<f64> = (0..roots.ncols()).map(rest).collect();
        Self([by_row, by_column].map(|own| own.into_iter().map(f64::exp).collect()))
    }

    fn at(&self, [row, column]: [usize; 2]) -> f64 {
        self.0[0][row] * self.0[1][column]
    }
}
