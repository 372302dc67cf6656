//! Joint models: which entries of the joint's stiffness and damping matrices are unknown.

use std::fmt;

use nalgebra::DMatrix;
use num_complex::Complex64;
use serde::{Deserialize, Serialize};

use bolted_joint_frf::structure::ComplexMatrix;
use bolted_joint_joint::DofSet;

/// Structure of the joint's matrices (Tol section 4.2.2).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum JointModel {
    /// Model 1: translation only, k_Fy + jω c_Fy.
    Translation,
    /// Model 2: translation and rotation without cross-coupling.
    Diagonal,
    /// Model 3: the full symmetric 2×2 matrix.
    Full,
}

impl JointModel {
    /// DOFs of the joint: 1 (y) or 2 (y, θ).
    #[must_use]
    pub fn dofs(self) -> usize {
        match self {
            Self::Translation => 1,
            Self::Diagonal | Self::Full => 2,
        }
    }

    /// Row and column of the unknown entries on and above the diagonal.
    #[must_use]
    pub fn entries(self) -> &'static [(usize, usize)] {
        match self {
            Self::Translation => &[(0, 0)],
            Self::Diagonal => &[(0, 0), (1, 1)],
            Self::Full => &[(0, 0), (0, 1), (1, 1)],
        }
    }

    /// Number of unknowns: each entry has a stiffness and a damping.
    #[must_use]
    pub fn unknowns(self) -> usize {
        2 * self.entries().len()
    }
}

impl From<JointModel> for DofSet {
    fn from(model: JointModel) -> Self {
        match model {
            JointModel::Translation => Self::TRANSLATION,
            JointModel::Diagonal | JointModel::Full => Self::TRANSLATION_ROTATION,
        }
    }
}

impl fmt::Display for JointModel {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Translation => "translation",
            Self::Diagonal => "diagonal",
            Self::Full => "full",
        })
    }
}

/// K and C of a joint, symmetric, in SI units; order of DOFs y, θ.
#[derive(Clone, Debug, PartialEq)]
pub struct JointMatrices {
    /// K: N/m, N/rad, N·m/m, N·m/rad.
    pub stiffness: DMatrix<f64>,
    /// C: N·s/m, N·s/rad, N·m·s/m, N·m·s/rad.
    pub damping: DMatrix<f64>,
}

impl JointMatrices {
    /// K* = K + jωC at one frequency.
    #[must_use]
    pub fn complex_stiffness(&self, frequency_hz: f64) -> ComplexMatrix {
        let omega = std::f64::consts::TAU * frequency_hz;
        self.stiffness
            .zip_map(&self.damping, |k, c| Complex64::new(k, omega * c))
    }

    /// K and C of several bolts, block diagonal (Tol 3.27): the DOFs of the first bolt come first.
    #[must_use]
    pub fn of_bolts(bolts: &[Self]) -> Self {
        let blocks = |matrix: fn(&Self) -> &DMatrix<f64>| {
            let size = bolts.iter().map(|bolt| matrix(bolt).nrows()).sum();
            let mut whole = DMatrix::zeros(size, size);
            let mut start = 0;
            for bolt in bolts {
                let block = matrix(bolt);
                whole
                    .view_mut((start, start), block.shape())
                    .copy_from(block);
                start += block.nrows();
            }
            whole
        };
        Self {
            stiffness: blocks(|bolt| &bolt.stiffness),
            damping: blocks(|bolt| &bolt.damping),
        }
    }

    /// K and C of each bolt of a joint whose bolts have `dofs` DOFs each; what couples the bolts is left out.
    #[must_use]
    pub fn bolts(&self, dofs: usize) -> Vec<Self> {
        let block = |matrix: &DMatrix<f64>, bolt: usize| {
            matrix
                .view((bolt * dofs, bolt * dofs), (dofs, dofs))
                .into_owned()
        };
        (0..self.stiffness.nrows() / dofs)
            .map(|bolt| Self {
                stiffness: block(&self.stiffness, bolt),
                damping: block(&self.damping, bolt),
            })
            .collect()
    }

    /// Matrices of `model` from its unknowns: the stiffness of each entry, then the damping of each entry.
    pub(super) fn from_unknowns(model: JointModel, unknowns: &[f64]) -> Self {
        Self::of_entries(model.dofs(), model.entries(), unknowns)
    }

    /// Matrices over `dofs` from the stiffness of each of `entries`, then the damping of each.
    pub(super) fn of_entries(dofs: usize, entries: &[(usize, usize)], unknowns: &[f64]) -> Self {
        let (stiffness, damping) = unknowns.split_at(entries.len());
        let matrix = |values: &[f64]| {
            let mut matrix = DMatrix::zeros(dofs, dofs);
            for (&(row, column), &value) in entries.iter().zip(values) {
                matrix[(row, column)] = value;
                matrix[(column, row)] = value;
            }
            matrix
        };
        Self {
            stiffness: matrix(stiffness),
            damping: matrix(damping),
        }
    }

    /// The unknowns of `model` in the order of [`Self::from_unknowns`].
    pub(super) fn unknowns(&self, model: JointModel) -> Vec<f64> {
        [&self.stiffness, &self.damping]
            .into_iter()
            .flat_map(|matrix| model.entries().iter().map(|&place| matrix[place]))
            .collect()
    }
}

/// Whether a symmetric matrix of a joint is passive; the judgement of the joint file.
pub(super) fn is_positive_semidefinite(matrix: &DMatrix<f64>) -> bool {
    match matrix.nrows() {
        1 => bolted_joint_dynamics::is_positive_semidefinite(&[[matrix[(0, 0)]]]),
        2 => bolted_joint_dynamics::is_positive_semidefinite(&[
            [matrix[(0, 0)], matrix[(0, 1)]],
            [matrix[(1, 0)], matrix[(1, 1)]],
        ]),
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn unknowns_and_matrices_are_each_others_inverse() {
        for model in [
            JointModel::Translation,
            JointModel::Diagonal,
            JointModel::Full,
        ] {
            let unknowns: Vec<f64> = (1..=model.unknowns()).map(|i| i as f64).collect();
            let matrices = JointMatrices::from_unknowns(model, &unknowns);
            assert_eq!(matrices.stiffness, matrices.stiffness.transpose());
            assert_eq!(matrices.unknowns(model), unknowns);
        }
        let full = JointMatrices::from_unknowns(JointModel::Full, &[1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
        assert_eq!(full.stiffness, nalgebra::dmatrix![1.0, 2.0; 2.0, 3.0]);
        assert_eq!(full.damping, nalgebra::dmatrix![4.0, 5.0; 5.0, 6.0]);
    }
}
