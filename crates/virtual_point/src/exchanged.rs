//! Whether two channels, or two impacts, stand in each other's place: cables that were exchanged, or rows of a table.

use nalgebra::DMatrix;
use num_complex::Complex64;

use crate::{Role, VirtualPoint, VirtualPointError};

/// What is left of the misfit where the right two are put back, at most: errors of positions, directions and gains stay.
const LEFT: f64 = 0.1;
/// Any other two leave more than that by this factor.
const BESIDE: f64 = 2.0;

impl VirtualPoint {
    /// The two channels or impacts that stand in each other's place: with them put back a tenth of the misfit is left at most, and
    /// with any other two more than twice as much. None where nothing is so, or where there are no more than the motions.
    ///
    /// With G = (I − R T)ᵀ W (I − R T) and M = Σ Re(S Sᴴ) the misfit is tr(G M), and that of exchanged rows tr(G P M Pᵀ).
    ///
    /// # Errors
    ///
    /// Those of [`Self::consistency`].
    pub fn exchanged(
        &self,
        role: Role,
        lines: &[DMatrix<Complex64>],
    ) -> Result<Option<[usize; 2]>, VirtualPointError> {
        let spread = self.spread(role, lines)?.matrix;
        let projection = self.projection(role);
        let rest = projection.rest();
        let left = rest.transpose() * projection.weights() * rest;
        let misfit = left.dot(&spread);
        let count = self.count(role);
        if count <= self.motion_count() || misfit <= 0.0 {
            return Ok(None);
        }
        let mut pairs: Vec<(f64, [usize; 2])> = (0..count)
            .flat_map(|one| (one + 1..count).map(move |other| [one, other]))
            .map(|pair| (misfit + change(&left, &spread, pair), pair))
            .collect();
        pairs.sort_by(|(one, _), (other, _)| one.total_cmp(other));
        let [(least, pair), others @ ..] = &pairs[..] else {
            return Ok(None);
        };
        let next = others.first().map_or(f64::INFINITY, |(next, _)| *next);
        let is_it = *least < LEFT * misfit && next > BESIDE * least.max(0.0);
        Ok(is_it.then_some(*pair))
    }
}

/// tr(G P M Pᵀ) − tr(G M) where P exchanges two rows: Σ over the rows and columns of these two.
fn change(left: &DMatrix<f64>, spread: &DMatrix<f64>, [i, j]: [usize; 2]) -> f64 {
    let others = (0..left.nrows()).filter(|&row| row != i && row != j);
    let beside: f64 = others
        .map(|row| (left[(i, row)] - left[(j, row)]) * (spread[(j, row)] - spread[(i, row)]))
        .sum();
    let own = (left[(i, i)] - left[(j, j)]) * (spread[(j, j)] - spread[(i, i)]);
    2.0 * beside + own
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::samples::*;

    #[test]
    fn the_change_is_that_of_exchanged_rows() {
        let mut mixed = Mixed(5);
        let mut symmetric = || {
            let own = DMatrix::from_fn(6, 6, |_, _| mixed.next());
            &own + own.transpose()
        };
        let (left, spread) = (symmetric(), symmetric());
        for (i, j) in [(0, 1), (2, 5), (3, 4)] {
            let mut exchanged = spread.clone();
            exchanged.swap_rows(i, j);
            exchanged.swap_columns(i, j);
            let expected = left.dot(&exchanged) - left.dot(&spread);
            assert!((change(&left, &spread, [i, j]) - expected).abs() < 1e-12);
        }
    }

    /// Among errors of the budget each exchange is named or left open, and nothing where all are in their places.
    #[test]
    fn what_is_exchanged_is_named_among_errors_of_the_budget() {
        let (mut named, mut all) = (0, 0);
        for seed in 1..=6 {
            let (point, lines) = trial(1000 * seed, None);
            for role in [Role::Channel, Role::Impact] {
                assert_eq!(point.exchanged(role, &lines).unwrap(), None);
                let count = point.count(role);
                for one in 0..count {
                    for other in one + 1..count {
                        let exchanged = lines.iter().map(|line| {
                            let mut line = line.clone();
                            match role {
                                Role::Channel => line.swap_rows(one, other),
                                Role::Impact => line.swap_columns(one, other),
                            }
                            line
                        });
                        let exchanged: Vec<_> = exchanged.collect();
                        let found = point.exchanged(role, &exchanged).unwrap();
                        assert!(found.is_none_or(|found| found == [one, other]), "{found:?}");
                        named += usize::from(found.is_some());
                        all += 1;
                    }
                }
            }
        }
        assert!(named * 10 > 9 * all, "{named} of {all}");
    }
}
