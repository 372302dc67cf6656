//! What one line says of the reduced functions, of the joint and of the set-up together.

use nalgebra::{DMatrix, DVector};
use num_complex::Complex64;

use crate::dyads::{Grid, Group, descent, information, squares};

/// Functions that are compared, with the dyads of what changes them.
pub(super) struct Compared<'g> {
    pub(super) grid: &'g Grid,
    /// Measured less computed.
    pub(super) errors: DMatrix<Complex64>,
    /// Where the dyads of each group begin among all.
    pub(super) groups: Vec<(usize, Group)>,
}

/// Σ w conj(∂f/∂θ) ∂f/∂θ′, Σ w conj(∂f/∂θ) e and Σ w |e|² over all functions of a line.
pub(super) struct Gathered {
    pub(super) products: DMatrix<Complex64>,
    pub(super) slopes: DVector<Complex64>,
    pub(super) squares: f64,
}

/// Σ w conj(∂f/∂θ) e alone.
pub(super) fn slopes(count: usize, all: &[Compared<'_>]) -> DVector<Complex64> {
    let mut sum = DVector::zeros(count);
    for Compared {
        grid,
        errors,
        groups,
    } in all
    {
        for (place, group) in groups {
            let mut own = sum.rows_mut(*place, group.count());
            own += descent(grid, std::slice::from_ref(group), errors);
        }
    }
    sum
}

impl Gathered {
    pub(super) fn of(count: usize, all: Vec<Compared<'_>>) -> Self {
        let mut sum = Self {
            products: DMatrix::zeros(count, count),
            slopes: DVector::zeros(count),
            squares: 0.0,
        };
        for Compared {
            grid,
            errors,
            groups,
        } in all
        {
            let (places, groups): (Vec<usize>, Vec<Group>) = groups.into_iter().unzip();
            let counts: Vec<usize> = groups.iter().map(Group::count).collect();
            let products = information(grid, &groups);
            let slopes = descent(grid, &groups, &errors);
            sum.squares += squares(grid, &errors);
            let mut row = 0;
            for (&place, &height) in places.iter().zip(&counts) {
                let mut own = sum.slopes.rows_mut(place, height);
                own += slopes.rows(row, height);
                let mut column = 0;
                for (&other, &width) in places.iter().zip(&counts) {
                    let mut own = sum.products.view_mut((place, other), (height, width));
                    own += products.view((row, column), (height, width));
                    column += width;
                }
                row += height;
            }
        }
        sum
    }
}
