//! Sums over lines of what these say of dyads: no weight of a dyad in an unknown depends on the line.

use nalgebra::{DMatrix, DVector};
use num_complex::Complex64;

/// Sums over lines of M = Σ w conj(∂f/∂θ) ∂f/∂θ′ for all pairs of dyads, as far as the unknowns need them.
#[derive(Default)]
pub(crate) struct Sums {
    /// Σ Re M, its lower triangle.
    pub(crate) flat: DMatrix<f64>,
    /// Σ ω Im M, rows of the joints' dyads.
    pub(crate) tilted: DMatrix<f64>,
    /// Σ ω² Re M of the joints' dyads.
    pub(crate) curved: DMatrix<f64>,
    pub(crate) slopes: Slopes,
    pub(crate) squares: f64,
}

/// Sums over lines of s = Σ w conj(∂f/∂θ) e for all dyads.
#[derive(Clone, Default)]
pub(crate) struct Slopes {
    /// Σ Re s
    pub(crate) flat: DVector<f64>,
    /// Σ ω Im s of the joints' dyads.
    pub(crate) tilted: DVector<f64>,
}

impl Slopes {
    /// A line with s; the first dyads are those of the joints.
    pub(crate) fn add_line(&mut self, omega: f64, of_joints: usize, slopes: &DVector<Complex64>) {
        self.add(&Self {
            flat: slopes.map(|sum| sum.re),
            tilted: slopes.rows(0, of_joints).map(|sum| omega * sum.im),
        });
    }

    pub(crate) fn add(&mut self, other: &Self) {
        if self.flat.is_empty() {
            self.clone_from(other);
        } else if !other.flat.is_empty() {
            self.flat += &other.flat;
            self.tilted += &other.tilted;
        }
    }
}

impl Sums {
    /// Of no line yet, for so many dyads, of which the first are those of the joints.
    pub(crate) fn zeros(of_joints: usize, count: usize) -> Self {
        Self {
            flat: DMatrix::zeros(count, count),
            tilted: DMatrix::zeros(of_joints, count),
            curved: DMatrix::zeros(of_joints, of_joints),
            ..Self::default()
        }
    }

    /// A line with the lower triangle of M.
    pub(crate) fn add_line(&mut self, omega: f64, below: &DMatrix<Complex64>) {
        let of_joints = self.tilted.nrows();
        self.flat.zip_apply(below, |own, sum| *own += sum.re);
        let of = |i: usize, j: usize| match i < j {
            true => below[(j, i)].conj(),
            false => below[(i, j)],
        };
        for i in 0..of_joints {
            for j in 0..below.ncols() {
                self.tilted[(i, j)] += omega * of(i, j).im;
            }
            for j in 0..of_joints {
                self.curved[(i, j)] += omega * omega * of(i, j).re;
            }
        }
    }

    pub(crate) fn add(&mut self, other: &Self) {
        self.slopes.add(&other.slopes);
        self.squares += other.squares;
        if self.flat.is_empty() {
            self.flat = other.flat.clone();
            self.tilted = other.tilted.clone();
            self.curved = other.curved.clone();
        } else {
            self.flat += &other.flat;
            self.tilted += &other.tilted;
            self.curved += &other.curved;
        }
    }
}
