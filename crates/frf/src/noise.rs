//! Measurement noise for planning a test and for showing how an identification stands up to it.

use num_complex::Complex64;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use rand_distr::{Distribution, StandardNormal};

use super::{Frf, FrfError, FrfSet};

/// The set with noise proportional to each receptance: every value is multiplied by 1 + σ(n₁ + j n₂)/√2 with
/// independent standard normal n₁ and n₂, so that the relative error has the standard deviation `relative`.
///
/// The same `seed` gives the same noise. Tol's "FRF pollution" (section 4.3) has the real factor N(1, σ) instead, which
/// leaves every phase exact.
///
/// # Errors
/// [`FrfError`] if a value is no longer finite.
pub fn polluted(set: &FrfSet, relative: f64, seed: u64) -> Result<FrfSet, FrfError> {
    let mut generator = ChaCha8Rng::seed_from_u64(seed);
    let part = relative * std::f64::consts::FRAC_1_SQRT_2;
    let functions = set.functions().map(|(response, reference, receptance)| {
        let noisy = receptance
            .iter()
            .map(|value| {
                let mut normal = || -> f64 { StandardNormal.sample(&mut generator) };
                let (real, imaginary) = (normal(), normal());
                value * Complex64::new(1.0 + part * real, part * imaginary)
            })
            .collect();
        Frf::new(response, reference, set.frequency_hz().to_vec(), noisy)
    });
    FrfSet::new(functions.collect::<Result<_, _>>()?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn noise_has_the_stated_level_and_repeats_with_its_seed() {
        let lines = 20_000;
        let frequency_hz = (1..=lines).map(f64::from).collect();
        let value = Complex64::new(3e-6, -4e-6);
        let dof = "1:+Y".parse().unwrap();
        let frf = Frf::new(dof, dof, frequency_hz, vec![value; lines as usize]).unwrap();
        let set = FrfSet::new(vec![frf]).unwrap();
        let noisy = polluted(&set, 0.01, 7).unwrap();
        assert_eq!(noisy, polluted(&set, 0.01, 7).unwrap());
        assert_ne!(noisy, polluted(&set, 0.01, 8).unwrap());
        let values = noisy.receptance(dof, dof).unwrap();
        let errors: Vec<Complex64> = values.iter().map(|noisy| noisy / value - 1.0).collect();
        let mean = errors.iter().sum::<Complex64>() / f64::from(lines);
        let variance = |part: fn(&Complex64) -> f64| {
            errors.iter().map(|error| part(error).powi(2)).sum::<f64>() / f64::from(lines)
        };
        // Five standard deviations of the mean and of the variance of 20 000 draws.
        assert!(mean.norm() < 5.0 * 0.01 / f64::from(lines).sqrt());
        for part in [variance(|e| e.re), variance(|e| e.im)] {
            assert!((part / 5e-5 - 1.0).abs() < 5.0 * (2.0 / f64::from(lines)).sqrt());
        }
    }
}
