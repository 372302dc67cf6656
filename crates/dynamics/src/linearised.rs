//! Small motion about a displaced joint: what a nonlinear law is there, and which displacements matter.

use crate::{higher::HigherTerms, joint::JointLaw};

impl<const D: usize> JointLaw<D> {
    /// The linear law of small motion about this static relative displacement (m, rad).
    #[must_use]
    pub fn linearised_about(&self, displacement: &[f64; D]) -> Self {
        let mut law = Self {
            cubic: [0.0; D],
            higher: HigherTerms::NONE,
            ..*self
        };
        for i in 0..D {
            let r = displacement[i];
            // d(k r + k3 r³ + k5 r⁵ + k7 r⁷)/dr = k + 3 k3 r² + 5 k5 r⁴ + 7 k7 r⁶, and c + c2 r² + c4 r⁴
            law.stiffness[i][i] += 3.0 * self.cubic[i] * r * r;
            law.stiffness[i][i] += self.higher.tangent_stiffness(i, r, 0.0);
            law.damping[i][i] += self.higher.damping(i, r);
        }
        law
    }

    /// Displacements of DOF `i` (m, rad), from rest to `amplitude`, at which its stiffness or damping of small motion is
    /// largest or least: rest, the amplitude, and what turns between them.
    pub fn extremes(&self, i: usize, amplitude: f64) -> impl Iterator<Item = f64> {
        let (k3, k5, k7) = (self.cubic[i], self.higher.quintic[i], self.higher.septic[i]);
        let (c2, c4) = (
            self.higher.damping_quadratic[i],
            self.higher.damping_quartic[i],
        );
        // of u = r²: 3 k3 + 10 k5 u + 21 k7 u² = 0 and c2 + 2 c4 u = 0
        let (half, constant) = (5.0 * k5, 3.0 * k3);
        let root = (half * half - 21.0 * k7 * constant).sqrt();
        let product = -(half + root.copysign(half));
        let turning = [product / (21.0 * k7), constant / product, -c2 / (2.0 * c4)];
        let between = turning
            .map(f64::sqrt)
            .into_iter()
            // no root, or none that is a displacement, gives no number
            .filter(move |&r| r > 0.0 && r < amplitude);
        let ends = (amplitude > 0.0).then_some(amplitude);
        [0.0].into_iter().chain(ends).chain(between)
    }

    /// Relative displacement (m, rad) of each DOF at which the first of its nonlinear terms is as large as the linear one of
    /// the same kind; infinite where it has none, zero where there is no linear one beside it.
    #[must_use]
    pub fn nonlinear_amplitude(&self) -> [f64; D] {
        std::array::from_fn(|i| {
            let (k, c) = (self.stiffness[i][i].abs(), self.damping[i][i].abs());
            let of_term = |linear: f64, term: f64, order: u8| {
                if term == 0.0 {
                    return f64::INFINITY;
                }
                // |kₙ| rⁿ⁻¹ = k
                let ratio = linear / term.abs();
                match order {
                    2 => ratio.sqrt(),
                    4 => ratio.sqrt().sqrt(),
                    _ => ratio.cbrt().sqrt(),
                }
            };
            of_term(k, self.cubic[i], 2)
                .min(of_term(k, self.higher.quintic[i], 4))
                .min(of_term(k, self.higher.septic[i], 6))
                .min(of_term(c, self.higher.damping_quadratic[i], 2))
                .min(of_term(c, self.higher.damping_quartic[i], 4))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::joint::Motion;

    fn law() -> JointLaw<2> {
        JointLaw {
            stiffness: [[5.73e5, 5.82e3], [5.82e3, 1.29e3]],
            damping: [[10.83, -0.83], [-0.83, 0.083]],
            cubic: [-3e11, 4e6],
            higher: HigherTerms {
                quintic: [5e16, -3e9],
                septic: [-1e21, 2e12],
                damping_quadratic: [-4e6, 30.0],
                damping_quartic: [7e11, -2e4],
            },
        }
    }

    #[test]
    fn the_linear_law_is_the_difference_quotient_of_the_load() {
        let law = law();
        let about = [1.3e-3, -8e-3];
        let linear = law.linearised_about(&about);
        for j in 0..2 {
            let load = |step: f64, rate: f64| {
                let mut motion = Motion {
                    displacement: about,
                    velocity: [0.0; 2],
                };
                motion.displacement[j] += step;
                motion.velocity[j] += rate;
                law.load_on_b(&motion)
            };
            let step = 1e-6 * about[j].abs();
            let [above, below] = [step, -step].map(|step| load(step, 0.0));
            let [still, moving] = [0.0, 1.0].map(|rate| load(0.0, rate));
            for i in 0..2 {
                let stiffness = (above[i] - below[i]) / (2.0 * step);
                let damping = moving[i] - still[i];
                assert!((linear.stiffness[i][j] / stiffness - 1.0).abs() < 1e-6);
                assert!((linear.damping[i][j] / damping - 1.0).abs() < 1e-9);
            }
        }
        assert_eq!((linear.cubic, linear.higher), ([0.0; 2], HigherTerms::NONE));
    }

    #[test]
    fn between_the_extremes_nothing_is_larger_or_smaller() {
        let mut laws = vec![law()];
        let mut alone = law();
        alone.higher = HigherTerms::NONE;
        laws.push(alone);
        let mut without_septic = law();
        without_septic.higher.septic = [0.0; 2];
        laws.push(without_septic);
        for law in laws {
            for (i, amplitude) in [(0, 8e-3), (1, 0.05)] {
                let at = |r: f64| {
                    let mut displacement = [0.0; 2];
                    displacement[i] = r;
                    let linear = law.linearised_about(&displacement);
                    [linear.stiffness[i][i], linear.damping[i][i]]
                };
                let extremes: Vec<[f64; 2]> = law.extremes(i, amplitude).map(at).collect();
                for kind in 0..2 {
                    let all = || extremes.iter().map(|values| values[kind]);
                    let least = all().fold(f64::INFINITY, f64::min);
                    let most = all().fold(f64::NEG_INFINITY, f64::max);
                    let slack = 1e-12 * most.abs().max(least.abs());
                    for n in 0..=5000 {
                        let value = at(amplitude * f64::from(n) / 5000.0)[kind];
                        assert!(
                            (least - slack..=most + slack).contains(&value),
                            "{i} {kind} {n}"
                        );
                    }
                }
            }
        }
    }

    #[test]
    fn the_first_term_to_reach_the_linear_one_tells_the_amplitude() {
        let [y, theta] = law().nonlinear_amplitude();
        // c2 r² = c: √(10.83/4e6); c2 θ² = c: √(0.083/30) is past √(1.29e3/4e6)
        assert!((y / (5.73e5_f64 / 3e11).sqrt() - 1.0).abs() < 1e-15);
        assert!((theta / (1.29e3_f64 / 4e6).sqrt() - 1.0).abs() < 1e-15);
        let mut law = law();
        law.cubic = [0.0, -0.0];
        law.higher = HigherTerms::NONE;
        assert_eq!(law.nonlinear_amplitude(), [f64::INFINITY; 2]);
        law.higher.septic = [-5.73e5 / 64.0, 0.0];
        assert!((law.nonlinear_amplitude()[0] - 2.0).abs() < 1e-15);
        law.stiffness[0][0] = 0.0;
        assert_eq!(law.nonlinear_amplitude()[0], 0.0);
    }
}
