//! Equations that may leave something open: a joint without stiffness in some motion is no special case, as long as
//! nothing loads that motion.

use nalgebra::{ComplexField, DMatrix};

/// Pivots below this share of the largest one count as zero.
const NOTHING: f64 = 1e-12;

/// Right sides below this count as zero, where no pivot is left; the matrices are equilibrated.
const UNLOADED: f64 = 1e-9;

/// Diagonal s that brings the largest entry of each row and column of s A s near to one (Ruiz 2001), for a symmetric A;
/// zero rows keep 1. With it the rank does not depend on units.
pub(crate) fn equilibrating<T>(matrix: &DMatrix<T>) -> Vec<f64>
where
    T: ComplexField<RealField = f64> + Copy,
{
    let count = matrix.nrows();
    let mut scales = vec![1.0; count];
    for _ in 0..10 {
        let factors: Vec<f64> = (0..count)
            .map(|i| {
                let largest = (0..count)
                    .map(|j| matrix[(i, j)].modulus() * scales[i] * scales[j])
                    .fold(0.0, f64::max);
                if largest > 0.0 {
                    largest.sqrt().recip()
                } else {
                    1.0
                }
            })
            .collect();
        for (scale, factor) in scales.iter_mut().zip(factors) {
            *scale *= factor;
        }
    }
    scales
}

/// A solution of A X = B, by elimination with complete pivoting; what A leaves open is zero. None if B is not in the
/// range of A. A is equilibrated and B of the size of one.
pub(crate) fn solved<T>(mut matrix: DMatrix<T>, mut right: DMatrix<T>) -> Option<DMatrix<T>>
where
    T: ComplexField<RealField = f64> + Copy,
{
    let (count, sides) = (matrix.nrows(), right.ncols());
    let mut columns: Vec<usize> = (0..count).collect();
    let (mut rank, mut first) = (count, 0.0);
    for step in 0..count {
        let (row, column, pivot) = largest_from(&matrix, step);
        if step == 0 {
            first = pivot;
        }
        if pivot <= NOTHING * first {
            rank = step;
            break;
        }
        matrix.swap_rows(step, row);
        right.swap_rows(step, row);
        matrix.swap_columns(step, column);
        columns.swap(step, column);
        for below in step + 1..count {
            let factor = matrix[(below, step)] / matrix[(step, step)];
            for j in step..count {
                let change = factor * matrix[(step, j)];
                matrix[(below, j)] -= change;
            }
            for j in 0..sides {
                let change = factor * right[(step, j)];
                right[(below, j)] -= change;
            }
        }
    }
    if !right
        .rows(rank, count - rank)
        .iter()
        .all(|load| load.modulus() <= UNLOADED)
    {
        return None;
    }
    let mut solution = DMatrix::zeros(count, sides);
    for side in 0..sides {
        for step in (0..rank).rev() {
            let known = (step + 1..rank).fold(right[(step, side)], |rest, j| {
                rest - matrix[(step, j)] * solution[(columns[j], side)]
            });
            solution[(columns[step], side)] = known / matrix[(step, step)];
        }
    }
    Some(solution)
}

fn largest_from<T>(matrix: &DMatrix<T>, step: usize) -> (usize, usize, f64)
where
    T: ComplexField<RealField = f64> + Copy,
{
    let count = matrix.nrows();
    let places = (step..count).flat_map(|row| (step..count).map(move |column| (row, column)));
    places.fold((step, step, 0.0), |best, (row, column)| {
        let size = matrix[(row, column)].modulus();
        if size > best.2 {
            (row, column, size)
        } else {
            best
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::samples::scattered;

    #[test]
    fn a_regular_matrix_gives_back_its_solution() {
        let matrix = DMatrix::from_row_slice(4, 4, &scattered::<16>(1));
        let wanted = DMatrix::from_row_slice(4, 2, &scattered::<8>(2));
        let found = solved(matrix.clone(), &matrix * &wanted).unwrap();
        assert!((found - wanted).abs().max() < 1e-13);
    }

    #[test]
    fn a_singular_matrix_answers_loads_in_its_range_alone() {
        // no pivot on the diagonal, and the third motion has no stiffness
        let matrix = DMatrix::from_row_slice(3, 3, &[0.0, 1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
        let borne = DMatrix::from_row_slice(3, 1, &[2.0, 3.0, 0.0]);
        assert_eq!(
            solved(matrix.clone(), borne).unwrap().as_slice(),
            [3.0, 2.0, 0.0]
        );
        let free = DMatrix::from_row_slice(3, 1, &[0.0, 0.0, 1.0]);
        assert_eq!(solved(matrix, free), None);
        assert_eq!(
            solved(
                DMatrix::from_element(1, 1, f64::NAN),
                DMatrix::from_element(1, 1, f64::NAN)
            ),
            None
        );
    }

    #[test]
    fn equilibrated_rows_are_of_the_size_of_one() {
        let matrix = DMatrix::from_row_slice(3, 3, &[1e8, 1e2, 0.0, 1e2, 1e-3, 0.0, 0.0, 0.0, 0.0]);
        let scales = equilibrating(&matrix);
        for i in 0..2 {
            let largest = (0..3)
                .map(|j| matrix[(i, j)] * scales[i] * scales[j])
                .fold(0.0, f64::max);
            assert!((0.5..=2.0).contains(&largest), "{largest}");
        }
        assert_eq!(scales[2], 1.0);
    }
}
