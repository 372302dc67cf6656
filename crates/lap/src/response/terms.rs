//! The terms of the joint's law beyond stiffness and viscous damping, and what each gives a harmonic motion.

use std::fmt;

use serde::{Deserialize, Serialize};

/// A term that depends on amplitude.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub enum Term {
    /// k3 r³; the paper's kN.
    #[serde(rename = "k3", alias = "kN")]
    Cubic,
    /// k5 r⁵
    #[serde(rename = "k5")]
    Quintic,
    /// k7 r⁷
    #[serde(rename = "k7")]
    Septic,
    /// c2 r² ṙ
    #[serde(rename = "c2")]
    DampingQuadratic,
    /// c4 r⁴ ṙ
    #[serde(rename = "c4")]
    DampingQuartic,
}

impl Term {
    /// All of them.
    pub const ALL: [Self; 5] = [
        Self::Cubic,
        Self::Quintic,
        Self::Septic,
        Self::DampingQuadratic,
        Self::DampingQuartic,
    ];

    /// Its symbol.
    #[must_use]
    pub fn symbol(self) -> &'static str {
        match self {
            Self::Cubic => "k3",
            Self::Quintic => "k5",
            Self::Septic => "k7",
            Self::DampingQuadratic => "c2",
            Self::DampingQuartic => "c4",
        }
    }

    /// Its SI unit.
    #[must_use]
    pub fn unit(self) -> &'static str {
        match self {
            Self::Cubic => "N/m³",
            Self::Quintic => "N/m⁵",
            Self::Septic => "N/m⁷",
            Self::DampingQuadratic => "N·s/m³",
            Self::DampingQuartic => "N·s/m⁵",
        }
    }

    /// Whether it is a damper's.
    #[must_use]
    pub fn is_damping(self) -> bool {
        matches!(self, Self::DampingQuadratic | Self::DampingQuartic)
    }

    /// Power of the amplitude in its equivalent stiffness or damping.
    pub(super) fn power(self) -> i32 {
        match self {
            Self::Cubic | Self::DampingQuadratic => 2,
            Self::Quintic | Self::DampingQuartic => 4,
            Self::Septic => 6,
        }
    }

    /// Its equivalent stiffness or damping over X^power under r = X cos ωt.
    pub(super) fn describing(self) -> f64 {
        // k_eq = k + ¾ k3 X² + ⅝ k5 X⁴ + 35/64 k7 X⁶,  c_eq = c + ¼ c2 X² + ⅛ c4 X⁴: means of 2 cos^(n+1) and of 2 cosⁿ sin²
        match self {
            Self::Cubic => 0.75,
            Self::Quintic => 0.625,
            Self::Septic => 35.0 / 64.0,
            Self::DampingQuadratic => 0.25,
            Self::DampingQuartic => 0.125,
        }
    }
}

/// The terms that a model has, each once.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct TermSet(Vec<Term>);

impl TermSet {
    /// These terms, in their order in [`Term::ALL`].
    #[must_use]
    pub fn of(terms: &[Term]) -> Self {
        let all = Term::ALL.into_iter();
        Self(all.filter(|term| terms.contains(term)).collect())
    }

    /// The terms.
    #[must_use]
    pub fn terms(&self) -> &[Term] {
        &self.0
    }

    /// The models that are compared where a study leaves the choice: springs of growing order, each with dampers of growing order.
    #[must_use]
    pub fn candidates() -> Vec<Self> {
        let springs = [Term::Cubic, Term::Quintic, Term::Septic];
        let dampers = [Term::DampingQuadratic, Term::DampingQuartic];
        let mut candidates = Vec::new();
        for d in 0..=dampers.len() {
            for s in 0..=springs.len() {
                candidates.push(Self::of(&[&springs[..s], &dampers[..d]].concat()));
            }
        }
        candidates
    }
}

impl fmt::Display for TermSet {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.0.is_empty() {
            return f.write_str("linear");
        }
        let symbols: Vec<&str> = self.0.iter().map(|term| term.symbol()).collect();
        f.write_str(&symbols.join(", "))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The describing functions against quadrature over a period.
    #[test]
    fn describing_functions_are_those_of_the_integrals() {
        const SAMPLES: usize = 64;
        for term in Term::ALL {
            let angles = (0..SAMPLES).map(|n| std::f64::consts::TAU * n as f64 / SAMPLES as f64);
            let mean: f64 = angles
                .map(|angle| {
                    let (sine, cosine) = angle.sin_cos();
                    // r = cos, ṙ = −sin: a spring's force on cos, a damper's on −sin.
                    match term.is_damping() {
                        false => 2.0 * cosine.powi(term.power() + 1) * cosine,
                        true => 2.0 * cosine.powi(term.power()) * sine * sine,
                    }
                })
                .sum::<f64>()
                / SAMPLES as f64;
            assert!((mean - term.describing()).abs() < 1e-14, "{term:?}: {mean}");
        }
    }

    #[test]
    fn candidates_are_distinct_and_begin_with_the_linear_model() {
        let candidates = TermSet::candidates();
        assert_eq!(candidates[0].to_string(), "linear");
        assert_eq!(candidates.len(), 12);
        assert!((1..12).all(|n| !candidates[..n].contains(&candidates[n])));
    }
}
