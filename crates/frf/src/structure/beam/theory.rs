//! What a beam's theory takes into account beside bending.

use serde::{Deserialize, Serialize};

/// κ of a rectangle: the one whose shear energy Q²/(2κGA) is that of the parabolic shear stress. It does not depend on ν.
/// (Cowper 1966 has κ = 10(1 + ν)/(12 + 11ν): 0.833 for ν = 0, 0.850 for ν = 0.3, which is 2 % less deflection by shear.)
pub(in crate::structure) const SHEAR_COEFFICIENT: f64 = 5.0 / 6.0;

/// Which deformation and inertia of the cross-section count.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum Theory {
    /// Bending alone: cross-sections have no rotary inertia and stay normal to the axis.
    EulerBernoulli,
    /// Shear and rotary inertia too.
    Timoshenko {
        /// ν, from which the shear modulus follows: G = E/(2(1 + ν)).
        poissons_ratio: f64,
    },
}

impl Theory {
    /// ν of steel, and near that of most metals (aluminium 0.33, cast iron 0.26). Shear adds a small part to the
    /// deflection, and 0.03 of ν change this part by 2 %.
    pub const USUAL_POISSONS_RATIO: f64 = 0.3;

    /// E/κG; zero where shear does not count.
    pub(super) fn moduli_ratio(self) -> f64 {
        match self {
            Self::EulerBernoulli => 0.0,
            Self::Timoshenko { poissons_ratio } => 2.0 * (1.0 + poissons_ratio) / SHEAR_COEFFICIENT,
        }
    }

    /// Part of ρI that counts.
    pub(super) fn rotary_inertia(self) -> f64 {
        match self {
            Self::EulerBernoulli => 0.0,
            Self::Timoshenko { .. } => 1.0,
        }
    }
}

/// Timoshenko's, with the ν of most metals.
impl Default for Theory {
    fn default() -> Self {
        Self::Timoshenko {
            poissons_ratio: Self::USUAL_POISSONS_RATIO,
        }
    }
}
