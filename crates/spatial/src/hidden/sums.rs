//! What one line says of the reduced functions, of the joint and of the set-up together.

use nalgebra::{DMatrix, DVector};
use num_complex::Complex64;

use crate::dyads::{Grid, Group, add_below, add_descent, mirror, squares};

/// Functions that are compared, with the dyads of what changes them.
pub(super) struct Compared<'g> {
    pub(super) grid: &'g Grid,
    /// Measured less computed.
    pub(super) errors: DMatrix<Complex64>,
    /// Where the dyads of each group begin among all.
    pub(super) groups: Vec<(usize, Group)>,
}

/// Σ w conj(∂f/∂θ) ∂f/∂θ′, Σ w conj(∂f/∂θ) e and Σ w |e|² over all functions of a line.
#[derive(Default)]
pub(super) struct Gathered {
    pub(super) products: DMatrix<Complex64>,
    pub(super) slopes: DVector<Complex64>,
    pub(super) squares: f64,
}

impl Compared<'_> {
    fn placed(&self) -> Vec<(usize, &Group)> {
        let groups = self.groups.iter();
        groups.map(|(place, group)| (*place, group)).collect()
    }
}

/// Σ w conj(∂f/∂θ) e alone.
pub(super) fn slopes(count: usize, all: &[Compared<'_>]) -> DVector<Complex64> {
    let mut sum = DVector::zeros(count);
    for own in all {
        add_descent(own.grid, &own.placed(), &own.errors, &mut sum);
    }
    sum
}

impl Gathered {
    pub(super) fn of(count: usize, all: &[Compared<'_>]) -> Self {
        let mut sum = Self::default();
        sum.gather(count, all);
        sum
    }

    /// Those of another line in the place of what it holds: memory of this size takes long to get for every line.
    pub(super) fn gather(&mut self, count: usize, all: &[Compared<'_>]) {
        self.products.resize_mut(count, count, Complex64::default());
        self.products.fill(Complex64::default());
        self.slopes = DVector::zeros(count);
        self.squares = 0.0;
        for own in all {
            let placed = own.placed();
            add_below(own.grid, &placed, &mut self.products);
            add_descent(own.grid, &placed, &own.errors, &mut self.slopes);
            self.squares += squares(own.grid, &own.errors);
        }
        mirror(&mut self.products);
    }
}
