//! What every matrix of a passive joint has: numbers, symmetry, and no motion that gives energy away.

use nalgebra::{Matrix6, SymmetricEigen};

use crate::elimination::equilibrating;
use crate::{Entry, SpaceError};

/// Differences across the diagonal above this, for entries of the size of one, are no rounding.
const ROUNDING: f64 = 1e-9;

/// Refuses a matrix that holds no number or is not symmetric.
pub(crate) fn checked(matrix: &Matrix6<f64>) -> Result<(), SpaceError> {
    let scaled = equilibrated(matrix)?;
    for Entry { row, column } in Entry::ALL {
        let (i, j) = (row.index(), column.index());
        // rows of a matrix that is not symmetric may not be equilibrated by its columns' factors
        let size = scaled[(i, j)].abs().max(1.0);
        if (scaled[(i, j)] - scaled[(j, i)]).abs() > ROUNDING * size {
            let (found, mirrored) = (matrix[(i, j)], matrix[(j, i)]);
            return Err(SpaceError::NotSymmetric {
                row,
                column,
                found,
                mirrored,
            });
        }
    }
    Ok(())
}

/// Refuses a symmetric matrix (K or C) that is not positive semidefinite, up to rounding.
///
/// # Errors
///
/// [`SpaceError::NotPassive`] with the smallest eigenvalue of the matrix whose rows and columns are scaled to the size
/// of one, so that it does not depend on units; [`SpaceError::NotSymmetric`], [`SpaceError::NotFinite`].
pub fn semidefinite(matrix: &Matrix6<f64>) -> Result<(), SpaceError> {
    checked(matrix)?;
    let found = SymmetricEigen::new(equilibrated(matrix)?).eigenvalues.min();
    if found >= -ROUNDING * 1e-3 {
        return Ok(());
    }
    Err(SpaceError::NotPassive {
        condition: "smallest eigenvalue of the scaled matrix",
        found,
    })
}

fn equilibrated(matrix: &Matrix6<f64>) -> Result<Matrix6<f64>, SpaceError> {
    if !matrix.iter().all(|number| number.is_finite()) {
        return Err(SpaceError::NotFinite {
            what: "the joint's matrix",
        });
    }
    let scales = equilibrating(&nalgebra::DMatrix::from_fn(6, 6, |i, j| matrix[(i, j)]));
    Ok(Matrix6::from_fn(|i, j| {
        matrix[(i, j)] * scales[i] * scales[j]
    }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::samples::{check_stiffness, definite};
    use crate::{Dof, transported};

    #[test]
    fn a_passive_matrix_passes_at_every_point() {
        for seed in 0..10 {
            assert_eq!(semidefinite(&definite(seed)), Ok(()));
        }
        // rank 3 and told far away
        let mut translations = Matrix6::zeros();
        translations.fixed_view_mut::<3, 3>(0, 0).fill_diagonal(2e7);
        let far = transported(&translations, &nalgebra::Vector3::new(3.0, -2.0, 1.0));
        assert_eq!(semidefinite(&far), Ok(()));
        assert_eq!(semidefinite(&Matrix6::zeros()), Ok(()));
    }

    #[test]
    fn energy_that_comes_from_nowhere_is_found() {
        // k_x k_ry < k_x_ry²
        let mut stiffness = check_stiffness();
        stiffness[(0, 4)] = 1.01 * (2e7_f64 * 6e3).sqrt();
        stiffness[(4, 0)] = stiffness[(0, 4)];
        assert!(
            matches!(semidefinite(&stiffness), Err(SpaceError::NotPassive { found, .. }) if found < -1e-3)
        );
    }

    #[test]
    fn what_is_not_symmetric_is_named() {
        let mut stiffness = check_stiffness();
        stiffness[(4, 0)] *= -1.0;
        let refused = semidefinite(&stiffness);
        let (row, column) = (Dof::X, Dof::Ry);
        assert_eq!(
            refused,
            Err(SpaceError::NotSymmetric {
                row,
                column,
                found: 1e5,
                mirrored: -1e5
            })
        );
        stiffness[(2, 2)] = f64::NAN;
        assert!(matches!(
            checked(&stiffness),
            Err(SpaceError::NotFinite { .. })
        ));
    }
}
