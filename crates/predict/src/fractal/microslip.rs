//! Energy that a tangentially loaded contact loses by microslip at its rim, over what it stores (Mindlin).

use crate::ContactError;
use serde::Deserialize;

/// What the energy lost in a cycle is compared with.
///
/// A contact that is loaded once to T = qμP takes up W, and a cycle between −T and T costs W_d; Mindlin's theory gives both, and
/// the loss factor is W_d/(mW − W_d).
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum StoredEnergy {
    /// m = 1: the energy of one loading. η_T = 1/((5/24) H₂/H₁ − 1), which is 4q/9 for small q and infinite at q = 0.9583.
    #[default]
    OneLoading,
    /// m = π, as in Zhao's (26) and (29): η_T = 1/((5π/24) H₂/H₁ − 1), which is 4q/(9π) for small q and 0.74 at q = 1.
    PiLoadings,
}

impl StoredEnergy {
    /// W_d/W of the loss factor's pole: m times 5/24, the other constants of H₁ and H₂ taken together.
    fn pole(self) -> f64 {
        match self {
            Self::OneLoading => 5.0 / 24.0,
            Self::PiLoadings => 5.0 * std::f64::consts::PI / 24.0,
        }
    }

    /// The ratio q = T/(μP) that a prediction must stay below: where the loss factor is infinite, or the whole contact slips.
    ///
    /// With c = (1 − q)^(1/3), H₁/H₂ = 5/24 is 6c³ + 12c² − 2c − 1 = 0, and q = 0.958 286 080 744 870…
    #[must_use]
    pub fn largest_friction_ratio(self) -> f64 {
        match self {
            Self::OneLoading => 0.958_286_080_744_87,
            Self::PiLoadings => 1.0,
        }
    }

    /// Loss factor η_T of the tangential direction at the friction ratio q = T/(μP).
    ///
    /// # Errors
    /// q is negative, or not below [`StoredEnergy::largest_friction_ratio`].
    pub fn loss_factor(self, friction_ratio: f64) -> Result<f64, ContactError> {
        self.check(friction_ratio)?;
        Ok(self.loss_of((1.0 - friction_ratio).cbrt(), friction_ratio))
    }

    pub(super) fn check(self, friction_ratio: f64) -> Result<(), ContactError> {
        let limit = self.largest_friction_ratio();
        if friction_ratio >= 0.0 && friction_ratio < limit {
            Ok(())
        } else {
            Err(ContactError::FrictionRatio {
                found: friction_ratio,
                limit,
            })
        }
    }

    /// The same with c = (1 − q)^(1/3) at hand, q inside the range.
    pub(super) fn loss_of(self, c: f64, friction_ratio: f64) -> f64 {
        // 1 − c = q/(1 + c + c²)
        let slip = friction_ratio / (1.0 + c + c * c);
        // H₁ = 1 − (1−q)^(5/3) − (5q/6)(1 + (1−q)^(2/3)) = (1 − c)³ (1 + 3c + c²)/6
        // H₂ = 3/5 + (2/5)(1−q)^(5/3) − (1−q)^(2/3)      = (1 − c)² (3 + 6c + 4c² + 2c³)/5
        // The factors hold what cancels at small q.
        let ratio =
            (5.0 / 6.0) * slip * (1.0 + c * (3.0 + c)) / (3.0 + c * (6.0 + c * (4.0 + 2.0 * c)));
        // η_T = 1/((5/24) H₂/H₁ − 1)
        ratio / (self.pole() - ratio)
    }
}
