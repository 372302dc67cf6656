//! How much each channel or impact counts.

use nalgebra::DMatrix;

use crate::{Role, VirtualPointError};

/// Share of the diagonal by which W may differ from its transpose.
const SYMMETRIC: f64 = 1e-9;

/// W of T = (Rᵀ W R)⁻¹ Rᵀ W. For channels the best one is the inverse of the covariance of their noise. For impacts
/// too: of all forces f with the same load m = R_fᵀ f, T_f m is the one with the smallest fᵀ W⁻¹ f.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Weights {
    /// All count the same.
    #[default]
    Equal,
    /// A positive number for each.
    Diagonal(Vec<f64>),
    /// A symmetric and positive definite matrix, n × n.
    Full(DMatrix<f64>),
}

impl Weights {
    /// W for so many places.
    pub(crate) fn matrix(
        &self,
        role: Role,
        count: usize,
    ) -> Result<DMatrix<f64>, VirtualPointError> {
        let what = match role {
            Role::Channel => "weights of the channels",
            Role::Impact => "weights of the impacts",
        };
        let sized = |found: usize| {
            let expected = count;
            if found == expected {
                Ok(())
            } else {
                Err(VirtualPointError::Size {
                    what,
                    found,
                    expected,
                })
            }
        };
        match self {
            Self::Equal => Ok(DMatrix::identity(count, count)),
            Self::Diagonal(weights) => {
                sized(weights.len())?;
                for &found in weights {
                    if !found.is_finite() {
                        return Err(VirtualPointError::NotFinite { what });
                    }
                    if found <= 0.0 {
                        let expected = "positive numbers";
                        return Err(VirtualPointError::NotPositive {
                            role,
                            found,
                            expected,
                        });
                    }
                }
                let diagonal = nalgebra::DVector::from_column_slice(weights);
                Ok(DMatrix::from_diagonal(&diagonal))
            }
            Self::Full(weights) => {
                sized(weights.nrows())?;
                sized(weights.ncols())?;
                if !weights.iter().all(|weight| weight.is_finite()) {
                    return Err(VirtualPointError::NotFinite { what });
                }
                definite(role, weights)?;
                Ok((weights + weights.transpose()) * 0.5)
            }
        }
    }
}

fn definite(role: Role, weights: &DMatrix<f64>) -> Result<(), VirtualPointError> {
    let largest = weights.diagonal().amax();
    for row in 0..weights.nrows() {
        for column in 0..row {
            let (found, mirrored) = (weights[(row, column)], weights[(column, row)]);
            if (found - mirrored).abs() > SYMMETRIC * largest {
                return Err(VirtualPointError::NotSymmetric {
                    role,
                    row,
                    column,
                    found,
                    mirrored,
                });
            }
        }
    }
    let found = weights.symmetric_eigenvalues().min();
    if found > 0.0 && weights.clone().cholesky().is_some() {
        return Ok(());
    }
    let expected = "a positive definite matrix";
    Err(VirtualPointError::NotPositive {
        role,
        found,
        expected,
    })
}

#[cfg(test)]
mod tests {
    use bolted_joint_testing::has;

    use super::*;

    #[test]
    fn what_is_no_weight_is_refused() {
        let refused = |weights: Weights| weights.matrix(Role::Impact, 3).unwrap_err();
        let short = Weights::Diagonal(vec![1.0; 2]);
        has(
            &refused(short).to_string(),
            &["weights of the impacts: found 2, expected 3"],
        );
        for (weight, words) in [
            (0.0, "found 0, expected positive"),
            (f64::NAN, "not finite"),
        ] {
            let error = refused(Weights::Diagonal(vec![1.0, weight, 1.0]));
            has(
                &error.to_string(),
                &["weights of the impacts: found", words],
            );
        }
        let flat = refused(Weights::Full(DMatrix::identity(3, 2)));
        assert!(matches!(flat, VirtualPointError::Size { found: 2, .. }));
        let mut full = DMatrix::<f64>::identity(3, 3);
        full[(2, 0)] = 0.5;
        has(
            &refused(Weights::Full(full.clone())).to_string(),
            &["found 0.5 at (2, 0) and 0 across the diagonal"],
        );
        full[(0, 2)] = 2.0;
        full[(2, 0)] = 2.0;
        let error = refused(Weights::Full(full.clone()));
        has(
            &error.to_string(),
            &["found -1", "expected a positive definite matrix"],
        );
        full[(0, 0)] = f64::INFINITY;
        assert!(matches!(
            refused(Weights::Full(full)),
            VirtualPointError::NotFinite { .. }
        ));
    }
}
