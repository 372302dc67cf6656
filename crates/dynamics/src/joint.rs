//! The massless joint between two structures: linear stiffness and viscous damping, a cubic spring on each relative DOF,
//! and terms of higher order where the joint has them.

use crate::{
    higher::HigherTerms,
    vector::{dot, product},
};

/// Displacements and their rates at one side of the joint, or of side a relative to side b.
///
/// `D` is 1 (translation y) or 2 (translation y, rotation θ).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motion<const D: usize> {
    /// y in m, θ in rad.
    pub displacement: [f64; D],
    /// ẏ in m/s, θ̇ in rad/s.
    pub velocity: [f64; D],
}

impl<const D: usize> Motion<D> {
    /// Motion at rest in the origin.
    pub const REST: Self = Self {
        displacement: [0.0; D],
        velocity: [0.0; D],
    };

    /// Motion of `self` as seen from `other`: x_a − x_b, ẋ_a − ẋ_b.
    #[inline]
    #[must_use]
    pub fn relative_to(&self, other: &Self) -> Self {
        Self {
            displacement: core::array::from_fn(|i| self.displacement[i] - other.displacement[i]),
            velocity: core::array::from_fn(|i| self.velocity[i] - other.velocity[i]),
        }
    }
}

/// Load law of the joint: `K r + C ṙ + k3 ∘ r³`, and [`HigherTerms`], with the relative motion `r = x_a − x_b`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JointLaw<const D: usize> {
    /// Symmetric K: N/m, N/rad, N·m/m, N·m/rad.
    pub stiffness: [[f64; D]; D],
    /// Symmetric C: N·s/m, N·s/rad, N·m·s/m, N·m·s/rad.
    pub damping: [[f64; D]; D],
    /// k3 on each relative DOF: N/m³, N·m/rad³. Positive hardens, negative softens.
    pub cubic: [f64; D],
    /// Terms of higher order on each relative DOF.
    pub higher: HigherTerms<D>,
}

impl<const D: usize> JointLaw<D> {
    /// Nothing between the sides.
    pub const NONE: Self = Self {
        stiffness: [[0.0; D]; D],
        damping: [[0.0; D]; D],
        cubic: [0.0; D],
        higher: HigherTerms::NONE,
    };

    /// Load on side b (N, N·m) at the relative motion x_a − x_b; the load on side a is its opposite.
    #[inline]
    #[must_use]
    pub fn load_on_b(&self, relative: &Motion<D>) -> [f64; D] {
        // F_b = K r + C ṙ + k3 ∘ r³   (Pirdayr's equations of motion; Tol 3.8 where k3 = 0)
        let elastic = product(&self.stiffness, &relative.displacement);
        let viscous = product(&self.damping, &relative.velocity);
        let cubic = core::array::from_fn(|i| {
            let r = relative.displacement[i];
            elastic[i] + viscous[i] + self.cubic[i] * r * r * r
        });
        if self.higher.are_none() {
            return cubic;
        }
        core::array::from_fn(|i| {
            let (r, velocity) = (relative.displacement[i], relative.velocity[i]);
            cubic[i] + self.higher.load(i, r, velocity)
        })
    }

    /// Energy stored in the joint's springs (J) at the relative displacement r.
    #[inline]
    #[must_use]
    pub fn stored_energy(&self, relative_displacement: &[f64; D]) -> f64 {
        // U = ½ rᵀ K r + ¼ Σ k3ᵢ rᵢ⁴ + ⅙ Σ k5ᵢ rᵢ⁶ + ⅛ Σ k7ᵢ rᵢ⁸
        let r = relative_displacement;
        let mut quartic = 0.0;
        for i in 0..D {
            let squared = r[i] * r[i];
            quartic += self.cubic[i] * squared * squared;
        }
        let energy = 0.5 * dot(r, &product(&self.stiffness, r)) + 0.25 * quartic;
        if self.higher.are_none() {
            return energy;
        }
        (0..D).fold(energy, |sum, i| sum + self.higher.stored_energy(i, r[i]))
    }

    /// Power that the joint's dampers turn into heat (W) at the relative motion.
    #[inline]
    #[must_use]
    pub fn dissipated_power(&self, relative: &Motion<D>) -> f64 {
        // P = ṙᵀ C ṙ + Σ (c2ᵢ rᵢ² + c4ᵢ rᵢ⁴) ṙᵢ²
        let velocity = &relative.velocity;
        let power = dot(velocity, &product(&self.damping, velocity));
        if self.higher.are_none() {
            return power;
        }
        (0..D).fold(power, |sum, i| {
            sum + self.higher.damping(i, relative.displacement[i]) * velocity[i] * velocity[i]
        })
    }
}
