//! Fractal dimension and roughness from the spectrum of profiles: a straight line on logarithmic scales.

use bolted_joint_statistics::{NORMAL_975, chi_squared_95, student_975};

use super::bands::Bands;
use super::fractal::Fractal;
use super::line::Line;
use super::warning::{DEFAULT_STEPS, DEFAULT_WAVES};
use super::{Detrend, FitWarning, Profile, Roughness, Spectrum, SurfaceError, Welch, Window};
use crate::number::check;

/// How profiles are fitted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FitSettings {
    /// What is taken off each whole profile: the form of the part.
    pub form: Detrend,
    /// Window of the segments.
    pub window: Window,
    /// Points in a segment; `None`: a quarter of the shortest profile, and no fewer than 64 if it has them.
    pub segment: Option<usize>,
    /// Part of a segment that the next one shares, from 0 to less than 1.
    pub overlap: f64,
    /// Shortest and longest wavelength of the fit, in m; `None`: from 8 steps to a sixth of a segment.
    pub wavelength_band_m: Option<[f64; 2]>,
    /// Ratio of the middles of neighbouring bands that the spectrum is averaged over before its logarithm is taken; each band reaches to
    /// the middles of its neighbours. γ, for a surface that is a Weierstrass–Mandelbrot function.
    pub band_ratio: f64,
    /// γ of the Weierstrass–Mandelbrot function.
    pub gamma: f64,
}

impl Default for FitSettings {
    /// Line taken off, Hann, half overlapping, bands of the ratio 1.5, γ = 1.5.
    fn default() -> Self {
        Self {
            form: Detrend::Line,
            window: Window::Hann,
            segment: None,
            overlap: 0.5,
            wavelength_band_m: None,
            band_ratio: 1.5,
            gamma: 1.5,
        }
    }
}

/// Fewer steps in a wave than this are worth a warning.
const WARN_STEPS: f64 = 4.0;
/// Fewer waves in a segment than this are worth a warning.
const WARN_WAVES: f64 = 4.0;
const FEWEST_BANDS: usize = 3;
/// Steps of profiles that are the same, relative.
const SAME_STEP: f64 = 1e-3;
const SHORTEST_SEGMENT: usize = 64;

/// D and G of profiles, and how well they are known.
#[derive(Debug, Clone, PartialEq)]
pub struct ProfileFit {
    /// D and G.
    pub roughness: Roughness,
    /// Covariance matrix of D and ln G. They are almost one quantity, so draw them together.
    pub covariance: [[f64; 2]; 2],
    /// 95 % interval of D.
    pub dimension_interval: [f64; 2],
    /// 95 % interval of G, in m, by Fieller's theorem: ln G is the ratio of two normal variables.
    pub roughness_interval_m: [f64; 2],
    /// Slope of log S over log ω: 2D − 5.
    pub slope: f64,
    /// Shortest and longest wavelength used: whole bands within those asked for, in m.
    pub wavelength_band_m: [f64; 2],
    /// How the spectrum was estimated.
    pub welch: Welch,
    /// Whether standard deviations are widened because the spectrum is no straight line within its scatter.
    pub is_inflated: bool,
    /// The spectrum of all profiles.
    pub spectrum: Spectrum,
    /// What the line was fitted to.
    pub bands: Vec<BandMean>,
    /// What is doubtful; each prints as a sentence.
    pub warnings: Vec<FitWarning>,
    log_density_at_one: f64,
    chi_squared: f64,
    degrees_of_freedom: usize,
}

/// Mean of the spectrum over a band, on the fitted line's terms.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BandMean {
    /// Middle of the band on a logarithmic scale, in cycles per metre.
    pub frequency_per_m: f64,
    /// Density at the middle, in m³.
    pub density_m3: f64,
    /// Standard deviation of its natural logarithm.
    pub log_standard_deviation: f64,
}

impl ProfileFit {
    /// Fits profiles of the same surface, with the same step, together.
    ///
    /// # Errors
    /// [`SurfaceError`] without profiles, with different steps, with settings or a band that the profiles do not admit, and when the
    /// slope is that of no fractal profile.
    pub fn new(profiles: &[Profile], settings: &FitSettings) -> Result<Self, SurfaceError> {
        let (welch, step_m, points) = prepared(profiles, settings)?;
        let spectra = profiles
            .iter()
            .map(|profile| welch.spectrum(&settings.form.apply(profile.height_m()), step_m))
            .collect::<Result<Vec<_>, _>>()?;
        let spectrum = Spectrum::mean(&spectra).ok_or(SurfaceError::NoProfiles)?;
        let segment_m = welch.segment as f64 * step_m;
        let asked_m = settings
            .wavelength_band_m
            .unwrap_or([DEFAULT_STEPS * step_m, segment_m / DEFAULT_WAVES]);
        let [shortest_m, longest_m] = asked_m;
        let band_error = |found| SurfaceError::Band {
            wavelength_m: asked_m,
            found,
            ratio: settings.band_ratio,
            shortest_m: 2.0 * step_m,
            longest_m: segment_m,
        };
        let rounding = 1e-9;
        let admissible = shortest_m >= 2.0 * step_m * (1.0 - rounding)
            && longest_m <= segment_m * (1.0 + rounding)
            && shortest_m < longest_m;
        if !admissible {
            return Err(band_error(0));
        }
        let bands = Bands::new(
            &spectrum,
            [1.0 / longest_m, 1.0 / shortest_m],
            settings.band_ratio,
        );
        if bands.count() < FEWEST_BANDS {
            return Err(band_error(bands.count()));
        }
        let [low, high] = bands.ends_per_m();
        let wavelength_band_m = [1.0 / high, 1.0 / low];
        let reference = bands.centre().iter().sum::<f64>() / bands.count() as f64;
        let line = Line::fitted(&spectrum, &bands, &welch, &points, reference).ok_or(
            SurfaceError::Flat {
                wavelength_m: wavelength_band_m,
            },
        )?;
        let degrees_of_freedom = bands.count() - 2;
        let freedom = degrees_of_freedom as f64;
        let is_inflated = line.chi_squared > chi_squared_95(degrees_of_freedom);
        // With known variances the normal distribution; where χ² says that the line does not fit, the scatter about it and Student's.
        let (scale, quantile) = match is_inflated {
            true => (line.chi_squared / freedom, student_975(degrees_of_freedom)),
            false => (1.0, NORMAL_975),
        };
        let covariance = line.covariance * scale;
        let found = Fractal::from_line(
            line.at_reference,
            covariance,
            reference,
            quantile,
            settings.gamma,
            wavelength_band_m,
        )?;
        let mut warnings = Vec::new();
        let steps = wavelength_band_m[0] / step_m;
        if steps < WARN_STEPS * (1.0 - rounding) {
            warnings.push(FitWarning::NearSampling { steps });
        }
        let waves = segment_m / wavelength_band_m[1];
        if waves < WARN_WAVES * (1.0 - rounding) {
            warnings.push(FitWarning::NearSegment { waves });
        }
        if is_inflated {
            warnings.push(FitWarning::NotStraight {
                chi_squared: line.chi_squared,
                degrees_of_freedom,
            });
        }
        let interval = found.dimension_interval;
        if interval[0] <= 1.0 || interval[1] >= 2.0 {
            warnings.push(FitWarning::DimensionNearEnd { interval });
        }
        let [at_reference, slope] = [line.at_reference[0], line.at_reference[1]];
        let on_line = |log_frequency: f64| at_reference + slope * (log_frequency - reference);
        let band_means = (0..bands.count()).map(|band| BandMean {
            frequency_per_m: bands.centre()[band].exp(),
            density_m3: (on_line(bands.centre()[band]) + line.residual[band]).exp(),
            log_standard_deviation: line.log_standard_deviation[band],
        });
        Ok(Self {
            roughness: found.roughness,
            covariance: found.covariance,
            dimension_interval: found.dimension_interval,
            roughness_interval_m: found.roughness_interval_m,
            slope,
            log_density_at_one: on_line(0.0),
            wavelength_band_m,
            welch,
            chi_squared: line.chi_squared,
            degrees_of_freedom,
            is_inflated,
            bands: band_means.collect(),
            spectrum,
            warnings,
        })
    }

    /// Standard deviation of D.
    #[must_use]
    pub fn dimension_standard_deviation(&self) -> f64 {
        self.covariance[0][0].sqrt()
    }

    /// Standard deviation of ln G.
    #[must_use]
    pub fn log_roughness_standard_deviation(&self) -> f64 {
        self.covariance[1][1].sqrt()
    }

    /// Standard deviation of G to first order, in m.
    #[must_use]
    pub fn roughness_standard_deviation_m(&self) -> f64 {
        self.roughness.roughness_m() * self.log_roughness_standard_deviation()
    }

    /// Correlation of D and ln G.
    #[must_use]
    pub fn correlation(&self) -> f64 {
        let [[dimension, product], [_, log_roughness]] = self.covariance;
        product / (dimension * log_roughness).sqrt()
    }

    /// Decimal logarithm of S (m³) at 1 cycle per metre: 2(D − 1) log₁₀ G − log₁₀(2 ln γ).
    #[must_use]
    pub fn intercept(&self) -> f64 {
        self.log_density_at_one / std::f64::consts::LN_10
    }

    /// S of the fitted line at a frequency in cycles per metre, in m³.
    #[must_use]
    pub fn density_m3(&self, frequency_per_m: f64) -> f64 {
        (self.log_density_at_one + self.slope * frequency_per_m.ln()).exp()
    }

    /// χ² of the line and its degrees of freedom.
    #[must_use]
    pub fn chi_squared(&self) -> (f64, usize) {
        (self.chi_squared, self.degrees_of_freedom)
    }
}

/// Checks profiles and settings; Welch's parameters, the step (m), and the points of each profile.
fn prepared(
    profiles: &[Profile],
    settings: &FitSettings,
) -> Result<(Welch, f64, Vec<usize>), SurfaceError> {
    let first = profiles.first().ok_or(SurfaceError::NoProfiles)?;
    let checks = [
        (
            "the overlap",
            settings.overlap,
            (0.0..1.0).contains(&settings.overlap),
            "0 or more and less than 1",
        ),
        (
            "the ratio of neighbouring bands",
            settings.band_ratio,
            settings.band_ratio.is_finite() && settings.band_ratio > 1.0,
            "more than 1",
        ),
        (
            "γ",
            settings.gamma,
            settings.gamma.is_finite() && settings.gamma > 1.0,
            "more than 1",
        ),
    ];
    for (quantity, found, valid, expected) in checks {
        check(valid, quantity, found, "", expected)?;
    }
    let first_m = first.step_m();
    let other = |profile: &&Profile| (profile.step_m() / first_m - 1.0).abs() > SAME_STEP;
    if let Some(number) = profiles.iter().position(|profile| other(&profile)) {
        return Err(SurfaceError::Steps {
            number: number + 1,
            found_m: profiles[number].step_m(),
            first_m,
        });
    }
    let points: Vec<usize> = profiles.iter().map(|p| p.height_m().len()).collect();
    let shortest = points.iter().copied().min().unwrap_or(0);
    let segment = settings
        .segment
        .unwrap_or((shortest / 4).max(SHORTEST_SEGMENT).min(shortest));
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "part of a length that is not negative"
    )]
    let overlap = (settings.overlap * segment as f64).floor() as usize;
    let welch = Welch {
        window: settings.window,
        segment,
        overlap,
        detrend: Detrend::Line,
    };
    welch.check(shortest)?;
    Ok((welch, first_m, points))
}
