//! Profiles of known fractal dimension and roughness, to plan measurements and to try the fit on.

use std::f64::consts::TAU;

use bolted_joint_fourier::Transform;
use num_complex::Complex64;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use rand_distr::{Distribution, StandardNormal, StandardUniform};

use super::{Profile, Roughness, SurfaceError};

/// A profile to be made.
///
/// ```
/// use bolted_joint_predict::surface::{FitSettings, ProfileFit, Roughness, Synthetic};
///
/// let surface = Synthetic {
///     roughness: Roughness::new(1.4, 1e-11)?,
///     points: 4000,
///     step_m: 1e-6,
///     gamma: 1.5,
/// };
/// let profiles = [1, 2, 3].map(|seed| surface.gaussian(seed)).into_iter().collect::<Result<Vec<_>, _>>()?;
/// let fit = ProfileFit::new(&profiles, &FitSettings::default())?;
/// let [low, high] = fit.dimension_interval;
/// assert!(low < 1.4 && 1.4 < high);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Synthetic {
    /// D and G.
    pub roughness: Roughness,
    /// Number of points, at least 3.
    pub points: usize,
    /// Distance between them, in m.
    pub step_m: f64,
    /// γ of the Weierstrass–Mandelbrot function, which (30) also has; more than 1, usually 1.5.
    pub gamma: f64,
}

impl Synthetic {
    /// The Weierstrass–Mandelbrot function, Zhao (1), with random phases:
    /// z(x) = G^(D−1) Σ γ^((D−2)n) cos(2πγⁿx + φₙ), all γⁿ (per metre) from one wave over the profile to half the sampling
    /// frequency.
    ///
    /// # Errors
    /// [`SurfaceError`] for fewer than three points or a step that is not positive.
    pub fn weierstrass_mandelbrot(&self, seed: u64) -> Result<Profile, SurfaceError> {
        let mut generator = ChaCha8Rng::seed_from_u64(seed);
        let dimension = self.roughness.fractal_dimension();
        let scale = self.roughness.roughness_m().powf(dimension - 1.0);
        let [lowest, highest] = [self.points as f64 * self.step_m, 2.0 * self.step_m]
            .map(|wavelength_m| -wavelength_m.ln() / self.gamma.ln());
        let mut waves = Vec::new();
        let mut order = lowest.ceil();
        while order < highest {
            let frequency = self.gamma.powf(order);
            let phase: f64 = StandardUniform.sample(&mut generator);
            waves.push((
                frequency,
                scale * frequency.powf(dimension - 2.0),
                TAU * phase,
            ));
            order += 1.0;
        }
        let height = |point: usize| {
            let distance_m = self.step_m * point as f64;
            let wave = |&(frequency, amplitude, phase): &(f64, f64, f64)| {
                amplitude * (TAU * frequency * distance_m + phase).cos()
            };
            waves.iter().map(wave).sum()
        };
        Profile::new(self.step_m, (0..self.points).map(height).collect())
    }

    /// A Gaussian profile whose spectrum is (30) at all frequencies, not only at powers of γ:
    /// S(f) = G^(2(D−1))/(2 ln γ) f^(2D−5), from a wave of at least four times the length to half the sampling frequency.
    ///
    /// # Errors
    /// [`SurfaceError`] for fewer than three points or a step that is not positive.
    pub fn gaussian(&self, seed: u64) -> Result<Profile, SurfaceError> {
        let mut generator = ChaCha8Rng::seed_from_u64(seed);
        let dimension = self.roughness.fractal_dimension();
        let period = 4 * self.points.next_power_of_two();
        let spacing = 1.0 / (period as f64 * self.step_m);
        let scale =
            self.roughness.roughness_m().powf(2.0 * (dimension - 1.0)) / (2.0 * self.gamma.ln());
        let mut values = vec![Complex64::default(); period];
        for (line, value) in values.iter_mut().enumerate().take(period / 2).skip(1) {
            let density = scale * (line as f64 * spacing).powf(2.0 * dimension - 5.0);
            let mut normal = || -> f64 { StandardNormal.sample(&mut generator) };
            let (cosine, sine) = (normal(), normal());
            *value = Complex64::new(cosine, -sine) * (density * spacing).sqrt();
        }
        Transform::inverse(period).apply(&mut values);
        let height_m = values.iter().take(self.points).map(|value| value.re);
        Profile::new(self.step_m, height_m.collect())
    }
}
