//! Whether the interface moved as a rigid body: what of the channels' motions the virtual point explains, and of the
//! impacts' forces.

use nalgebra::{DMatrix, DVector};
use num_complex::Complex64;

use crate::{Role, VirtualPoint, VirtualPointError};

/// How much of the measured functions is rigid. All is 1 for a rigid interface and sensors without errors.
///
/// One bad channel lowers the coherence of others too; [`VirtualPoint::suspects`] tells which it is.
#[derive(Clone, Debug, PartialEq)]
pub struct Consistency {
    /// ρ = ‖ũ‖/‖u‖ at each line. It may exceed 1 where weights are not equal.
    pub overall: Vec<f64>,
    /// Coherence of ũ_i with u_i for each channel or impact, mean over the lines.
    pub specific: Vec<f64>,
}

impl VirtualPoint {
    /// Consistency of the channels for u = Y·1, all impacts at once; or of the impacts for y = 1ᵀ Y, all channels
    /// added. None for six places alone, which any functions fit.
    ///
    /// ũ = F_u u with F_u = R_u T_u; ỹ = y F_f with F_f = T_f R_fᵀ; coh(a, b) = |a + b|²/(2 (|a|² + |b|²)) (van der
    /// Seijs 2016).
    ///
    /// # Errors
    ///
    /// [`VirtualPointError::TooFew`] lines, [`VirtualPointError::Size`] or [`VirtualPointError::Function`] for
    /// functions that cannot be used.
    pub fn consistency(
        &self,
        role: Role,
        lines: &[DMatrix<Complex64>],
    ) -> Result<Option<Consistency>, VirtualPointError> {
        self.all_checked(lines)?;
        let what = "lines";
        if lines.is_empty() {
            return Err(VirtualPointError::Nothing { what });
        }
        let count = self.count(role);
        if count == self.motion_count() {
            return Ok(None);
        }
        let rigid = self.projection(role).rigid().map(Complex64::from);
        let mut overall = Vec::with_capacity(lines.len());
        let mut specific = vec![0.0; count];
        for line in lines {
            let measured: DVector<Complex64> = match role {
                Role::Channel => line.column_sum(),
                Role::Impact => line.row_sum().transpose(),
            };
            let explained = &rigid * &measured;
            overall.push(ratio(explained.norm(), measured.norm()));
            for (sum, (a, b)) in specific.iter_mut().zip(explained.iter().zip(&measured)) {
                *sum += coherence(*a, *b) / lines.len() as f64;
            }
        }
        Ok(Some(Consistency { overall, specific }))
    }
}

/// |a + b|²/(2 (|a|² + |b|²)); two zeros agree.
fn coherence(a: Complex64, b: Complex64) -> f64 {
    ratio((a + b).norm_sqr(), 2.0 * (a.norm_sqr() + b.norm_sqr()))
}

fn ratio(of: f64, to: f64) -> f64 {
    if to == 0.0 { 1.0 } else { of / to }
}

#[cfg(test)]
mod tests {
    use bolted_joint_testing::{close, near};

    use super::*;
    use crate::samples::*;
    use crate::{SetUp, Weights};

    /// The NumPy program of the check values.
    #[test]
    fn check_values() {
        let point = equal(check_set_up());
        let found = point.consistency(Role::Channel, &[check_functions()]);
        let found = found.unwrap().unwrap();
        close(found.overall[0], 0.999_183_485_0, 1e-10);
        close(found.specific[0], 0.999_197_638_7, 1e-10);
    }

    #[test]
    fn all_is_consistent_on_a_rigid_interface() {
        let set_up = disordered(1);
        let lines: Vec<_> = (0..5)
            .map(|l| set_up.functions(&full_receptance(l)))
            .collect();
        let mut mixed = Mixed(5);
        let weights = [mixed.definite(12), mixed.definite(12)].map(Weights::Full);
        let point = VirtualPoint::new(set_up, &weights[0], &weights[1]).unwrap();
        for role in [Role::Channel, Role::Impact] {
            let found = point.consistency(role, &lines).unwrap().unwrap();
            for number in found.overall.iter().chain(&found.specific) {
                near(*number, 1.0, 1e-9);
            }
        }
    }

    #[test]
    fn six_places_fit_anything() {
        let sensors = triaxials([[1.0; 3]; 3]);
        let set_up = SetUp::new(&sensors, &impacts()[..6]).unwrap();
        let point = equal(set_up);
        let anything = Mixed(1).noise(9, 6);
        let lines = [anything];
        assert_eq!(point.consistency(Role::Impact, &lines), Ok(None));
        assert!(point.consistency(Role::Channel, &lines).unwrap().is_some());
        assert_eq!(coherence(Complex64::ZERO, Complex64::ZERO), 1.0);
        assert_eq!(coherence(Complex64::ONE, -Complex64::ONE), 0.0);
    }
}
