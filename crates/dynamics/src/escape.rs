//! How far a softening joint may open before nothing holds it any more.

use crate::lap::Lap;

impl<const D: usize> Lap<D> {
    /// Relative displacement (m, rad) of each DOF at which the softening joint's force, together with the
    /// supports', has fallen to zero; beyond it the solution runs away. `None` where the joint does not soften,
    /// zero where even small motion is not held.
    ///
    /// For the symmetric lap this is √((k + 2 k12)/(−2 kN)). With rotation the other DOF is taken as free to follow
    /// (condensed), which is exact where it has no cubic term of its own and on the safe side where it hardens.
    #[must_use]
    pub fn escape_amplitude(&self) -> [Option<f64>; D] {
        // The supports hold the relative motion in series: k_s = k_a k_b / (k_a + k_b).
        let mut tangent = self.joint.stiffness;
        for i in 0..D {
            let (k_a, k_b) = (self.a.stiffness[i], self.b.stiffness[i]);
            if k_a > 0.0 && k_b > 0.0 {
                tangent[i][i] += k_a * k_b / (k_a + k_b);
            }
        }
        std::array::from_fn(|i| {
            let cubic = self.joint.cubic[i];
            if cubic >= 0.0 {
                return None;
            }
            // k̃ = K_ii − Σ_{j≠i} K_ij²/K_jj;  k̃ r + k3 r³ = 0  ⇒  r = √(k̃/(−k3))
            let mut condensed = tangent[i][i];
            for j in (0..D).filter(|&j| j != i && tangent[j][j] > 0.0) {
                condensed -= tangent[i][j] * tangent[j][i] / tangent[j][j];
            }
            Some((condensed.max(0.0) / -cubic).sqrt())
        })
    }
}

#[cfg(test)]
mod tests {
    use crate::joint::JointLaw;
    use crate::lap::{Body, Lap};

    #[test]
    fn the_symmetric_lap_escapes_where_the_theory_says() {
        let (k, k12, cubic): (f64, f64, f64) = (10.56e5, 4.56e6, -3e12);
        let body = Body {
            inertia: [2.35],
            stiffness: [k],
            damping: [1.39],
        };
        let lap = Lap {
            joint: JointLaw {
                stiffness: [[k12]],
                damping: [[0.54]],
                cubic: [cubic],
            },
            a: body,
            b: body,
        };
        let expected = ((k + 2.0 * k12) / (-2.0 * cubic)).sqrt();
        let [escape] = lap.escape_amplitude();
        assert!((escape.unwrap() / expected - 1.0).abs() < 1e-14);
    }

    #[test]
    fn a_hardening_joint_never_escapes() {
        let body = Body {
            inertia: [1.0],
            stiffness: [0.0],
            damping: [0.0],
        };
        let joint = JointLaw {
            stiffness: [[1e6]],
            damping: [[0.0]],
            cubic: [1e9],
        };
        let lap = Lap {
            joint,
            a: body,
            b: body,
        };
        assert_eq!(lap.escape_amplitude(), [None]);
    }
}
