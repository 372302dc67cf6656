//! A structure given by its mass, damping and stiffness matrices, and its undamped modes.

use nalgebra::{Cholesky, DMatrix, DVector, SymmetricEigen};
use num_complex::Complex64;

use super::StructureError;
use super::banded::Banded;

/// Mass, viscous damping and stiffness matrices in SI units.
#[derive(Clone, Debug, PartialEq)]
pub struct SpatialModel {
    mass: DMatrix<f64>,
    damping: DMatrix<f64>,
    stiffness: DMatrix<f64>,
}

/// Undamped modes, mass normalised, in ascending order of frequency.
#[derive(Clone, Debug, PartialEq)]
pub struct Modes {
    /// ω_r in rad/s; rounding of a rigid-body mode may leave a small number instead of zero.
    pub angular_frequency: DVector<f64>,
    /// One column a mode.
    pub shapes: DMatrix<f64>,
}

impl Modes {
    /// Natural frequencies, Hz.
    #[must_use]
    pub fn frequency_hz(&self) -> Vec<f64> {
        self.angular_frequency
            .iter()
            .map(|omega| omega / std::f64::consts::TAU)
            .collect()
    }
}

impl SpatialModel {
    /// A structure from its n×n matrices: kg, N·s/m, N/m and their rotational counterparts.
    ///
    /// # Errors
    /// [`StructureError::Shapes`] if the matrices are not square and of one size.
    pub fn new(
        mass: DMatrix<f64>,
        damping: DMatrix<f64>,
        stiffness: DMatrix<f64>,
    ) -> Result<Self, StructureError> {
        let shape = mass.shape();
        if shape.0 != shape.1 || damping.shape() != shape || stiffness.shape() != shape {
            return Err(StructureError::Shapes {
                mass: shape,
                damping: damping.shape(),
                stiffness: stiffness.shape(),
            });
        }
        Ok(Self {
            mass,
            damping,
            stiffness,
        })
    }

    /// Receptance matrix (n×n) at one frequency.
    ///
    /// # Errors
    /// [`StructureError::Resonance`] at an undamped resonance.
    pub fn receptance(&self, frequency_hz: f64) -> Result<DMatrix<Complex64>, StructureError> {
        // H = (K + jωC − ω²M)⁻¹
        let omega = std::f64::consts::TAU * frequency_hz;
        let dynamic_stiffness = DMatrix::from_fn(self.mass.nrows(), self.mass.ncols(), |i, j| {
            Complex64::new(
                self.stiffness[(i, j)] - omega * omega * self.mass[(i, j)],
                omega * self.damping[(i, j)],
            )
        });
        dynamic_stiffness
            .try_inverse()
            .ok_or(StructureError::Resonance {
                what: "the dynamic stiffness is singular",
                frequency_hz,
                reason: "an undamped resonance",
                advice: "add damping or leave that line out",
            })
    }

    /// Number of coordinates.
    #[must_use]
    pub fn size(&self) -> usize {
        self.mass.nrows()
    }

    /// φᵀCφ of mass-normalised shapes: damping between the modes, 1/s.
    #[must_use]
    pub fn modal_damping(&self, modes: &Modes) -> DMatrix<f64> {
        modes.shapes.transpose() * &self.damping * &modes.shapes
    }

    /// φᵀKφ of each mode, rad²/s²; below zero where the stiffness is not positive semidefinite.
    #[must_use]
    pub fn modal_stiffness(&self, modes: &Modes) -> DVector<f64> {
        let product = &self.stiffness * &modes.shapes;
        DVector::from_fn(product.ncols(), |r, _| {
            modes.shapes.column(r).dot(&product.column(r))
        })
    }

    /// Undamped natural frequencies and mass-normalised shapes.
    ///
    /// # Errors
    /// [`StructureError::Mass`] if the mass matrix is not positive definite.
    pub fn modes(&self) -> Result<Modes, StructureError> {
        // K φ = ω² M φ with M = L Lᵀ: the eigenvectors q of L⁻¹ K L⁻ᵀ give φ = L⁻ᵀ q.
        let factor = Cholesky::new(self.mass.clone()).ok_or(StructureError::Mass)?;
        let lower = Banded::of(factor.l_dirty());
        let half = lower.solve(self.stiffness.clone());
        let reduced = lower.solve(half.transpose());
        let symmetric = (&reduced + reduced.transpose()) * 0.5;
        let eigen = SymmetricEigen::new(symmetric);
        let vectors = lower.solve_transposed(eigen.eigenvectors);
        let mut order: Vec<usize> = (0..eigen.eigenvalues.len()).collect();
        order.sort_by(|&i, &j| eigen.eigenvalues[i].total_cmp(&eigen.eigenvalues[j]));
        Ok(Modes {
            angular_frequency: DVector::from_iterator(
                order.len(),
                order.iter().map(|&i| eigen.eigenvalues[i].max(0.0).sqrt()),
            ),
            shapes: vectors.select_columns(&order),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::dmatrix;

    /// Tol Table 4.1: ground–m1–m2–joint–m3–m4–ground.
    fn lumped_chain() -> SpatialModel {
        let mass = DMatrix::from_diagonal(&nalgebra::dvector![5.0, 3.0, 4.0, 2.0]);
        let stiffness = dmatrix![
            6000.0, -3500.0, 0.0, 0.0;
            -3500.0, 5500.0, -2000.0, 0.0;
            0.0, -2000.0, 4000.0, -2000.0;
            0.0, 0.0, -2000.0, 4500.0];
        let damping = DMatrix::zeros(4, 4);
        SpatialModel::new(mass, damping, stiffness).unwrap()
    }

    #[test]
    fn the_lumped_chain_has_its_published_frequencies() {
        let found = lumped_chain().modes().unwrap().frequency_hz();
        for (found, published) in found.iter().zip([2.598, 4.682, 7.770, 8.374]) {
            assert!((found - published).abs() < 6e-4, "{found} {published}");
        }
    }

    #[test]
    fn modes_diagonalise_both_matrices() {
        let chain = lumped_chain();
        let modes = chain.modes().unwrap();
        let unit = modes.shapes.transpose() * &chain.mass * &modes.shapes;
        assert!((unit - DMatrix::identity(4, 4)).amax() < 1e-12);
        let squared = modes.shapes.transpose() * &chain.stiffness * &modes.shapes;
        let expected = DMatrix::from_diagonal(&modes.angular_frequency.map(|omega| omega * omega));
        assert!((squared - expected).amax() < 1e-9);
    }

    #[test]
    fn bad_matrices_are_refused() {
        let unit = DMatrix::<f64>::identity(2, 2);
        let wide = DMatrix::<f64>::zeros(2, 3);
        assert!(matches!(
            SpatialModel::new(unit.clone(), unit.clone(), wide),
            Err(StructureError::Shapes { .. })
        ));
        let massless = SpatialModel::new(DMatrix::zeros(2, 2), unit.clone(), unit.clone()).unwrap();
        assert!(matches!(massless.modes(), Err(StructureError::Mass)));
        let undamped = SpatialModel::new(unit.clone(), DMatrix::zeros(2, 2), unit * 4.0).unwrap();
        let resonance_hz = 2.0 / std::f64::consts::TAU;
        assert!(
            undamped.receptance(resonance_hz).is_err() || {
                undamped.receptance(resonance_hz).unwrap().camax() > 1e12
            }
        );
    }
}
