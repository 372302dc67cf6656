//! What a bolted joint does beyond a cubic spring and viscous damping: stiffness of fifth and seventh order, damping that
//! grows or falls with the square and the fourth power of the amplitude.

/// Terms of higher order on each relative DOF r = x_a − x_b: their load on side b is
/// `k5 ∘ r⁵ + k7 ∘ r⁷ + (c2 ∘ r² + c4 ∘ r⁴) ∘ ṙ`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HigherTerms<const D: usize> {
    /// k5: N/m⁵, N·m/rad⁵.
    pub quintic: [f64; D],
    /// k7: N/m⁷, N·m/rad⁷.
    pub septic: [f64; D],
    /// c2: N·s/m³, N·m·s/rad³.
    pub damping_quadratic: [f64; D],
    /// c4: N·s/m⁵, N·m·s/rad⁵.
    pub damping_quartic: [f64; D],
}

impl<const D: usize> HigherTerms<D> {
    /// No such terms: cubic springs and viscous damping are all there is.
    pub const NONE: Self = Self {
        quintic: [0.0; D],
        septic: [0.0; D],
        damping_quadratic: [0.0; D],
        damping_quartic: [0.0; D],
    };

    /// Whether all of them are zero.
    #[inline]
    #[must_use]
    pub fn are_none(&self) -> bool {
        *self == Self::NONE
    }

    /// Load on DOF `i` (N, N·m) at its relative displacement r and velocity ṙ.
    #[inline]
    pub(crate) fn load(&self, i: usize, r: f64, velocity: f64) -> f64 {
        // k5 r⁵ + k7 r⁷ + (c2 r² + c4 r⁴) ṙ
        let squared = r * r;
        let spring = (self.quintic[i] + self.septic[i] * squared) * squared * squared * r;
        spring + self.damping(i, r) * velocity
    }

    /// Damping coefficient that the amplitude adds on DOF `i`, N·s/m and N·m·s/rad, at its relative displacement r.
    #[inline]
    pub(crate) fn damping(&self, i: usize, r: f64) -> f64 {
        // c2 r² + c4 r⁴
        let squared = r * r;
        (self.damping_quadratic[i] + self.damping_quartic[i] * squared) * squared
    }

    /// Energy in the springs of DOF `i` (J) at its relative displacement r.
    #[inline]
    pub(crate) fn stored_energy(&self, i: usize, r: f64) -> f64 {
        // ⅙ k5 r⁶ + ⅛ k7 r⁸
        let squared = r * r;
        (self.quintic[i] / 6.0 + 0.125 * self.septic[i] * squared) * squared * squared * squared
    }

    /// Change of [`HigherTerms::load`] with the relative displacement: N/m, N·m/rad.
    #[inline]
    pub(crate) fn tangent_stiffness(&self, i: usize, r: f64, velocity: f64) -> f64 {
        // 5 k5 r⁴ + 7 k7 r⁶ + (2 c2 r + 4 c4 r³) ṙ
        let squared = r * r;
        let spring = (5.0 * self.quintic[i] + 7.0 * self.septic[i] * squared) * squared * squared;
        spring + self.tangent_damping(i, r) * velocity
    }

    /// Change of [`HigherTerms::damping`] with the relative displacement: N·s/m², N·m·s/rad².
    #[inline]
    pub(crate) fn tangent_damping(&self, i: usize, r: f64) -> f64 {
        // 2 c2 r + 4 c4 r³
        (2.0 * self.damping_quadratic[i] + 4.0 * self.damping_quartic[i] * r * r) * r
    }
}
