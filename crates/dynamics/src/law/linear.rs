//! The linear joint: stiffness and viscous damping, with what couples one DOF to another (Tol 3.8).

use super::declaration::{ActsOn, Declaration, Parameter, Quantity, Range, Span, UnitRule};
use crate::{
    motion::Motion,
    number::Number,
    vector::{dot, product},
};

/// What the linear law says of itself.
pub(super) const DECLARATION: Declaration = Declaration {
    name: "linear",
    summary: "Stiffness and viscous damping, coupled between the DOFs",
    parameters: &[
        Parameter {
            symbol: "k",
            key: "stiffness",
            span: Span::Matrix(
                "Stiffness of the joint: {load} per relative {other_motion}, and {other_load} per relative {motion}",
            ),
            unit: UnitRule::LoadPer {
                displacement: 1,
                seconds: 0,
            },
            range: Range::Any,
            quantity: Quantity {
                name: "Stiffness",
                nominal: [1e6, 1e4, 1e3],
                start: [5.73e5, 5.82e3, 1.29e3],
            },
            description: "Stiffness of the joint: {load} per relative {motion}",
            acts_on: ActsOn::SPRING,
            grows_with_preload: false,
        },
        Parameter {
            symbol: "c",
            key: "damping",
            span: Span::Matrix(
                "Damping of the joint: {load} per relative {other_rate}, and {other_load} per relative {rate}",
            ),
            unit: UnitRule::LoadPer {
                displacement: 1,
                seconds: 1,
            },
            range: Range::Any,
            quantity: Quantity {
                name: "Damping",
                nominal: [10.0, 1.0, 0.1],
                start: [10.83, -0.83, 0.083],
            },
            description: "Damping of the joint: {load} per relative {rate}",
            acts_on: ActsOn::DAMPER,
            grows_with_preload: false,
        },
    ],
    memory: &[],
    hidden_memory: 0,
    at_most: 1,
    number: 1,
};

/// What it says of the stiffness.
pub const STIFFNESS: &Parameter = &DECLARATION.parameters[0];

/// What it says of the damping.
pub const DAMPING: &Parameter = &DECLARATION.parameters[1];

/// Stiffness and damping matrices of a joint with `D` DOFs a side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Linear<const D: usize, N = f64> {
    /// Symmetric K: N/m, N/rad, N·m/m, N·m/rad.
    pub stiffness: [[N; D]; D],
    /// Symmetric C: N·s/m, N·s/rad, N·m·s/m, N·m·s/rad.
    pub damping: [[N; D]; D],
}

impl<const D: usize, N: Number> Linear<D, N> {
    /// Nothing between the sides.
    pub const NONE: Self = Self {
        stiffness: [[N::ZERO; D]; D],
        damping: [[N::ZERO; D]; D],
    };

    /// Load on side b (N, N·m) at the relative motion x_a − x_b.
    #[inline]
    #[must_use]
    pub fn load(&self, relative: &Motion<D, N>) -> [N; D] {
        // K r + C ṙ   (Tol 3.8)
        let elastic = product(&self.stiffness, &relative.displacement);
        let viscous = product(&self.damping, &relative.velocity);
        std::array::from_fn(|i| elastic[i] + viscous[i])
    }

    /// Energy stored in the springs (J) at the relative displacement r.
    #[inline]
    #[must_use]
    pub fn stored_energy(&self, r: &[N; D]) -> N {
        // U = ½ rᵀ K r
        N::from(0.5) * dot(r, &product(&self.stiffness, r))
    }

    /// Power that the dampers turn into heat (W) at the relative velocity ṙ.
    #[inline]
    #[must_use]
    pub fn dissipated_power(&self, velocity: &[N; D]) -> N {
        // P = ṙᵀ C ṙ
        dot(velocity, &product(&self.damping, velocity))
    }
}
