//! Derivatives by the rotation vectors of errors, where those of displaced places are by further turns.
//!
//! Without it a search for errors of the set-up crawls: what weakly determined errors may do depends on how exactly the
//! others follow.

use bolted_joint_space::Dof;
use nalgebra::{DMatrix, Matrix3, Vector3};

use crate::point::sized;
use crate::{Change, Places, VirtualPointError};

/// Angles below this, rad, take the series: their differences would be lost.
const SMALL: f64 = 1e-3;

impl Places {
    /// Of derivatives by further changes at places that were displaced by `errors`, those by the errors themselves:
    /// exp(φ + dφ) = exp(J dφ) exp(φ) with J = I + (1 − cos θ)/θ² \[φ\]× + (θ − sin θ)/θ³ \[φ\]×², θ = |φ| (the left
    /// Jacobian of rotations). They are in the order of [`Self::parameters`], whatever is derived.
    ///
    /// # Errors
    ///
    /// [`VirtualPointError::Size`] unless there is a derivative and an error for each parameter.
    pub fn by_rotation_vectors(
        &self,
        derivatives: &mut [DMatrix<f64>],
        errors: &[f64],
    ) -> Result<(), VirtualPointError> {
        let parameters = self.parameters();
        sized(
            "derivatives by errors of the set-up",
            derivatives.len(),
            parameters.len(),
        )?;
        sized("errors of the set-up", errors.len(), parameters.len())?;
        for (first, parameter) in parameters.iter().enumerate() {
            if parameter.change != Change::Pose(Dof::Rx) {
                continue;
            }
            let own = first..first + 3;
            let jacobian = jacobian(&Vector3::from_row_slice(&errors[own.clone()]));
            let by_turns: [DMatrix<f64>; 3] =
                std::array::from_fn(|n| derivatives[first + n].clone());
            for (k, derivative) in derivatives[own].iter_mut().enumerate() {
                *derivative = (0..3).fold(&by_turns[0] * 0.0, |sum, m| {
                    sum + &by_turns[m] * jacobian[(m, k)]
                });
            }
        }
        Ok(())
    }
}

/// J of a rotation vector.
fn jacobian(vector: &Vector3<f64>) -> Matrix3<f64> {
    let cross = vector.cross_matrix();
    let angle = vector.norm();
    let square = angle * angle;
    let [of_one, of_two] = if angle < SMALL {
        [0.5 - square / 24.0, 1.0 / 6.0 - square / 120.0]
    } else {
        [
            (1.0 - angle.cos()) / square,
            (angle - angle.sin()) / (square * angle),
        ]
    };
    Matrix3::identity() + of_one * cross + of_two * cross * cross
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::samples::disordered;

    /// Central differences of displaced places, with turns of any size.
    #[test]
    fn derivatives_by_rotation_vectors_are_differences() {
        let set_up = disordered(3);
        let places = set_up.channels();
        let count = places.parameters().len();
        for size in [1e-4, 0.3] {
            let errors: Vec<f64> = (0..count).map(|n| size * (n as f64).sin()).collect();
            let displaced = places.displaced(&errors).unwrap();
            let mut derivatives = displaced.derivatives();
            displaced
                .by_rotation_vectors(&mut derivatives, &errors)
                .unwrap();
            let step = 1e-6;
            for (n, derivative) in derivatives.iter().enumerate() {
                let [up, down] = [step, -step].map(|step| {
                    let mut moved = errors.clone();
                    moved[n] += step;
                    places.displaced(&moved).unwrap().matrix().clone()
                });
                let difference = (up - down) / (2.0 * step);
                let error = (difference - derivative).norm();
                // a gain multiplies what was turned
                assert!(error < 1e-8, "{size} {n}: {error:e}");
            }
        }
    }

    #[test]
    fn there_is_an_error_for_each_parameter() {
        let set_up = disordered(3);
        let places = set_up.channels();
        let mut derivatives = places.derivatives();
        let refused = places.by_rotation_vectors(&mut derivatives, &[0.0]);
        assert!(matches!(
            refused,
            Err(VirtualPointError::Size { found: 1, .. })
        ));
    }
}
