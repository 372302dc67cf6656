//! From a contact model's energy ratios to damping: which loss factor they are, and when the normal part is viscous.

use serde::Deserialize;

/// What a contact model's ratio of the energies D lost in a cycle and W stored is taken for.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum LossFactor {
    /// The loss factor is D/(2πW), as the energies have it: a spring K (1 + jη) of amplitude X dissipates π η K X² a cycle and
    /// stores ½ K X² at most, a ratio of 2π η.
    #[default]
    EnergyRatioOverTwoPi,
    /// It is the loss factor η of K (1 + jη), as Zhao uses it: C_T = η_T K_T.
    EnergyRatio,
}

impl LossFactor {
    /// η of an energy ratio.
    #[must_use]
    pub fn of(self, energy_ratio: f64) -> f64 {
        match self {
            Self::EnergyRatio => energy_ratio,
            Self::EnergyRatioOverTwoPi => energy_ratio / std::f64::consts::TAU,
        }
    }
}

/// How the interface dissipates along its normal.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub enum NormalDamping {
    /// By hysteresis, as along the interface: D_N = η_N K_N at every frequency.
    #[default]
    Hysteretic,
    /// As a dashpot, C_N = η_N √(M K_N) with the mass M of the structure (Zhao).
    Viscous {
        /// M, in kg.
        mass_kg: f64,
    },
}
