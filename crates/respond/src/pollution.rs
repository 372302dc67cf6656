//! The two ways of giving computed receptances the noise of a measurement (Tol section 4.3).

use num_complex::Complex64;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use rand_distr::{Distribution, StandardNormal};

use super::RespondError;

/// A noise procedure and its level.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Pollution {
    /// "FRF pollution" (Tol 4.3.1): every receptance times a real factor N(1, σ).
    Frf {
        /// σ.
        level: f64,
    },
    /// "Response pollution" (Tol 4.3.2): one harmonic test a line; white noise is added to every sample of response and
    /// force, then the transform of the response at the line is divided by that of the force.
    Response {
        /// σ: standard deviation of the noise as a fraction of the highest amplitude that the response reaches at any
        /// line; for the force, of its amplitude.
        level: f64,
        /// Samples of each harmonic test, over a whole number of periods.
        samples: u32,
    },
}

/// The source of the noise: the same seed gives the same noise.
#[derive(Clone, Debug)]
pub struct Generator(ChaCha8Rng);

impl Generator {
    /// A generator that starts from `seed`.
    #[must_use]
    pub fn new(seed: u64) -> Self {
        Self(ChaCha8Rng::seed_from_u64(seed))
    }

    /// One of many generators that start from `seed`: draws of different numbers share nothing.
    #[must_use]
    pub fn of_draw(seed: u64, draw: u64) -> Self {
        let mut generator = ChaCha8Rng::seed_from_u64(seed);
        generator.set_stream(draw);
        Self(generator)
    }

    fn normal(&mut self) -> f64 {
        StandardNormal.sample(&mut self.0)
    }

    fn complex_normal(&mut self) -> Complex64 {
        let real = self.normal();
        Complex64::new(real, self.normal())
    }
}

impl Pollution {
    /// The same procedure, if its numbers make sense.
    ///
    /// # Errors
    /// [`RespondError`] that says which does not.
    pub fn checked(self) -> Result<Self, RespondError> {
        let (Self::Frf { level } | Self::Response { level, .. }) = self;
        if !(0.0..1.0).contains(&level) {
            return Err(RespondError::NoiseLevel(level));
        }
        match self {
            Self::Response { samples, .. } if samples < 3 => {
                Err(RespondError::NoiseSamples(samples))
            }
            _ => Ok(self),
        }
    }

    /// One receptance at all its lines, with noise. Lines of one call share the highest amplitude, as those of one
    /// response in one test do.
    #[must_use]
    pub fn applied(&self, receptance: &[Complex64], generator: &mut Generator) -> Vec<Complex64> {
        match *self {
            Self::Frf { level } => receptance
                .iter()
                .map(|value| value * (1.0 + level * generator.normal()))
                .collect(),
            Self::Response { level, samples } => {
                let highest = receptance
                    .iter()
                    .map(|value| value.norm())
                    .fold(0.0, f64::max);
                // White noise of variance σ² gives (2/N) Σ e_n exp(−jωt_n), over whole periods, independent normal real
                // and imaginary parts of variance 2σ²/N: drawn here at once instead of sample by sample.
                let part = level * (2.0 / f64::from(samples)).sqrt();
                receptance
                    .iter()
                    .map(|value| {
                        // Ĥ = (H F + e_x)/(F + e_f), force amplitude F = 1
                        let response = value + highest * part * generator.complex_normal();
                        response / (1.0 + part * generator.complex_normal())
                    })
                    .collect()
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    fn variances(errors: &[Complex64]) -> [f64; 2] {
        let count = errors.len() as f64;
        [
            errors.iter().map(|e| e.re * e.re).sum::<f64>() / count,
            errors.iter().map(|e| e.im * e.im).sum::<f64>() / count,
        ]
    }

    /// The procedure as it is described: harmonic signals, noise on every sample, transforms, quotient.
    fn sample_by_sample(
        value: Complex64,
        highest: f64,
        level: f64,
        samples: u32,
        generator: &mut Generator,
    ) -> Complex64 {
        let (mut response, mut force) = (Complex64::default(), Complex64::default());
        for n in 0..samples {
            let angle = TAU * 3.0 * f64::from(n) / f64::from(samples);
            let turn = Complex64::from_polar(1.0, -angle);
            let x = (value * turn.conj()).re + level * highest * generator.normal();
            let f = angle.cos() + level * generator.normal();
            response += x * turn;
            force += f * turn;
        }
        response / force
    }

    #[test]
    fn the_line_of_a_noisy_harmonic_test_has_the_same_spread_as_its_samples_give() {
        let value = Complex64::new(2e-6, -1e-6);
        let (level, samples, highest, draws) = (0.05, 16, 5e-6, 20_000);
        let mut generator = Generator::new(3);
        let explicit: Vec<Complex64> = (0..draws)
            .map(|_| sample_by_sample(value, highest, level, samples, &mut generator) - value)
            .collect();
        let noise = Pollution::Response { level, samples };
        let mut generator = Generator::new(4);
        let direct: Vec<Complex64> = (0..draws)
            .map(|_| {
                let polluted = noise.applied(&[value, Complex64::from(highest)], &mut generator);
                polluted[0] - value
            })
            .collect();
        for (explicit, direct) in variances(&explicit).iter().zip(variances(&direct)) {
            // Five standard deviations of the quotient of two variances of 20 000 draws each.
            assert!((direct / explicit - 1.0).abs() < 5.0 * (4.0 / f64::from(draws)).sqrt());
            // First order: σ²(2/N)(max² + |H|²).
            let expected =
                level * level * 2.0 / f64::from(samples) * (highest * highest + value.norm_sqr());
            assert!(
                (direct / expected - 1.0).abs() < 0.06,
                "{direct} {expected}"
            );
        }
    }

    #[test]
    fn frf_pollution_leaves_the_phase_and_has_the_stated_level() {
        let value = Complex64::new(3e-6, -4e-6);
        let lines = 20_000;
        let noise = Pollution::Frf { level: 0.03 };
        let noisy = noise.applied(&vec![value; lines], &mut Generator::new(7));
        assert_eq!(
            noisy,
            noise.applied(&vec![value; lines], &mut Generator::new(7))
        );
        let errors: Vec<Complex64> = noisy.iter().map(|noisy| noisy / value - 1.0).collect();
        let [real, imaginary] = variances(&errors);
        assert!(imaginary < 1e-30);
        assert!((real / 9e-4 - 1.0).abs() < 5.0 * (2.0 / lines as f64).sqrt());
    }

    #[test]
    fn nonsense_is_refused() {
        let negative = Pollution::Frf { level: -0.1 }.checked();
        assert!(matches!(negative, Err(RespondError::NoiseLevel(-0.1))));
        let short = Pollution::Response {
            level: 0.1,
            samples: 2,
        };
        assert!(matches!(
            short.checked(),
            Err(RespondError::NoiseSamples(2))
        ));
    }
}
