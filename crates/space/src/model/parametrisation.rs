//! A joint's matrix as a linear function of unknowns.

use nalgebra::{DMatrix, DVector, Matrix6};

use crate::{Axes, Entry, Motions, Part, SpaceError};

/// Unknowns of a joint model, and the matrices that they are factors of.
#[derive(Clone, Debug, PartialEq)]
pub struct Parametrisation {
    entries: Vec<Entry>,
    bases: Vec<Matrix6<f64>>,
    axes: Axes,
}

/// The unknowns of a model that are nearest to a matrix.
#[derive(Clone, Debug, PartialEq)]
pub struct Nearest {
    /// In the order of [`Parametrisation::names`].
    pub unknowns: Vec<f64>,
    /// What of the matrix the model cannot hold.
    pub left_out: Matrix6<f64>,
    /// Size of that beside the matrix, Frobenius norms with rotations scaled by the length; 0 for a matrix that is
    /// zero.
    pub left_out_share: f64,
}

impl Parametrisation {
    pub(super) fn new(unknowns: Vec<(Entry, Matrix6<f64>)>, axes: Axes) -> Self {
        let (entries, bases) = unknowns.into_iter().unzip();
        Self {
            entries,
            bases,
            axes,
        }
    }

    /// The same unknowns with other matrices.
    pub(super) fn each(mut self, told: impl Fn(&Matrix6<f64>) -> Matrix6<f64>) -> Self {
        for basis in &mut self.bases {
            *basis = told(basis);
        }
        self
    }

    /// The unknowns between some motions alone, of a model each of whose unknowns is an entry of the matrix.
    ///
    /// # Errors
    ///
    /// [`SpaceError::TooFew`] where none is left, [`SpaceError::OfSixMotions`] for models whose unknowns are several entries.
    pub fn within(&self, motions: Motions) -> Result<Self, SpaceError> {
        let pairs = || self.entries.iter().copied().zip(self.bases.iter().copied());
        if pairs().any(|(entry, basis)| basis != entry.unit()) {
            return Err(SpaceError::OfSixMotions { motions });
        }
        let is_kept = |(entry, _): &(Entry, _)| motions.has(entry.row) && motions.has(entry.column);
        let kept: Vec<_> = pairs().filter(is_kept).collect();
        if kept.is_empty() {
            let (what, found, least) = ("numbers of the model between these motions", 0, 1);
            return Err(SpaceError::TooFew { what, found, least });
        }
        Ok(Self::new(kept, self.axes))
    }

    /// How many unknowns.
    #[must_use]
    pub fn count(&self) -> usize {
        self.entries.len()
    }

    /// What they are called, in [`Self::axes`]: `k_x`, `k_z`, `k_rx`, `k_rz`, `k_x_ry`.
    #[must_use]
    pub fn names(&self, part: Part) -> Vec<String> {
        self.entries.iter().map(|entry| entry.name(part)).collect()
    }

    /// Where each unknown stands first in the matrix that is told in [`Self::axes`].
    #[must_use]
    pub fn entries(&self) -> &[Entry] {
        &self.entries
    }

    /// The axes that the names refer to, told in those of the joint's matrix.
    #[must_use]
    pub fn axes(&self) -> &Axes {
        &self.axes
    }

    /// dK/dp of each unknown. They do not depend on the unknowns.
    #[must_use]
    pub fn bases(&self) -> &[Matrix6<f64>] {
        &self.bases
    }

    /// The joint's matrix, K = Σ p dK/dp.
    ///
    /// # Errors
    ///
    /// [`SpaceError::Size`] for more or fewer numbers than unknowns.
    pub fn matrix(&self, unknowns: &[f64]) -> Result<Matrix6<f64>, SpaceError> {
        let (what, found, expected) = ("unknowns", unknowns.len(), self.count());
        if found != expected {
            return Err(SpaceError::Size {
                what,
                found,
                expected,
            });
        }
        Ok(self
            .bases
            .iter()
            .zip(unknowns)
            .map(|(basis, unknown)| basis * *unknown)
            .sum())
    }

    /// The unknowns whose matrix is nearest to a given one: least squares over all 36 entries, where a rotation counts
    /// as much as the translation that it makes at a distance of `length_m`.
    ///
    /// # Errors
    ///
    /// [`SpaceError::Value`] for a length that is not positive, [`SpaceError::NotFinite`] for a matrix that holds no number.
    pub fn nearest(&self, matrix: &Matrix6<f64>, length_m: f64) -> Result<Nearest, SpaceError> {
        if !(length_m > 0.0 && length_m.is_finite()) {
            let (what, expected) = ("length that scales rotations, m", "a positive number");
            return Err(SpaceError::Value {
                what,
                found: length_m,
                expected,
            });
        }
        if !matrix.iter().all(|number| number.is_finite()) {
            return Err(SpaceError::NotFinite {
                what: "the joint's matrix",
            });
        }
        // minimise ‖s (K − Σ p dK/dp) s‖, s = diag(1, 1, 1, 1/ℓ, 1/ℓ, 1/ℓ)
        let scaled = |matrix: &Matrix6<f64>| {
            let power = |i: usize| i32::from(i > 2);
            Matrix6::from_fn(|i, j| matrix[(i, j)] / length_m.powi(power(i) + power(j)))
        };
        let columns: Vec<Matrix6<f64>> = self.bases.iter().map(scaled).collect();
        let sizes: Vec<f64> = columns.iter().map(Matrix6::norm).collect();
        let design = DMatrix::from_fn(36, self.count(), |row, n| columns[n][row] / sizes[n]);
        let right = DVector::from_column_slice(scaled(matrix).as_slice());
        let fitted = bolted_joint_singular::solution(design, &right, 1e-13);
        let fitted = fitted.ok_or(SpaceError::NotFinite {
            what: "the model's matrices",
        })?;
        let unknowns: Vec<f64> = fitted
            .iter()
            .zip(&sizes)
            .map(|(value, size)| value / size)
            .collect();
        let left_out = matrix - self.matrix(&unknowns)?;
        let whole = right.norm();
        let left_out_share = if whole > 0.0 {
            scaled(&left_out).norm() / whole
        } else {
            0.0
        };
        Ok(Nearest {
            unknowns,
            left_out,
            left_out_share,
        })
    }
}

#[cfg(test)]
mod tests;
