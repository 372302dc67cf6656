//! Sums over functions that are few: the table of what each dyad does to each of them costs less than sums over rows and
//! columns, which pay only where these are many.

use nalgebra::DMatrix;
use num_complex::Complex64;

use crate::dyads::{Grid, Group};
use crate::sums::Sums;

/// Functions up to which the table is less work.
const FEW: usize = 24;

/// Real rows of the table whose products are taken at once.
const ROWS: usize = 256;

/// The table of some lines.
pub(crate) struct Few {
    dyads: usize,
    /// √w Re ∂f/∂θ and √w Im ∂f/∂θ of each function: dyads × rows.
    parts: Vec<f64>,
    /// √w Im ∂f/∂θ and −√w Re ∂f/∂θ likewise.
    turned: Vec<f64>,
    /// ω of each row.
    omegas: Vec<f64>,
}

impl Few {
    /// For functions like these; `None` where there are many.
    pub(crate) fn of(grid: &Grid, dyads: usize) -> Option<Self> {
        let is_few = grid.functions().count() <= FEW;
        is_few.then(|| Self {
            dyads,
            parts: Vec::new(),
            turned: Vec::new(),
            omegas: Vec::new(),
        })
    }

    /// A line, of which `sums` hear at once or with others.
    pub(crate) fn add_line(&mut self, omega: f64, grid: &Grid, groups: &[Group], sums: &mut Sums) {
        let mut derivatives = Vec::with_capacity(self.dyads);
        for ([row, column], weight) in grid.functions() {
            derivatives.clear();
            for group in groups {
                // θ_pq at p·right + q
                for x in &group.left.row(row) {
                    let x = weight.sqrt() * x;
                    derivatives.extend(group.right.column(column).iter().map(|y| x * y));
                }
            }
            let own: &[Complex64] = &derivatives;
            self.parts.extend(own.iter().map(|own| own.re));
            self.parts.extend(own.iter().map(|own| own.im));
            self.turned.extend(own.iter().map(|own| own.im));
            self.turned.extend(own.iter().map(|own| -own.re));
            self.omegas.extend([omega; 2]);
        }
        if self.omegas.len() >= ROWS {
            self.sum_up(sums);
        }
    }

    /// Adds what the table holds, and empties it.
    pub(crate) fn sum_up(&mut self, sums: &mut Sums) {
        let omegas = std::mem::take(&mut self.omegas);
        let of = |values: &mut Vec<f64>| {
            DMatrix::from_vec(self.dyads, omegas.len(), std::mem::take(values))
        };
        let [parts, turned] = [of(&mut self.parts), of(&mut self.turned)];
        // Re M = Σ Re ∂fᵀ Re ∂f + Im ∂fᵀ Im ∂f
        sums.flat.gemm(1.0, &parts, &parts.transpose(), 1.0);
        let mut of_joints = parts.rows(0, sums.tilted.nrows()).into_owned();
        for (mut row, omega) in of_joints.column_iter_mut().zip(&omegas) {
            row *= *omega;
        }
        // ω Im M = Σ ω (Re ∂fᵀ Im ∂f − Im ∂fᵀ Re ∂f)
        sums.tilted.gemm(1.0, &of_joints, &turned.transpose(), 1.0);
        sums.curved
            .gemm(1.0, &of_joints, &of_joints.transpose(), 1.0);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dyads::{add_below, side_by_side};
    use crate::samples::number;

    /// The table against sums over rows and columns, of four functions of some thirty.
    #[test]
    fn a_table_says_what_rows_and_columns_say() {
        let mut seed = 5;
        let mut matrix = |rows: usize, columns: usize| {
            DMatrix::from_fn(rows, columns, |_, _| {
                Complex64::new(number(&mut seed), number(&mut seed))
            })
        };
        let mut weights = DMatrix::zeros(5, 6);
        for (place, weight) in [((0, 0), 2.0), ((3, 0), 0.5), ((0, 4), 1.0), ((4, 5), 3.0)] {
            weights[place] = weight;
        }
        let grid = Grid::new(weights);
        assert_eq!(grid.functions().count(), 4);
        let of_joints = 6;
        let [mut of_table, mut of_dyads] = [(); 2].map(|()| Sums::zeros(of_joints, 6 + 12));
        let mut few = Few::of(&grid, 6 + 12).unwrap();
        for omega in [1.0, 3.0, 4.0] {
            let groups = [(2, 3), (4, 3)].map(|(left, right)| Group {
                left: matrix(5, left),
                right: matrix(right, 6),
            });
            few.add_line(omega, &grid, &groups, &mut of_table);
            let (count, placed) = side_by_side(&groups);
            let mut below = DMatrix::zeros(count, count);
            add_below(&grid, &placed, &mut below);
            of_dyads.add_line(omega, &below);
        }
        few.sum_up(&mut of_table);
        for sums in [&mut of_table, &mut of_dyads] {
            sums.flat.fill_upper_triangle_with_lower_triangle();
        }
        assert!((&of_table.flat - &of_dyads.flat).norm() < 1e-12 * of_dyads.flat.norm());
        assert!((&of_table.tilted - &of_dyads.tilted).norm() < 1e-12 * of_dyads.tilted.norm());
        assert!((&of_table.curved - &of_dyads.curved).norm() < 1e-12 * of_dyads.curved.norm());
        assert!(Few::of(&Grid::new(DMatrix::repeat(5, 6, 1.0)), 18).is_none());
    }
}
