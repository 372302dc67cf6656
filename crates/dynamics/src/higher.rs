//! What a bolted joint does beyond a cubic spring and viscous damping: stiffness of fifth and seventh order, damping that
//! grows or falls with the square and the fourth power of the amplitude.

use crate::joint::JointLaw;

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
        // all bits but the signs, so that one comparison is enough
        let mut bits = 0;
        for i in 0..D {
            bits |= self.quintic[i].to_bits() | self.septic[i].to_bits();
            bits |= self.damping_quadratic[i].to_bits() | self.damping_quartic[i].to_bits();
        }
        bits << 1 == 0
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

    /// Least damping coefficient that the amplitude adds on each DOF (N·s/m, N·m·s/rad; zero or less) within a relative
    /// displacement of `amplitude` (m, rad), which may be infinite.
    #[must_use]
    pub fn least_damping(&self, amplitude: &[f64; D]) -> [f64; D] {
        std::array::from_fn(|i| {
            let (c2, c4) = (self.damping_quadratic[i], self.damping_quartic[i]);
            let farthest = if amplitude[i].is_finite() {
                self.damping(i, amplitude[i])
            } else if c4 < 0.0 || c4 == 0.0 && c2 < 0.0 {
                f64::NEG_INFINITY
            } else {
                0.0
            };
            // c2 u + c4 u² is least at u = −c2/(2 c4), between rest and the amplitude
            let vertex = -c2 / (2.0 * c4);
            let turning = if c4 > 0.0 && vertex > 0.0 && vertex.sqrt() < amplitude[i] {
                0.5 * c2 * vertex
            } else {
                0.0
            };
            farthest.min(turning).min(0.0)
        })
    }
}

impl<const D: usize> JointLaw<D> {
    /// Relative displacement (m, rad) of each DOF, the other at rest, beyond which the damping that depends on it makes the
    /// joint active: the damping matrix is then no longer positive semidefinite. `None` where that does not happen, zero
    /// where it happens at once.
    #[must_use]
    pub fn active_amplitude(&self) -> [Option<f64>; D] {
        std::array::from_fn(|i| {
            let (c2, c4) = (
                self.higher.damping_quadratic[i],
                self.higher.damping_quartic[i],
            );
            // C + (c2 u + c4 u²) eᵢeᵢᵀ is semidefinite as long as C_ii − C_ij²/C_jj + c2 u + c4 u² is not negative
            let condensed = (0..D).filter(|&j| j != i).fold(self.damping[i][i], |c, j| {
                let coupling = 0.5 * (self.damping[i][j] + self.damping[j][i]);
                if coupling == 0.0 {
                    c
                } else {
                    c - coupling * coupling / self.damping[j][j]
                }
            });
            first_negative(condensed, c2, c4).map(f64::sqrt)
        })
    }
}

/// Largest u ≥ 0 up to which c + c2 u + c4 u² is not negative; `None` where it never is.
fn first_negative(c: f64, c2: f64, c4: f64) -> Option<f64> {
    if c2 >= 0.0 && c4 >= 0.0 {
        return None;
    }
    if c <= 0.0 && c2 <= 0.0 {
        return Some(0.0);
    }
    let discriminant = c2 * c2 - 4.0 * c4 * c;
    if c4 > 0.0 && discriminant <= 0.0 {
        return None;
    }
    // the smaller positive root, without cancellation for either sign of c2
    let root = discriminant.max(0.0).sqrt();
    Some(if c2 > 0.0 {
        -(c2 + root) / (2.0 * c4)
    } else {
        2.0 * c.max(0.0) / (root - c2)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn law(c: f64, c2: f64, c4: f64) -> JointLaw<1> {
        JointLaw {
            damping: [[c]],
            higher: HigherTerms {
                damping_quadratic: [c2],
                damping_quartic: [c4],
                ..HigherTerms::NONE
            },
            ..JointLaw::NONE
        }
    }

    #[test]
    fn damping_turns_negative_at_the_first_root() {
        let near = |c: f64, c2: f64, c4: f64, u: f64| {
            let [found] = law(c, c2, c4).active_amplitude();
            let error = found.unwrap() / u.sqrt() - 1.0;
            assert!(error.abs() < 1e-14, "{c} {c2} {c4}: {error:e}");
        };
        // 10 (1 − u/4)(1 − u/9), 10 (1 + u/4)(1 − u/9), 10 (1 − u/9), u (1 − u/9)
        near(10.0, -10.0 * (1.0 / 4.0 + 1.0 / 9.0), 10.0 / 36.0, 4.0);
        near(10.0, 10.0 * (1.0 / 4.0 - 1.0 / 9.0), -10.0 / 36.0, 9.0);
        near(10.0, -10.0 / 9.0, 0.0, 9.0);
        near(0.0, 1.0, -1.0 / 9.0, 9.0);
        near(10.0, 0.0, -10.0 / 81.0, 9.0);
        for (c, c2, c4) in [
            (1.0, 1.0, 0.0),
            (0.0, 0.0, 0.0),
            (1.0, -1.9, 1.0),
            (0.0, 1.0, 2.0),
        ] {
            assert_eq!(law(c, c2, c4).active_amplitude(), [None]);
        }
        for (c, c2, c4) in [(0.0, -1.0, 5.0), (0.0, 0.0, -1.0), (-1.0, -1.0, 0.0)] {
            assert_eq!(law(c, c2, c4).active_amplitude(), [Some(0.0)]);
        }
    }

    #[test]
    fn with_rotation_the_coupling_takes_its_share_of_the_damping() {
        let mut law = JointLaw::<2> {
            damping: [[10.0, 2.0], [2.0, 1.0]],
            ..JointLaw::NONE
        };
        law.higher.damping_quadratic = [-3.0, -1.0];
        // 10 − 4/1 = 6 = 3 u and 1 − 4/10 = 0.6 = u
        let [y, theta] = law.active_amplitude().map(Option::unwrap);
        assert!((y - 2.0_f64.sqrt()).abs() < 1e-15 && (theta - 0.6_f64.sqrt()).abs() < 1e-15);
    }

    #[test]
    fn the_least_damping_is_that_of_a_fine_grid() {
        for (c2, c4) in [
            (-3.0, 2.0),
            (3.0, -2.0),
            (-1.0, -1.0),
            (1.0, 1.0),
            (-1.0, 0.0),
        ] {
            for amplitude in [0.3, 0.8, 2.0] {
                let least = (0..=100_000)
                    .map(|n| {
                        let u = (amplitude * f64::from(n) / 1e5).powi(2);
                        c2 * u + c4 * u * u
                    })
                    .fold(f64::INFINITY, f64::min);
                let [found] = law(1.0, c2, c4).higher.least_damping(&[amplitude]);
                assert!((found - least).abs() < 1e-8, "{c2} {c4} {amplitude}");
            }
        }
        assert_eq!(
            law(1.0, 1.0, -1.0).higher.least_damping(&[f64::INFINITY]),
            [f64::NEG_INFINITY]
        );
        assert_eq!(
            law(1.0, -2.0, 1.0).higher.least_damping(&[f64::INFINITY]),
            [-1.0]
        );
    }
}
