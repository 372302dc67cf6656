//! How well the receptance of the virtual point is known: what noise of the functions makes of it, and errors of the
//! set-up.

use std::ops::Add;

use nalgebra::{DMatrix, Matrix6};
use num_complex::Complex64;

use crate::point::sized;
use crate::{Change, Noise, Place, Role, VirtualPoint, VirtualPointError};

/// Covariance of the 36 complex numbers of Y_qm at one line, column by column: entry (k, l) is number k + 6 l.
#[derive(Clone, Debug, PartialEq)]
pub struct Covariance {
    /// E δ δᴴ, 36 × 36.
    pub hermitian: DMatrix<Complex64>,
    /// E δ δᵀ, 36 × 36: zero for noise that is circular. Errors of the set-up are not: they turn and scale the same
    /// functions.
    pub complementary: DMatrix<Complex64>,
}

impl Covariance {
    /// √E|δ|² of each number.
    #[must_use]
    pub fn deviations(&self) -> Matrix6<f64> {
        Matrix6::from_fn(|k, l| self.hermitian[(k + 6 * l, k + 6 * l)].re.max(0.0).sqrt())
    }

    /// Covariance of the real parts and then of the imaginary parts, 72 × 72.
    #[must_use]
    pub fn of_parts(&self) -> DMatrix<f64> {
        DMatrix::from_fn(72, 72, |i, j| {
            let (h, c) = (
                self.hermitian[(i % 36, j % 36)],
                self.complementary[(i % 36, j % 36)],
            );
            // δ = a + jb: E aaᵀ = Re(H + C)/2, E bbᵀ = Re(H − C)/2, E abᵀ = Im(C − H)/2, E baᵀ = Im(C + H)/2
            0.5 * match (i < 36, j < 36) {
                (true, true) => h.re + c.re,
                (false, false) => h.re - c.re,
                (true, false) => c.im - h.im,
                (false, true) => c.im + h.im,
            }
        })
    }
}

impl Add for Covariance {
    type Output = Self;

    /// Of errors that are independent.
    fn add(self, other: Self) -> Self {
        Self {
            hermitian: self.hermitian + other.hermitian,
            complementary: self.complementary + other.complementary,
        }
    }
}

/// Standard deviations of errors of the set-up before anything is known of them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tolerance {
    /// Position along each axis, m
    pub position_m: f64,
    /// Rotation about each axis, rad
    pub rotation_rad: f64,
    /// Gain
    pub gain: f64,
}

impl Tolerance {
    /// With care: 1 mm, 0.01 rad, 0.01.
    pub const TYPICAL: Self = Self {
        position_m: 1e-3,
        rotation_rad: 0.01,
        gain: 0.01,
    };

    /// Standard deviation of one error.
    #[must_use]
    pub fn of(&self, change: Change) -> f64 {
        match change {
            Change::Pose(dof) if dof.is_rotation() => self.rotation_rad,
            Change::Pose(_) => self.position_m,
            Change::Gain(_) => self.gain,
        }
    }

    fn checked(&self) -> Result<(), VirtualPointError> {
        for (what, found) in [
            ("tolerance of positions, m", self.position_m),
            ("tolerance of rotations, rad", self.rotation_rad),
            ("tolerance of gains", self.gain),
        ] {
            if !(found >= 0.0 && found.is_finite()) {
                let expected = "a finite number that is not negative";
                return Err(VirtualPointError::Deviation {
                    what,
                    found,
                    expected,
                });
            }
        }
        Ok(())
    }
}

/// What sensors and impacts are known to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tolerances {
    /// Of each sensor.
    pub sensors: Tolerance,
    /// Of each impact.
    pub impacts: Tolerance,
}

impl Tolerances {
    /// [`Tolerance::TYPICAL`] for both.
    pub const TYPICAL: Self = Self {
        sensors: Tolerance::TYPICAL,
        impacts: Tolerance::TYPICAL,
    };

    /// Standard deviation of an error at a place.
    #[must_use]
    pub fn of(&self, place: Place, change: Change) -> f64 {
        match place {
            Place::Sensor(_) | Place::Channel(_) => self.sensors.of(change),
            Place::Impact(_) => self.impacts.of(change),
        }
    }
}

impl VirtualPoint {
    /// Σ = (T_fᵀ ⊗ T_u) Σ_Y (T_f ⊗ T_uᵀ) of noise; of white noise σ² (T_fᵀ T_f) ⊗ (T_u T_uᵀ).
    ///
    /// # Errors
    ///
    /// [`VirtualPointError::Size`] for noise of other functions, [`VirtualPointError::Deviation`].
    pub fn noise_covariance(&self, noise: &Noise) -> Result<Covariance, VirtualPointError> {
        let (channels, impacts) = (self.count(Role::Channel), self.count(Role::Impact));
        let variances = noise.variances(channels, impacts)?;
        let (t_u, t_f) = (self.motions_of_channels(), self.forces_of_loads());
        // Σ_j t_j t_jᵀ ⊗ T_u S_j T_uᵀ, t_j row j of T_f
        let mut sum = DMatrix::zeros(36, 36);
        for (j, column) in variances.column_iter().enumerate() {
            let motions = t_u * DMatrix::from_diagonal(&column.into_owned()) * t_u.transpose();
            let forces = t_f.row(j);
            sum += (forces.transpose() * forces).kronecker(&motions);
        }
        Ok(Covariance {
            hermitian: sum.map(Complex64::from),
            complementary: DMatrix::zeros(36, 36),
        })
    }

    /// E δ δᴴ = J P Jᴴ and E δ δᵀ = J P Jᵀ of errors of the set-up, to first order; J has [`Self::derivatives`] as
    /// columns. The same errors act at all lines: between lines their covariance is J₁ P J₂ᴴ.
    ///
    /// # Errors
    ///
    /// Those of [`Self::receptance`]; [`VirtualPointError::Deviation`] for tolerances that are negative.
    pub fn set_up_covariance(
        &self,
        functions: &DMatrix<Complex64>,
        tolerances: &Tolerances,
    ) -> Result<Covariance, VirtualPointError> {
        tolerances.sensors.checked()?;
        tolerances.impacts.checked()?;
        let derivatives = self.derivatives(functions)?;
        let parameters = self.set_up().parameters();
        sized("parameters", parameters.len(), derivatives.len())?;
        let deviations: Vec<f64> = parameters
            .iter()
            .map(|parameter| tolerances.of(parameter.place, parameter.change))
            .collect();
        let scaled = DMatrix::from_fn(36, derivatives.len(), |i, p| {
            derivatives[p][(i % 6, i / 6)] * deviations[p]
        });
        Ok(Covariance {
            hermitian: &scaled * scaled.adjoint(),
            complementary: &scaled * scaled.transpose(),
        })
    }
}

#[cfg(test)]
mod tests {
    use bolted_joint_testing::{close, near};

    use super::*;
    use crate::Weights;
    use crate::samples::*;

    /// The whole matrix against draws, in shares of the deviations; 36 variances within 5 %.
    fn agree(covariance: &Covariance, draws: &[Matrix6<Complex64>]) {
        let count = Complex64::from(draws.len() as f64);
        let mut hermitian = DMatrix::<Complex64>::zeros(36, 36);
        let mut complementary = DMatrix::<Complex64>::zeros(36, 36);
        for draw in draws {
            let column = DMatrix::from_column_slice(36, 1, draw.as_slice());
            hermitian += &column * column.adjoint() / count;
            complementary += &column * column.transpose() / count;
        }
        let deviations = covariance.deviations();
        for i in 0..36 {
            let expected = deviations[i].powi(2);
            close(hermitian[(i, i)].re, expected, 0.05);
            for j in 0..36 {
                let scale = deviations[i] * deviations[j];
                let error = (hermitian[(i, j)] - covariance.hermitian[(i, j)]).norm();
                near(error / scale, 0.0, 0.06);
                let error = (complementary[(i, j)] - covariance.complementary[(i, j)]).norm();
                near(error / scale, 0.0, 0.06);
            }
        }
    }

    #[test]
    fn noise_of_each_function_spreads_the_receptance_as_draws_do() {
        let mut mixed = Mixed(3_000_000);
        let weights = [mixed.definite(9), mixed.definite(7)].map(Weights::Full);
        let point = VirtualPoint::new(check_set_up(), &weights[0], &weights[1]).unwrap();
        let each = DMatrix::from_fn(9, 7, |_, _| 1.0 + 0.9 * mixed.next());
        let draws: Vec<_> = (0..10_000)
            .map(|_| mixed.noise(9, 7).component_mul(&each.map(Complex64::from)))
            .map(|noise| point.receptance(&noise).unwrap())
            .collect();
        agree(&point.noise_covariance(&Noise::Each(each)).unwrap(), &draws);
    }

    /// var Y_kl = σ² (T_u T_uᵀ)_kk (T_fᵀ T_f)_ll
    #[test]
    fn white_noise_has_the_short_formula() {
        let point = equal(check_set_up());
        let deviations = point
            .noise_covariance(&Noise::White(0.3))
            .unwrap()
            .deviations();
        let (t_u, t_f) = (point.motions_of_channels(), point.forces_of_loads());
        for k in 0..6 {
            for l in 0..6 {
                let expected = 0.3 * t_u.row(k).norm() * t_f.column(l).norm();
                close(deviations[(k, l)], expected, 1e-12);
            }
        }
    }

    /// Functions of a set-up that is displaced at random, transformed as if it were not.
    #[test]
    fn errors_of_the_set_up_spread_the_receptance_as_draws_do() {
        let set_up = check_set_up();
        let receptance = full_receptance(8);
        let point = equal(set_up.clone());
        // a tenth of the typical ones, so that what is of second order stays below 5 %
        let tolerance = Tolerance {
            position_m: 1e-4,
            rotation_rad: 1e-3,
            gain: 1e-3,
        };
        let tolerances = Tolerances {
            sensors: tolerance,
            impacts: tolerance,
        };
        let functions = set_up.functions(&receptance);
        let covariance = point.set_up_covariance(&functions, &tolerances).unwrap();
        let parameters = set_up.parameters();
        let mut mixed = Mixed(6_000_000);
        let draws: Vec<_> = (0..10_000)
            .map(|_| {
                let errors: Vec<_> = parameters
                    .iter()
                    .map(|p| {
                        let normal = mixed.normal().re * std::f64::consts::SQRT_2;
                        normal * tolerances.of(p.place, p.change)
                    })
                    .collect();
                let measured = set_up.displaced(&errors).unwrap().functions(&receptance);
                point.receptance(&measured).unwrap() - receptance
            })
            .collect();
        agree(&covariance, &draws);
        let typical = point
            .set_up_covariance(&functions, &Tolerances::TYPICAL)
            .unwrap();
        let tenfold = typical.deviations() - covariance.deviations() * 10.0;
        assert!(tenfold.norm() < 1e-12 * typical.deviations().norm());
    }

    #[test]
    fn parts_add_up() {
        let point = equal(check_set_up());
        let set_up = point
            .set_up_covariance(&check_functions(), &Tolerances::TYPICAL)
            .unwrap();
        let noise = point.noise_covariance(&Noise::White(1e-8)).unwrap();
        let both = set_up + noise;
        let parts = both.of_parts();
        assert!((&parts - parts.transpose()).norm() < 1e-14 * parts.norm());
        let deviations = both.deviations();
        for i in 0..36 {
            close(
                parts[(i, i)] + parts[(i + 36, i + 36)],
                deviations[i].powi(2),
                1e-12,
            );
            // E ab of one number is half the imaginary part of E δ²
            let crossed = parts[(i, i + 36)];
            near(
                crossed,
                both.complementary[(i, i)].im / 2.0,
                1e-14 * deviations[i].powi(2),
            );
        }
    }

    #[test]
    fn what_is_no_tolerance_is_refused() {
        let point = equal(check_set_up());
        for wrong in [-1.0, f64::NAN] {
            let mut tolerances = Tolerances::TYPICAL;
            tolerances.impacts.gain = wrong;
            let found = point.set_up_covariance(&check_functions(), &tolerances);
            let error = found.unwrap_err();
            assert!(
                error.to_string().starts_with("tolerance of gains: found "),
                "{error}"
            );
        }
    }
}
