//! Modes of the lap without dampers and without what is not linear: where searches for resonances start.

use nalgebra::{DMatrix, SymmetricEigen};

use super::balance::HarmonicBalance;
use super::condensed::Circumstances;
use super::solution::not_found;
use super::system::Regime;
use super::{HarmonicError, HarmonicLoads, Observed, Side, Solution, Target};

/// Frequencies below this part of the highest are rigid motions.
const RIGID: f64 = 1e-6;

/// A mode of the undamped linear lap.
#[derive(Clone, Debug, PartialEq)]
pub struct LinearMode<const D: usize> {
    /// Natural angular frequency, rad/s; 0 for a rigid motion.
    pub omega_rad_s: f64,
    /// Shape of body a, mass normalised: 1/√kg, 1/√(kg·m²).
    pub a: [f64; D],
    /// Shape of body b.
    pub b: [f64; D],
}

impl<const D: usize> LinearMode<D> {
    /// What a sensor sees of the shape.
    #[must_use]
    pub fn seen(&self, observed: Observed) -> f64 {
        match observed {
            Observed::Relative(dof) => self.a[dof] - self.b[dof],
            Observed::Body(Side::A, dof) => self.a[dof],
            Observed::Body(Side::B, dof) => self.b[dof],
        }
    }
}

impl<const D: usize> HarmonicBalance<D> {
    /// The modes of the undamped linear lap, by frequency.
    #[must_use]
    pub fn linear_modes(&self) -> Vec<LinearMode<D>> {
        let bodies = [&self.lap.a, &self.lap.b];
        // M⁻½ K M⁻½
        let matrix = DMatrix::from_fn(2 * D, 2 * D, |row, column| {
            let (of_row, of_column) = (bodies[row / D], bodies[column / D]);
            let (i, j) = (row % D, column % D);
            let stiffness = &self.lap.joint.linear.stiffness;
            let joint = 0.5 * (stiffness[i][j] + stiffness[j][i]);
            let mut entry = if row / D == column / D { joint } else { -joint };
            if row == column {
                entry += of_row.stiffness[i];
            }
            entry / (of_row.inertia[i] * of_column.inertia[j]).sqrt()
        });
        let eigen = SymmetricEigen::new(matrix);
        let highest = eigen.eigenvalues.amax();
        let mut modes: Vec<LinearMode<D>> = (0..2 * D)
            .map(|n| {
                let squared = eigen.eigenvalues[n];
                let is_rigid = squared <= RIGID * RIGID * highest;
                let of = |body: usize| {
                    std::array::from_fn(|i| {
                        eigen.eigenvectors[(body * D + i, n)] / bodies[body].inertia[i].sqrt()
                    })
                };
                LinearMode {
                    omega_rad_s: if is_rigid { 0.0 } else { squared.sqrt() },
                    a: of(0),
                    b: of(1),
                }
            })
            .collect();
        modes.sort_by(|one, other| one.omega_rad_s.total_cmp(&other.omega_rad_s));
        modes
    }

    /// The vibrating mode in which the joint opens most in the DOF of a motion.
    fn mode_of(&self, observed: Observed) -> Option<LinearMode<D>> {
        let opening = |mode: &LinearMode<D>| mode.seen(Observed::Relative(observed.dof())).abs();
        let modes = self.linear_modes().into_iter();
        modes
            .filter(|mode| mode.omega_rad_s > 0.0)
            .max_by(|one, other| opening(one).total_cmp(&opening(other)))
    }

    /// Natural frequency of that mode, rad/s.
    pub(super) fn natural_omega(&self, observed: Observed) -> Result<f64, HarmonicError> {
        let mode = self.mode_of(observed).ok_or_else(|| not_found(0.0, 0))?;
        Ok(mode.omega_rad_s)
    }

    /// That mode with an amplitude, as a start.
    pub(super) fn linear_mode(&self, target: &Target) -> Result<Solution<D>, HarmonicError> {
        let mode = self.mode_of(target.observed);
        let mode = mode.ok_or_else(|| not_found(0.0, 0))?;
        let omega = mode.omega_rad_s;
        let amplitude = target.amplitude / omega.powi(target.derivative.order());
        let factor = amplitude / mode.seen(target.observed);
        if !factor.is_finite() {
            return Err(not_found(omega, 0));
        }
        let slots = self.harmonics.slots();
        let mut coefficients = vec![0.0; self.size()];
        for dof in 0..D {
            let place = dof * slots + self.harmonics.fundamental();
            coefficients[place] = factor * mode.seen(Observed::Relative(dof));
        }
        Ok(Solution {
            loads: HarmonicLoads::NONE,
            regime: Regime::Free(target.observed),
            at: Circumstances {
                omega,
                load_factor: 0.0,
                released: 0.0,
            },
            coefficients,
        })
    }
}
