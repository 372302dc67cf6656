//! Motion of the sides of a joint, and of one as seen from the other.

use crate::number::{Dual, Number};

/// Displacements and their rates at one side of the joint, or of side a relative to side b, of `D` DOFs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motion<const D: usize, N = f64> {
    /// y in m, θ in rad.
    pub displacement: [N; D],
    /// ẏ in m/s, θ̇ in rad/s.
    pub velocity: [N; D],
}

impl<const D: usize, N: Number> Motion<D, N> {
    /// Motion at rest in the origin.
    pub const REST: Self = Self {
        displacement: [N::ZERO; D],
        velocity: [N::ZERO; D],
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

impl<const D: usize> Motion<D> {
    /// The motion with its change along one direction.
    #[must_use]
    pub fn with_change(&self, change: &Self) -> Motion<D, Dual<1>> {
        Motion {
            displacement: changed(&self.displacement, &change.displacement),
            velocity: changed(&self.velocity, &change.velocity),
        }
    }
}

/// Numbers with their changes along one direction.
pub(crate) fn changed<const D: usize>(values: &[f64; D], changes: &[f64; D]) -> [Dual<1>; D] {
    core::array::from_fn(|i| Dual::new(values[i], [changes[i]]))
}
