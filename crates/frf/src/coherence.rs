//! Ordinary coherence, and the variance of a measured function that follows from it.

use super::{Dof, FrfError};

/// γ² this close to 1 cannot be told from 1: half a unit of the last digit that universal files print.
const NEAREST_TO_ONE: f64 = 5e-7;
/// Below this γ² a line says nothing about the function.
const LEAST: f64 = 1e-6;
/// γ² above 1 by rounding alone.
const ROUNDING: f64 = 1e-5;

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

#[cfg(test)]
mod tests {
    use rand_chacha::ChaCha8Rng;
    use rand_chacha::rand_core::SeedableRng;
    use rand_distr::Distribution;

    use super::relative_variance;

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
