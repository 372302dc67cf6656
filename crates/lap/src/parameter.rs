//! The parameters of the symmetric lap model, by the names of the paper.

use std::fmt;

use serde::Serialize;

/// A parameter of the symmetric lap model.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
pub enum LapParameter {
    /// k, stiffness of each body's support, N/m.
    #[serde(rename = "k")]
    SupportStiffness,
    /// m, mass of each body, kg.
    #[serde(rename = "m")]
    Mass,
    /// k12, stiffness of the joint, N/m.
    #[serde(rename = "k12")]
    JointStiffness,
    /// c, damping of each body's support, N·s/m.
    #[serde(rename = "c")]
    SupportDamping,
    /// c12, damping of the joint, N·s/m.
    #[serde(rename = "c12")]
    JointDamping,
    /// kN, cubic stiffness of the joint, N/m³.
    #[serde(rename = "kN")]
    JointCubic,
}

impl LapParameter {
    /// All of them, those that natural frequencies depend on first.
    pub const ALL: [Self; 6] = [
        Self::SupportStiffness,
        Self::Mass,
        Self::JointStiffness,
        Self::SupportDamping,
        Self::JointDamping,
        Self::JointCubic,
    ];

    /// Name in the paper and in a study.
    #[must_use]
    pub fn symbol(self) -> &'static str {
        match self {
            Self::SupportStiffness => "k",
            Self::Mass => "m",
            Self::JointStiffness => "k12",
            Self::SupportDamping => "c",
            Self::JointDamping => "c12",
            Self::JointCubic => "kN",
        }
    }

    /// Its SI unit.
    #[must_use]
    pub fn unit(self) -> &'static str {
        match self {
            Self::SupportStiffness | Self::JointStiffness => "N/m",
            Self::Mass => "kg",
            Self::SupportDamping | Self::JointDamping => "N·s/m",
            Self::JointCubic => "N/m³",
        }
    }

    /// Whether the natural frequencies of the linear model depend on it.
    #[must_use]
    pub fn moves_frequencies(self) -> bool {
        matches!(
            self,
            Self::SupportStiffness | Self::Mass | Self::JointStiffness
        )
    }

    pub(super) fn index(self) -> usize {
        self as usize
    }
}

impl fmt::Display for LapParameter {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.symbol())
    }
}

/// A value of each parameter, in the order of [`LapParameter::ALL`] and in their units.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct LapParameters(pub [f64; 6]);

impl LapParameters {
    /// The value of one parameter.
    #[must_use]
    pub fn of(&self, parameter: LapParameter) -> f64 {
        self.0[parameter.index()]
    }

    /// The undamped natural frequencies of the linear model, rad/s: the bodies in phase, then against each other.
    #[must_use]
    pub fn natural_frequencies(&self) -> [f64; 2] {
        let [k, m, k12, ..] = self.0;
        // ω₁ = √(k/m), ω₂ = √((k + 2 k₁₂)/m)
        [(k / m).sqrt(), ((k + 2.0 * k12) / m).sqrt()]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parameters_stand_at_their_own_places() {
        for (place, parameter) in LapParameter::ALL.into_iter().enumerate() {
            assert_eq!(parameter.index(), place);
            let values = LapParameters([0.0, 1.0, 2.0, 3.0, 4.0, 5.0]);
            assert_eq!(values.of(parameter), place as f64);
        }
    }
}
