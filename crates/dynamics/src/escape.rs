//! How far a softening joint may open before nothing holds it any more.

use crate::lap::Lap;

/// Halvings of a bracket: more than a double has bits.
const HALVINGS: u32 = 100;

impl<const D: usize> Lap<D> {
    /// Relative displacement (m, rad) of each DOF at which the softening joint's force, together with the
    /// supports', has fallen to zero; beyond it the solution runs away. `None` where the joint does not soften,
    /// zero where even small motion is not held.
    ///
    /// For the symmetric lap this is √((k + 2 k12)/(−2 kN)). With rotation the other DOF follows as its own force
    /// balance asks, cubic term included, and as long as there is such a balance.
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
        let cubic = &self.joint.cubic;
        std::array::from_fn(|i| {
            if cubic[i] >= 0.0 {
                return None;
            }
            let other = (0..D).find(|&j| j != i && tangent[i][j] != 0.0);
            let squared = match other {
                None => tangent[i][i].max(0.0) / -cubic[i],
                Some(j) => escape_squared(
                    Spring::of(tangent[i][i], cubic[i]),
                    Spring::of(tangent[j][j], cubic[j]),
                    0.5 * (tangent[i][j] + tangent[j][i]),
                ),
            };
            Some(squared.sqrt())
        })
    }
}

/// Force k r + k3 r³ of one DOF on itself.
struct Spring {
    linear: f64,
    cubic: f64,
}

impl Spring {
    fn of(linear: f64, cubic: f64) -> Self {
        Self { linear, cubic }
    }
}

/// Square of the displacement r of `own`, which softens, at which no force holds it any more while `other` is in balance:
///
/// k r + κ s + k3 r³ = 0 with κ r + k' s + k3' s³ = 0.
///
/// On u = s² the second is r² = u (k' + k3' u)²/κ², and the first, divided by r, is g(u) = k − κ²/(k' + k3' u) + k3 r².
/// From g(0), the condensed stiffness, g falls where `other` softens and is concave where it hardens: one sign change.
fn escape_squared(own: Spring, other: Spring, coupling: f64) -> f64 {
    if other.linear <= 0.0 {
        return 0.0;
    }
    let secant = |u: f64| other.linear + other.cubic * u;
    let own_squared = |u: f64| u * (secant(u) / coupling).powi(2);
    let held =
        |u: f64| own.linear - coupling * coupling / secant(u) + own.cubic * own_squared(u) > 0.0;
    if !held(0.0) {
        return 0.0;
    }
    if other.cubic == 0.0 {
        return (own.linear - coupling * coupling / other.linear) / -own.cubic;
    }
    let (mut low, mut high) = if other.cubic < 0.0 {
        // Beyond k' + 3 k3' u = 0 the other DOF finds no balance: r² has its maximum there.
        let fold = other.linear / (-3.0 * other.cubic);
        if held(fold) {
            return own_squared(fold);
        }
        (0.0, fold)
    } else {
        // r² ≥ u (k'/κ)² and g ≤ k + k3 r²: no longer held at twice the u where that bound vanishes.
        let bound = own.linear / -own.cubic * (coupling / other.linear).powi(2);
        (0.0, 2.0 * bound)
    };
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if held(middle) {
            low = middle;
        } else {
            high = middle;
        }
    }
    own_squared(low)
}

#[cfg(test)]
mod tests {
    use crate::lap::{Body, Lap};
    use crate::{higher::HigherTerms, joint::JointLaw};

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
                higher: HigherTerms::NONE,
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
            higher: HigherTerms::NONE,
        };
        let lap = Lap {
            joint,
            a: body,
            b: body,
        };
        assert_eq!(lap.escape_amplitude(), [None]);
    }

    /// Tol Table 5.3's joint without supports, softening on each DOF as told.
    fn with_rotation(cubic: [f64; 2]) -> Lap<2> {
        let body = Body {
            inertia: [1.0, 1e-3],
            stiffness: [0.0; 2],
            damping: [0.0; 2],
        };
        let joint = JointLaw {
            stiffness: [[5.73e5, 5.82e3], [5.82e3, 1.29e3]],
            damping: [[0.0; 2]; 2],
            cubic,
            higher: HigherTerms::NONE,
        };
        Lap {
            joint,
            a: body,
            b: body,
        }
    }

    /// The largest held displacement of DOF `i` and how finely it is known, by walking along the other DOF's balance.
    fn walked(lap: &Lap<2>, i: usize) -> (f64, f64) {
        let (k, cubic, j) = (&lap.joint.stiffness, &lap.joint.cubic, 1 - i);
        let (mut r, mut s): (f64, f64) = (0.0, 0.0);
        let step = 1e-5 * (k[i][i] / -cubic[i]).sqrt();
        loop {
            r += step;
            // Newton's method from the last balance; without one the other DOF runs away.
            for _ in 0..50 {
                let force = k[j][i] * r + k[j][j] * s + cubic[j] * s.powi(3);
                s -= force / (k[j][j] + 3.0 * cubic[j] * s * s);
            }
            let balance = k[j][i] * r + k[j][j] * s + cubic[j] * s.powi(3);
            let stable = k[j][j] + 3.0 * cubic[j] * s * s > 0.0;
            let force = k[i][i] * r + k[i][j] * s + cubic[i] * r.powi(3);
            if balance.abs() > 1e-9 * (k[j][i] * r).abs() || !stable || force <= 0.0 {
                return (r - step, step);
            }
        }
    }

    #[test]
    fn with_rotation_the_other_degree_of_freedom_follows_its_own_cubic_too() {
        for cubic in [
            [-1e11, 0.0],
            [-1e11, 1e9],
            [-1e11, -1e6],
            [-1e11, -3e8],
            [-1e11, -1e9],
        ] {
            let lap = with_rotation(cubic);
            let escape = lap.escape_amplitude();
            for i in 0..2 {
                if cubic[i] < 0.0 {
                    let (held, step) = walked(&lap, i);
                    let beyond = (escape[i].unwrap() - held) / step;
                    assert!(
                        (-0.01..1.01).contains(&beyond),
                        "{cubic:?} {i}: {beyond} steps"
                    );
                } else {
                    assert_eq!(escape[i], None);
                }
            }
        }
    }

    #[test]
    fn what_is_not_held_at_rest_escapes_at_once() {
        let mut lap = with_rotation([-1e11, -1e9]);
        lap.joint.stiffness[1][1] = 50.0; // k_yy k_θθ < k_yθ²
        assert_eq!(lap.escape_amplitude(), [Some(0.0); 2]);
    }
}
