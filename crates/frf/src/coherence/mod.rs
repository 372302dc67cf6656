//! Ordinary coherence, and the variance of a measured function that follows from it.

mod pooled;

pub(crate) use pooled::{pooled, window};

use super::{Dof, FrfError};

/// γ² this close to 1 cannot be told from 1: half a unit of the last digit that universal files print.
const NEAREST_TO_ONE: f64 = 5e-7;
/// Below this γ² a line says nothing about the function.
const LEAST: f64 = 1e-6;
/// γ² above 1 by rounding alone.
const ROUNDING: f64 = 1e-5;
/// A measured |H|² counts for at least this part of the smaller one beside it: a value that got lost between others is not
/// exact for that. Noise alone is hardly ever so small.
const LEAST_OF_NEIGHBOURS: f64 = 1e-6;

/// Ordinary coherence γ² of one measured function on the lines of its set, and how many averages stand behind it.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Coherence {
    /// Response of the function that it belongs to.
    pub response: Dof,
    /// Reference of the function that it belongs to.
    pub reference: Dof,
    /// The frequency of each line, Hz.
    pub frequency_hz: Vec<f64>,
    /// γ² at each line, as many as there are frequencies.
    pub gamma_squared: Vec<f64>,
}

impl Coherence {
    /// Coherence γ² (from 0 to 1) at each frequency in Hz.
    ///
    /// # Errors
    /// [`FrfError::LengthsDiffer`] or [`FrfError::CoherenceNotAllowed`].
    pub fn new(
        response: Dof,
        reference: Dof,
        frequency_hz: Vec<f64>,
        gamma_squared: Vec<f64>,
    ) -> Result<Self, FrfError> {
        if frequency_hz.len() != gamma_squared.len() {
            return Err(FrfError::LengthsDiffer {
                response,
                reference,
                frequencies: frequency_hz.len(),
                values: gamma_squared.len(),
            });
        }
        let allowed = |value: &f64| (-ROUNDING..=1.0 + ROUNDING).contains(value);
        if let Some(index) = gamma_squared.iter().position(|value| !allowed(value)) {
            return Err(FrfError::CoherenceNotAllowed {
                response,
                reference,
                line: index + 1,
                frequency_hz: frequency_hz[index],
                found: gamma_squared[index],
            });
        }
        Ok(Self {
            response,
            reference,
            frequency_hz,
            gamma_squared,
        })
    }
}

/// σ²/|H|² of one line of a function measured with `averages` averages, where its ordinary coherence is `gamma_squared`.
///
/// σ² is that of the *complex* error: the variances of real and imaginary part, half of it each, add up to σ². It holds for
/// H₁ (noise on the response), for H₂ (noise on the reference), and to first order for both; bias is not part of it.
/// γ² is kept within 10⁻⁶ and 1 − 5·10⁻⁷, since a printed 1 does not mean a measurement without noise.
///
/// ```
/// // Ten averages at γ² = 0.9: 10.5 % in all, 7.5 % along the magnitude and as much across it.
/// let variance = bolted_joint_frf::relative_variance(0.9, 10.0);
/// assert!((variance.sqrt() - 0.10541).abs() < 1e-5);
/// ```
#[must_use]
pub fn relative_variance(gamma_squared: f64, averages: f64) -> f64 {
    let gamma_squared = gamma_squared.clamp(LEAST, 1.0 - NEAREST_TO_ONE);
    // σ²/|H|² = 2 · (1 − γ²)/(2 n γ²)   (Bendat & Piersol, Random Data, section 9.2: (1 − γ²)/(2 n γ²) along and across H)
    (1.0 - gamma_squared) / (averages * gamma_squared)
}

/// σ² of a measured function at each line, from σ²/|H|² as coherence tells it there and its own |H|².
///
/// It is σ²/|H|² of coherence times the |H|² of the same measurement, which is Syy(1 − γ²)/(n Sff): what is left of the
/// response, and independent of the error of H₁. Times a computed |H|² a value that errs upwards would have a smaller variance
/// than one that errs downwards, and every estimate would err upwards.
#[must_use]
pub fn absolute_variances(relative: &[f64], power: impl Fn(usize) -> f64) -> Vec<f64> {
    let lines = relative.len();
    let absolute = |(line, relative): (usize, &f64)| relative * lifted(lines, line, &power);
    relative.iter().enumerate().map(absolute).collect()
}

/// |H|² of a line, or what it counts for beside its neighbours.
pub(crate) fn lifted(lines: usize, line: usize, power: impl Fn(usize) -> f64) -> f64 {
    let beside = [line.checked_sub(1), Some(line + 1)];
    let beside = beside.into_iter().flatten();
    let beside = beside.filter(|&line| line < lines).map(&power);
    let least = LEAST_OF_NEIGHBOURS * beside.fold(f64::INFINITY, f64::min);
    let least = if least.is_finite() { least } else { 0.0 };
    power(line).max(least)
}

#[cfg(test)]
mod tests {
    use rand_chacha::ChaCha8Rng;
    use rand_chacha::rand_core::SeedableRng;
    use rand_distr::Distribution;

    use super::{absolute_variances, relative_variance};

    #[test]
    fn a_value_that_got_lost_is_not_exact() {
        let power = [4.0, 0.0, 9.0];
        let found = absolute_variances(&[0.1, 0.1, 0.2], |line| power[line]);
        assert!((found[0] - 0.4).abs() < 1e-15 && (found[2] - 1.8).abs() < 1e-15);
        assert!((found[1] - 0.1 * 4e-6).abs() < 1e-18, "{}", found[1]);
    }

    #[test]
    fn coherence_gives_the_variance_of_averaged_spectra() {
        let mut generator = ChaCha8Rng::seed_from_u64(5);
        let mut normal = || -> f64 { rand_distr::StandardNormal.sample(&mut generator) };
        // Response y = x + n with noise of 0.3 of the input's deviation; H₁ = Σ conj(x) y / Σ |x|².
        let (averages, trials, noise) = (20, 20_000, 0.3_f64);
        let mut variance = 0.0;
        for _ in 0..trials {
            let (mut cross, mut power) = (num_complex::Complex64::default(), 0.0);
            for _ in 0..averages {
                let x = num_complex::Complex64::new(normal(), normal());
                let n = num_complex::Complex64::new(normal(), normal());
                cross += x.conj() * (x + n * noise);
                power += x.norm_sqr();
            }
            variance += (cross / power - 1.0).norm_sqr() / f64::from(trials);
        }
        let coherence = 1.0 / (1.0 + noise * noise);
        // The formula is that of many averages: n − 1 takes the place of n in the exact one.
        let expected = relative_variance(coherence, f64::from(averages - 1));
        assert!(
            (variance / expected - 1.0).abs() < 0.03,
            "{variance} {expected}"
        );
    }
}
