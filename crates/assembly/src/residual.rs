//! What stands for the modes that are cut, so that joints and loads see the whole flexibility of a structure.
//!
//! The static deflections of the cut modes under a load at each point, Ψ = Σ_cut φ φ_pᵀ/ω², are made orthogonal in mass and
//! stiffness: pseudo-modes that have the right flexibility at rest, and that need no other equations than modes.

use bolted_joint_frf::Dof;
use nalgebra::{DMatrix, DVector, SymmetricEigen};

use crate::modal_form::ModalForm;

/// Deflections that others make up to this part (of their kinetic energy) are none of their own.
const DEPENDENT: f64 = 1e-10;
/// Rounding of a product with the basis, as a part of the largest that it can be.
const ROUNDING: f64 = 32.0 * f64::EPSILON;

/// All modes of a structure, in ascending order.
pub(crate) struct AllModes {
    pub(crate) points: Vec<Dof>,
    /// ω, rad/s, those of free motions zero.
    pub(crate) frequency_rad_per_s: DVector<f64>,
    /// φᵀCφ, 1/s.
    pub(crate) damping_per_s: DMatrix<f64>,
    /// One row a point.
    pub(crate) shapes: DMatrix<f64>,
}

impl AllModes {
    /// How many free motions there are: they have no flexibility that a pseudo-mode could stand for.
    pub(crate) fn rigid(&self) -> usize {
        let frequencies = self.frequency_rad_per_s.iter();
        frequencies.filter(|own| **own == 0.0).count()
    }

    /// The structure with its first `kept` modes, all free motions among them, and pseudo-modes for the others.
    pub(crate) fn cut_to(self, kept: usize) -> ModalForm {
        let all = self.frequency_rad_per_s.len();
        if kept >= all {
            return ModalForm {
                points: self.points,
                frequency_rad_per_s: self.frequency_rad_per_s,
                damping_per_s: self.damping_per_s,
                shapes: self.shapes,
                modes: all,
                cut: 0,
            };
        }
        let cut = all - kept;
        let squares = self
            .frequency_rad_per_s
            .rows(kept, cut)
            .map(|own| own * own);
        let shapes = self.shapes.columns(kept, cut);
        let (own_squares, basis) = pseudo_modes(&shapes.into_owned(), &squares);
        // T = (I, 0; 0, basis): K and M stay diagonal, C is what it is
        let mut basis_of_all = DMatrix::zeros(all, kept + basis.ncols());
        basis_of_all
            .view_mut((0, 0), (kept, kept))
            .fill_with_identity();
        basis_of_all
            .view_mut((kept, kept), (cut, basis.ncols()))
            .copy_from(&basis);
        let mut frequency = DVector::zeros(kept + basis.ncols());
        frequency
            .rows_mut(0, kept)
            .copy_from(&self.frequency_rad_per_s.rows(0, kept));
        frequency
            .rows_mut(kept, basis.ncols())
            .copy_from(&own_squares.map(f64::sqrt));
        let damping = basis_of_all.transpose() * &self.damping_per_s * &basis_of_all;
        ModalForm {
            points: self.points,
            frequency_rad_per_s: frequency,
            damping_per_s: without_rounding(&damping),
            shapes: &self.shapes * &basis_of_all,
            modes: kept,
            cut,
        }
    }
}

/// A damping matrix without what rounding has left between coordinates that do not damp each other.
fn without_rounding(damping: &DMatrix<f64>) -> DMatrix<f64> {
    DMatrix::from_fn(damping.nrows(), damping.ncols(), |i, j| {
        let rounding = ROUNDING * (damping[(i, i)] * damping[(j, j)]).sqrt();
        match i == j || damping[(i, j)].abs() > rounding {
            true => damping[(i, j)],
            false => 0.0,
        }
    })
}

/// ω² of the pseudo-modes, and what they are of the cut modes.
fn pseudo_modes(shapes: &DMatrix<f64>, squares: &DVector<f64>) -> (DVector<f64>, DMatrix<f64>) {
    let cut = squares.len();
    // Ψ, each deflection of unit kinetic energy
    let mut deflections = DMatrix::from_fn(cut, shapes.nrows(), |k, p| shapes[(p, k)] / squares[k]);
    for mut column in deflections.column_iter_mut() {
        let size = column.norm();
        if size > 0.0 {
            column /= size;
        }
    }
    let mass = SymmetricEigen::new(deflections.transpose() * &deflections);
    let largest = mass.eigenvalues.max();
    let independent: Vec<usize> = (0..mass.eigenvalues.len())
        .filter(|&i| mass.eigenvalues[i] > DEPENDENT * largest)
        .collect();
    if independent.is_empty() {
        // the points do not move, as those of a clamped end
        return (DVector::zeros(0), DMatrix::zeros(cut, 0));
    }
    let unit = DMatrix::from_fn(deflections.ncols(), independent.len(), |p, n| {
        mass.eigenvectors[(p, independent[n])] / mass.eigenvalues[independent[n]].sqrt()
    });
    let basis = deflections * unit;
    let weighted = DMatrix::from_fn(cut, basis.ncols(), |k, n| squares[k] * basis[(k, n)]);
    let stiffness = SymmetricEigen::new(basis.transpose() * weighted);
    (stiffness.eigenvalues, basis * stiffness.eigenvectors)
}
