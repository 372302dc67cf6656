//! The level of noise that many functions of one test have in common, where their lines are close enough to show it.

use bolted_joint_statistics::median;
use num_complex::Complex64;

use super::{FEWEST_LINES, Function, ROUNDS, SHORTER, WHOLE};
use crate::noise::{Size, most_likely_level};

/// Functions that are asked, evenly among all, and windows of each.
const ASKED: usize = 24;
const WINDOWS: usize = 200;
/// Where shorter windows with fewer coefficients show less than so many times as much, both show noise. What fits miss grows more than
/// thirtyfold.
const ALIKE: f64 = 1.3;
/// Less noise than this part of the functions is that of computed ones.
const LEAST: f64 = 1e-4;

/// Noise of the functions of one test.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShownLevel {
    /// In parts of each value.
    pub relative: f64,
    /// Beside it, in parts of each function's median.
    pub floor: f64,
    /// At most lines, in parts of each function's r.m.s.
    pub typical: f64,
    /// Whether this is noise. Where it is not, it is what fits miss: of computed functions, or of lines too far from each other.
    pub is_noise: bool,
}

impl ShownLevel {
    /// Of functions over these ascending frequencies; `None` of too few lines.
    #[must_use]
    pub fn of(frequency_hz: &[f64], functions: &[Vec<Complex64>]) -> Option<Self> {
        if frequency_hz.len() < FEWEST_LINES {
            return None;
        }
        let stride = functions.len().div_ceil(ASKED).max(1);
        let asked: Vec<&Vec<Complex64>> = functions.iter().step_by(stride).collect();
        let found = crate::parallel::map(&asked, |values| Found::of(frequency_hz, values));
        let found: Vec<Found> = found.into_iter().flatten().collect();
        let of = |value: fn(&Found) -> f64| median(found.iter().map(value));
        let [whole, shorter] = [of(|own| own.sizes[0])?, of(|own| own.sizes[1])?];
        Some(Self {
            is_noise: whole > LEAST && shorter < ALIKE * whole,
            relative: of(|own| own.level.relative)?,
            floor: of(|own| own.level.floor)?,
            typical: of(|own| own.typical)?,
        })
    }
}

/// What one function shows.
struct Found {
    /// The floor in parts of the median.
    level: Size,
    /// In parts of the r.m.s.
    typical: f64,
    /// Noise in parts of the values, by the longer windows and by the shorter ones.
    sizes: [f64; 2],
}

impl Found {
    fn of(frequency_hz: &[f64], values: &[Complex64]) -> Option<Self> {
        let middle = median(values.iter().map(|value| value.norm()))?;
        if middle == 0.0 {
            return None;
        }
        let mut function = Function::new(frequency_hz, values, None, middle);
        for _ in 0..ROUNDS {
            let samples = function.samples(WHOLE, WINDOWS);
            // bad values are no noise
            let samples = function.without_the_far(samples);
            if samples.is_empty() {
                return None;
            }
            function.level = most_likely_level(&samples, None);
        }
        // half of all squares of noise are below ln 2 times their mean
        let mean = |squares: Vec<f64>| Some(median(squares)? / std::f64::consts::LN_2);
        let samples = [WHOLE, SHORTER].map(|order| function.samples(order, WINDOWS));
        let [whole, shorter] = samples.each_ref().map(|samples| {
            let parts = samples.iter().map(|own| own.power / own.by_relative);
            mean(parts.collect()).map(f64::sqrt)
        });
        let squares = values.iter().map(Complex64::norm_sqr).sum::<f64>();
        let of_lines = mean(samples[0].iter().map(|own| own.power).collect())?;
        Some(Self {
            typical: (of_lines * values.len() as f64 / squares).sqrt(),
            sizes: [whole?, shorter?],
            level: Size {
                relative: function.level.relative,
                floor: function.level.floor * function.median / middle,
            },
        })
    }
}

#[cfg(test)]
mod tests {
    use rand_chacha::ChaCha8Rng;
    use rand_chacha::rand_core::SeedableRng;
    use rand_distr::{Distribution, StandardNormal};

    use super::*;

    /// A function of three modes with a damping ratio of 0.005, and noise.
    fn function(
        frequency_hz: &[f64],
        number: usize,
        relative: f64,
        floor: f64,
        generator: &mut ChaCha8Rng,
    ) -> Vec<Complex64> {
        let of = |hz: f64| -> Complex64 {
            let modes = [(310.0, 1.0), (870.0, -0.4), (1430.0, 0.7)].into_iter();
            let modes = modes.enumerate().map(|(mode, (natural, shape))| {
                let shape = shape + 0.1 * (number * (mode + 1)) as f64;
                shape / Complex64::new(natural * natural - hz * hz, 0.01 * natural * hz)
            });
            modes.sum()
        };
        let clean: Vec<Complex64> = frequency_hz.iter().map(|&hz| of(hz)).collect();
        let middle = median(clean.iter().map(|value| value.norm())).unwrap();
        let mut normal = || -> f64 { StandardNormal.sample(&mut *generator) };
        let noisy = clean.iter().map(|value| {
            let size = (relative * value.norm()).hypot(floor * middle) / 2.0_f64.sqrt();
            value + Complex64::new(normal(), normal()) * size
        });
        noisy.collect()
    }

    fn shown(lines: u32, relative: f64, floor: f64) -> Option<ShownLevel> {
        let step = 1740.0 / f64::from(lines - 1);
        let frequency_hz: Vec<f64> = (0..lines).map(|n| 60.0 + step * f64::from(n)).collect();
        let mut generator = ChaCha8Rng::seed_from_u64(7);
        let functions: Vec<_> = (0..12)
            .map(|number| function(&frequency_hz, number, relative, floor, &mut generator))
            .collect();
        ShownLevel::of(&frequency_hz, &functions)
    }

    #[test]
    fn noise_is_told_from_what_lines_are_too_far_apart_for() {
        for relative in [3e-4, 3e-3, 3e-2] {
            let found = shown(400, relative, 0.0).unwrap();
            assert!(found.is_noise, "{found:?}");
            assert!((found.relative / relative - 1.0).abs() < 0.1, "{found:?}");
            assert!(found.floor < 0.2 * relative, "{found:?}");
        }
        let found = shown(400, 0.0, 5e-3).unwrap();
        assert!(found.is_noise, "{found:?}");
        assert!((found.floor / 5e-3 - 1.0).abs() < 0.1, "{found:?}");
        // exact functions, with many lines and with few
        for lines in [40, 60, 120, 400] {
            assert!(!shown(lines, 0.0, 0.0).unwrap().is_noise, "{lines}");
        }
        // with few lines, fits miss as much as there is noise
        assert!(!shown(30, 3e-3, 0.0).unwrap().is_noise);
    }
}
