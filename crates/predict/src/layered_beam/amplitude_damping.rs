//! Damping over the amplitude by the terms that a joint file has: c + c2 r² + c4 r⁴ in place of dry friction.

use bolted_joint_dynamics::Polynomial;

use super::error::{LayeredBeamError, value};

/// Amplitudes of a relative motion, m, from a smaller to a larger one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AmplitudeRange {
    /// Smallest, m.
    from_m: f64,
    /// Largest, m.
    to_m: f64,
}

impl AmplitudeRange {
    /// A range of amplitudes, m.
    ///
    /// # Errors
    /// They are not positive, or the second is not larger than the first.
    pub fn new(key: &'static str, from_m: f64, to_m: f64) -> Result<Self, LayeredBeamError> {
        if from_m > 0.0 && to_m > from_m && to_m.is_finite() {
            Ok(Self { from_m, to_m })
        } else {
            let expected = "positive amplitudes from a smaller to a larger one";
            Err(value(key, format_args!("{from_m} to {to_m} m"), expected))
        }
    }

    /// Smallest amplitude, m.
    #[must_use]
    pub fn from_m(&self) -> f64 {
        self.from_m
    }

    /// Largest amplitude, m.
    #[must_use]
    pub fn to_m(&self) -> f64 {
        self.to_m
    }
}

/// Passive damping c(r) = c + c2 r² + c4 r⁴ whose loss over a period follows that of dry friction in a range of amplitudes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AmplitudeDamping {
    /// c, N·s/m.
    pub constant_n_s_per_m: f64,
    /// c2, N·s/m³.
    pub quadratic_n_s_per_m3: f64,
    /// c4, N·s/m⁵.
    pub quartic_n_s_per_m5: f64,
    /// Largest |loss/loss by friction − 1| in the range; reached at both of its ends.
    pub worst_error: f64,
}

impl AmplitudeDamping {
    /// The best such damping for the viscous equivalent `coulomb`/R of dry friction at amplitude R; `coulomb` in N·s.
    ///
    /// A sinusoidal motion of amplitude R sees c_eq = c + c2 R²/4 + c4 R⁴/8. Damping that is nowhere negative has c + c2 s + c4 s²
    /// in the cone of a (s − s₀)² and b s, s = r². On (s − s₀)² the error R c_eq/coulomb grows all through the range, so the best
    /// member of the family has errors of opposite sign at the ends, and is the one whose c_eq falls most from end to end; nothing
    /// else in the cone falls more. Without the condition the fit could be closer, but the joint would give energy within each
    /// period.
    #[must_use]
    pub fn following(coulomb: f64, range: &AmplitudeRange) -> Self {
        // with s and S = R² over that of the largest amplitude, from τ to 1
        let largest = range.to_m * range.to_m;
        let tau = (range.from_m / range.to_m).powi(2);
        // c_eq(1)/c_eq(τ) is least where 8 s₀² − 4(1 + τ) s₀ + τ = 0
        let centre = 0.25 * (1.0 + tau + tau.mul_add(tau, 1.0).sqrt());
        // g(S) = s₀² − s₀ S/2 + S²/8
        let equivalent = |s: f64| centre * centre - 0.5 * centre * s + 0.125 * s * s;
        let (low, high) = (tau.sqrt() * equivalent(tau), equivalent(1.0));
        // the same error at both ends, of opposite sign
        let scale = 2.0 / (low + high) * coulomb / range.to_m;
        // a hair less than the double root, so that no rounding makes the damping negative there
        let quadratic = -2.0 * centre * (1.0 - 1e-9);
        Self {
            constant_n_s_per_m: scale * centre * centre,
            quadratic_n_s_per_m3: scale * quadratic / largest,
            quartic_n_s_per_m5: scale / (largest * largest),
            worst_error: (high - low) / (high + low),
        }
    }

    /// Viscous damper with the same loss over a period of a sinusoidal motion of some amplitude, N·s/m.
    #[must_use]
    pub fn equivalent_n_s_per_m(&self, amplitude_m: f64) -> f64 {
        // ∮ c(r) ṙ² dt/(π ω R²) = c + c2 R²/4 + c4 R⁴/8
        self.constant_n_s_per_m + self.terms().equivalent_damping(amplitude_m)
    }

    /// What depends on the amplitude, as a law has it.
    #[must_use]
    pub fn terms(&self) -> Polynomial {
        Polynomial::with(&[], &[self.quadratic_n_s_per_m3, self.quartic_n_s_per_m5])
    }
}
