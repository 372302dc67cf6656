//! Stiffness, damping and inertia of one joint together, since they move and turn together.

use nalgebra::{Matrix6, Vector3};
use num_complex::Complex64;

use crate::{Axes, rotated, transported};

/// A joint's matrices at one point, for relative motions r = q_a − q_b: the joint loads a with −D r and b with +D r.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JointMatrices {
    /// K
    pub stiffness: Matrix6<f64>,
    /// C
    pub damping: Matrix6<f64>,
    /// M of the relative acceleration; masses that sit on one side are no part of it, see [`lumped`](crate::lumped).
    pub inertia: Matrix6<f64>,
}

impl JointMatrices {
    /// A joint without inertia.
    #[must_use]
    pub fn massless(stiffness: Matrix6<f64>, damping: Matrix6<f64>) -> Self {
        Self {
            stiffness,
            damping,
            inertia: Matrix6::zeros(),
        }
    }

    /// D(ω), by e^{+jωt}.
    #[must_use]
    pub fn dynamic(&self, omega_rad_per_s: f64) -> Matrix6<Complex64> {
        // D = K + jωC − ω²M
        self.stiffness
            .zip_zip_map(&self.damping, &self.inertia, |k, c, m| {
                Complex64::new(
                    k - omega_rad_per_s * omega_rad_per_s * m,
                    omega_rad_per_s * c,
                )
            })
    }

    /// The same joint told at a point `offset_m` away.
    #[must_use]
    pub fn transported(&self, offset_m: &Vector3<f64>) -> Self {
        self.each(|matrix| transported(matrix, offset_m))
    }

    /// The same joint told in other axes.
    #[must_use]
    pub fn rotated(&self, axes: &Axes) -> Self {
        self.each(|matrix| rotated(matrix, axes))
    }

    fn each(&self, told: impl Fn(&Matrix6<f64>) -> Matrix6<f64>) -> Self {
        Self {
            stiffness: told(&self.stiffness),
            damping: told(&self.damping),
            inertia: told(&self.inertia),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::samples::definite;

    /// Whether first moved and then weighed, or the other way round.
    #[test]
    fn dynamic_stiffness_moves_as_its_parts_do() {
        let [stiffness, damping, inertia] =
            [(1, 1.0), (2, 1e-4), (3, 1e-9)].map(|(seed, s)| definite(seed) * s);
        let joint = JointMatrices {
            stiffness,
            damping,
            inertia,
        };
        let (omega, offset) = (900.0, Vector3::new(0.1, 0.2, -0.05));
        let axes = Axes::with_z_along(&Vector3::new(1.0, 2.0, 3.0)).unwrap();
        let expected = rotated(&transported(&joint.dynamic(omega), &offset), &axes);
        let found = joint.transported(&offset).rotated(&axes).dynamic(omega);
        let size = expected.map(|d| d.norm()).max();
        assert!((found - expected).map(|d| d.norm()).max() < 1e-14 * size);
        let entry = joint.dynamic(omega)[(1, 4)];
        let [k, c, m] = [stiffness, damping, inertia].map(|matrix| matrix[(1, 4)]);
        assert_eq!(entry, Complex64::new(k - omega * omega * m, omega * c));
        assert_eq!(
            JointMatrices::massless(stiffness, damping).inertia,
            Matrix6::zeros()
        );
    }
}
