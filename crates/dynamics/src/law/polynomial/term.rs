//! One term of the polynomial law: what is read off its declaration, and what it does to a harmonic motion.

use super::{DAMPER_COUNT, PARAMETERS, Polynomial, SPRING_COUNT};
use crate::{law::declaration::Parameter, number::Number, power_series::value};

/// Number of terms.
pub const TERM_COUNT: usize = SPRING_COUNT + DAMPER_COUNT;

/// The terms' rows.
const ROWS: &[Parameter; TERM_COUNT] = &PARAMETERS;

/// A term c rᵖ or c rᵖ ṙ, by its place among the parameters of the law.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Term(usize);

impl Term {
    /// The cubic spring.
    pub const CUBIC: Self = Self(0);

    /// All of them, in the order of the law's parameters.
    pub const ALL: [Self; TERM_COUNT] = {
        let mut all = [Self(0); TERM_COUNT];
        let mut index = 0;
        while index < TERM_COUNT {
            all[index] = Self(index);
            index += 1;
        }
        all
    };

    /// The term with this symbol, such as `k5`.
    #[must_use]
    pub fn named(symbol: &str) -> Option<Self> {
        Self::ALL
            .into_iter()
            .find(|term| term.row().symbol == symbol)
    }

    /// Its place in [`Term::ALL`].
    #[must_use]
    pub const fn index(self) -> usize {
        self.0
    }

    /// What the law declares of it.
    #[must_use]
    pub const fn row(self) -> &'static Parameter {
        &ROWS[self.0]
    }

    /// Whether it is a damper.
    #[must_use]
    pub const fn is_damper(self) -> bool {
        self.0 >= SPRING_COUNT
    }

    /// Power of r, then that of ṙ.
    #[must_use]
    pub fn powers(self) -> [i32; 2] {
        // the load is the coefficient times what its unit divides the load by
        let all = i32::from(self.row().unit.displacement());
        if self.is_damper() {
            [all - 1, 1]
        } else {
            [all, 0]
        }
    }

    /// Degree in r and ṙ together.
    #[must_use]
    pub fn degree(self) -> usize {
        usize::from(self.row().unit.displacement())
    }

    /// Power of the amplitude in its equivalent stiffness or damping under a harmonic motion.
    #[must_use]
    pub fn amplitude_power(self) -> i32 {
        let [of_r, of_rate] = self.powers();
        of_r + of_rate - 1
    }

    /// Its equivalent stiffness or damping over coefficient · X^`amplitude_power` under r = X cos ωt.
    #[must_use]
    pub fn describing(self) -> f64 {
        // mean of cosⁿ for even n: (n − 1)!!/n!!
        let mean = |n: i32| {
            (1..=n / 2).fold(1.0, |mean, half| {
                mean * f64::from(2 * half - 1) / f64::from(2 * half)
            })
        };
        // a spring's force on cos, 2 mean of cosᵖ⁺¹; a damper's on −sin, 2 mean of cosᵖ sin²
        let [of_r, _] = self.powers();
        if self.is_damper() {
            2.0 * (mean(of_r) - mean(of_r + 2))
        } else {
            2.0 * mean(of_r + 1)
        }
    }
}

impl<N: Number> Polynomial<N> {
    /// The coefficient of a term.
    #[must_use]
    pub fn coefficient(&self, term: Term) -> N {
        match term.0.checked_sub(SPRING_COUNT) {
            None => self.springs[term.0],
            Some(index) => self.dampers[index],
        }
    }

    /// The coefficient of a term, to be changed.
    pub fn coefficient_mut(&mut self, term: Term) -> &mut N {
        match term.0.checked_sub(SPRING_COUNT) {
            None => &mut self.springs[term.0],
            Some(index) => &mut self.dampers[index],
        }
    }
}

impl Polynomial {
    /// Viscous damper with the same loss over a period of a harmonic motion of this amplitude (m, rad) as the dampers have.
    #[must_use]
    pub fn equivalent_damping(&self, amplitude: f64) -> f64 {
        let describing = |j: usize| Term(SPRING_COUNT + j).describing();
        let shares: [f64; DAMPER_COUNT] = std::array::from_fn(|j| describing(j) * self.dampers[j]);
        let squared = amplitude * amplitude;
        value(&shares, squared) * squared
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
            let [of_r, _] = term.powers();
            let mean: f64 = angles
                .map(|angle| {
                    let (sine, cosine) = angle.sin_cos();
                    // r = cos, ṙ = −sin: a spring's force on cos, a damper's on −sin.
                    match term.is_damper() {
                        false => 2.0 * cosine.powi(of_r) * cosine,
                        true => 2.0 * cosine.powi(of_r) * sine * sine,
                    }
                })
                .sum::<f64>()
                / SAMPLES as f64;
            assert!((mean - term.describing()).abs() < 1e-14, "{term:?}: {mean}");
        }
    }

    #[test]
    fn each_term_has_its_own_coefficient() {
        for term in Term::ALL {
            assert_eq!(Term::named(term.row().symbol), Some(term));
            let mut polynomial = Polynomial::<f64>::NONE;
            *polynomial.coefficient_mut(term) = 2.0;
            assert_eq!(polynomial.coefficient(term), 2.0);
            let [of_r, of_rate] = term.powers();
            let expected = 2.0 * 1.5_f64.powi(of_r) * 7.0_f64.powi(of_rate);
            let load = crate::law::Law::load::<f64>(&polynomial, &[], 1.5, 7.0);
            assert!((load / expected - 1.0).abs() < 1e-15);
            assert_eq!(polynomial.degree(), term.degree().max(3));
        }
        assert_eq!(Term::named("k4"), None);
    }
}
